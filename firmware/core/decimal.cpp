#include "decimal.h"

namespace arboleda {

namespace {

constexpr int kDigits = 512;         // no message is longer
constexpr int kLeastPoint = -30;     // a value with more zeros behind its point counts as 0
constexpr int kMostPoint = 11;       // 1e10 has so many digits before its point
constexpr int kBits = 54;            // of a double, and one to round by
constexpr int kEndlessExponent = 99999;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// 0.d0 d1 d2 ... times ten to the power of `point`.
struct Decimal {
    uint8_t digits[kDigits - kLeastPoint];
    int count = 0;
    int point = 0;
    bool negative = false;

    void read(Text text);
    void add(char c, bool behind_point);
    void pad();
    bool twice();
    bool rest() const;
};

int exponent(Text text, size_t at) {
    const bool negative = text.at[at] == '-';
    at += text.at[at] == '-' || text.at[at] == '+' ? 1 : 0;
    int value = 0;
    for (; at < text.size && value < kEndlessExponent; ++at) {
        value = value * 10 + (text.at[at] - '0');
    }
    return negative ? -value : value;
}

void Decimal::add(char c, bool behind_point) {
    const bool leading = count == 0 && c == '0';
    if (!leading) {
        digits[count++] = static_cast<uint8_t>(c - '0');
    }
    if (leading && behind_point) {
        --point;
    } else if (!leading && !behind_point) {
        ++point;
    }
}

void Decimal::read(Text text) {
    negative = text.at[0] == '-';
    bool behind_point = false;
    for (size_t at = negative ? 1 : 0; at < text.size && count < kDigits; ++at) {
        if (is_digit(text.at[at])) {
            add(text.at[at], behind_point);
        } else if (text.at[at] == '.') {
            behind_point = true;
        } else {
            point += exponent(text, at + 1);
            return;
        }
    }
}

// Moves the point to the front of the digits, or to their end where it lies behind them.
void Decimal::pad() {
    for (; point < 0; ++point, ++count) {
        for (int at = count; at > 0; --at) {
            digits[at] = digits[at - 1];
        }
        digits[0] = 0;
    }
    while (count < point) {
        digits[count++] = 0;
    }
}

// Doubles the part behind the point; the bit that comes out of it.
bool Decimal::twice() {
    int carry = 0;
    for (int at = count; at-- > point;) {
        const int doubled = 2 * digits[at] + carry;
        digits[at] = static_cast<uint8_t>(doubled % 10);
        carry = doubled / 10;
    }
    return carry != 0;
}

bool Decimal::rest() const {
    for (int at = point; at < count; ++at) {
        if (digits[at] != 0) {
            return true;
        }
    }
    return false;
}

double rounded(Decimal& decimal) {
    uint64_t bits = 0;
    for (int at = 0; at < decimal.point; ++at) {
        bits = bits * 10 + decimal.digits[at];
    }
    double unit = 1.0;
    while (bits >> (kBits - 1) == 0) {
        bits = 2 * bits + (decimal.twice() ? 1 : 0);
        unit *= 0.5;
    }
    const bool half = (bits & 1) != 0;
    const bool up = half && ((bits & 2) != 0 || decimal.rest());
    return static_cast<double>((bits >> 1) + (up ? 1 : 0)) * (unit * 2.0);
}

}  // namespace

bool whole(Text text, uint32_t top, uint32_t* value) {
    uint64_t read = 0;
    const bool negative = text.at[0] == '-';
    for (size_t at = negative ? 1 : 0; at < text.size; ++at) {
        read = read * 10 + static_cast<uint64_t>(text.at[at] - '0');
        if (!is_digit(text.at[at]) || read > top) {
            return false;
        }
    }
    *value = static_cast<uint32_t>(read);
    return !negative || read == 0;
}

bool real(Text text, double bound, double* value) {
    Decimal decimal;
    decimal.read(text);
    if (decimal.count == 0 || decimal.point < kLeastPoint) {
        *value = 0.0;
        return true;
    }
    if (decimal.point > kMostPoint) {
        return false;
    }
    decimal.pad();
    const double magnitude = rounded(decimal);
    *value = decimal.negative ? -magnitude : magnitude;
    return magnitude <= bound;
}

uint64_t ten_thousandths(double value) {
    const double magnitude = value < 0.0 ? -value : value;
    const auto units = static_cast<uint64_t>(magnitude);
    const double part = magnitude - static_cast<double>(units);
    // both halves have so few bits that their products are exact
    const double high = static_cast<double>(static_cast<uint32_t>(part * 0x1p26)) * 0x1p-26;
    const double low = (part - high) * 1e4;
    const double scaled = high * 1e4;
    const auto floor = static_cast<uint64_t>(scaled);
    const double over = scaled - static_cast<double>(floor) - 0.5 + low;
    const double exact = scaled - static_cast<double>(floor) - 0.5;
    const bool tie = exact == -low;
    const bool up = tie ? (floor & 1) != 0 : over > 0.0;
    return units * 10000 + floor + (up ? 1 : 0);
}

}  // namespace arboleda
