#include "freshness.h"

namespace arboleda {

void Freshness::tell(uint64_t now_us, uint32_t number) {
    told_ = number;
    if (count_ > 0 && now_us - marks_[count_ - 1].at_us < kMarkUs) {
        return;
    }
    if (count_ == kMarks) {
        for (uint8_t at = 1; at < kMarks; ++at) {
            marks_[at - 1] = marks_[at];
        }
        --count_;
    }
    marks_[count_++] = {now_us, number};
}

bool Freshness::covers(uint64_t now_us, uint32_t number) const {
    for (uint8_t at = 0; at < count_; ++at) {
        if (now_us - marks_[at].at_us <= kFreshUs) {
            return marks_[at].number <= number && number <= told_;
        }
    }
    return false;
}

}  // namespace arboleda
