// The small parts of the core: the ramp's refusals, the limit of 512 bytes, rings, keepsakes.
#include <math.h>
#include <pthread.h>
#include <string.h>

#include "../core/freshness.h"
#include "../core/json.h"
#include "../core/keepsakes.h"
#include "../core/ring.h"
#include "../core/scara.h"
#include "../core/stepper.h"
#include "../core/telemetry.h"
#include "../core/writer.h"
#include "check.h"

namespace arboleda {

namespace {

// `{"nota":"xxx..."}` of so many bytes.
size_t written(size_t size, size_t capacity) {
    char word[kMessageBytes + 8];
    char buffer[kMessageBytes + 8];
    const size_t length = size - strlen(R"({"nota":""})");
    memset(word, 'x', length);
    word[length] = '\0';
    Writer writer(buffer, capacity);
    writer.word("nota", word);
    return writer.finish();
}

bool readable(size_t size) {
    uint8_t bytes[kMessageBytes + 8];
    memset(bytes, ' ', sizeof bytes);
    memcpy(bytes, R"({"paro":1})", 10);
    Object object;
    return object.read(bytes, size);
}

Telemetry fullest() {
    Telemetry said;
    said.axes = kMostAxes;
    for (double& angle : said.q_deg) {
        angle = -999999.9999;
    }
    said.number = said.boot_id = UINT32_MAX;
    said.homed = said.effector = said.has_piece_sensor = said.piece = true;
    Message goal;
    goal.seq = goal.epoch = {true, UINT32_MAX};
    memcpy(goal.token.text, "0123456789ab", sizeof goal.token.text);
    said.receipts.objection(goal);
    said.receipts.accept(goal);
    said.receipts.finish(goal);
    said.receipts.refuse(Refusal::kRetained, goal.seq, goal.epoch);
    return said;
}

Ring<int, 8> ring;

void* put_all(void*) {
    for (int number = 0; number < 20000;) {
        number += ring.put(number) ? 1 : 0;
    }
    return nullptr;
}

}  // namespace

TEST(a_writer_writes_512_bytes_and_not_513) {
    CHECK(written(511, kMessageBytes) == 511);
    CHECK(written(512, kMessageBytes) == 512);
    CHECK(written(513, kMessageBytes) == 0);
}

TEST(a_reader_reads_512_bytes_and_not_513) {
    CHECK(readable(511));
    CHECK(readable(512));
    CHECK(!readable(513));
}

TEST(the_fullest_telemetry_of_six_axes_fits) {
    char buffer[kMessageBytes];
    const size_t size = encode(fullest(), buffer, sizeof buffer);
    CHECK(size > 200 && size <= kMessageBytes);
    CHECK(encode(fullest(), buffer, size) == size);
    CHECK(encode(fullest(), buffer, size - 1) == 0);
}

TEST(a_ramp_ignores_numbers_that_are_none) {
    Stepper stepper;
    stepper.set_max_speed(1000.0F);
    stepper.set_acceleration(1000.0F);
    const float none[] = {0.0F, NAN, INFINITY, -INFINITY};
    for (const float bad : none) {
        stepper.set_max_speed(bad);
        stepper.set_acceleration(bad);
    }
    stepper.move_to(10);
    uint32_t now_us = 0;
    for (; !stepper.still() && now_us < 1000000; ++now_us) {
        stepper.run(now_us);
    }
    CHECK(stepper.position() == 10);
    CHECK(now_us > 100000 && now_us < 300000);
}

TEST(a_target_is_rounded_to_the_nearest_motor_step) {
    const Joint& q2 = kScara.joints[1];
    CHECK(steps(q2, 0.44) == 0 && steps(q2, 0.46) == 1);
    CHECK(steps(q2, -0.44) == 0 && steps(q2, -0.46) == -1);
    CHECK(steps(q2, 10.0) == 11 && steps(q2, 9.9) == 11);
}

TEST(a_ring_hands_over_everything_in_order) {
    pthread_t other;
    pthread_create(&other, nullptr, put_all, nullptr);
    bool ordered = true;
    for (int wanted = 0, got = 0; wanted < 20000;) {
        if (ring.take(&got)) {
            ordered = ordered && got == wanted;
            ++wanted;
        }
    }
    pthread_join(other, nullptr);
    CHECK(ordered);
}

TEST(a_full_ring_refuses) {
    Ring<int, 2> small;
    int got = 0;
    CHECK(!small.take(&got));
    CHECK(small.put(1) && small.put(2) && !small.put(3));
    CHECK(small.take(&got) && got == 1);
}

TEST(a_boot_id_differs_from_boot_to_boot) {
    CHECK(boot_id(0, 0) != 0);
    CHECK(boot_id(7, 0xFFFFFFFF) != boot_id(8, 0xFFFFFFFF));
    CHECK(boot_id(7, 1) != boot_id(7, 2));
}

TEST(an_effector_comes_back_on_only_where_that_was_kept) {
    CHECK(kept_on(keep(true)));
    CHECK(!kept_on(keep(false)));
    CHECK(!kept_on({0, 0}));
    CHECK(!kept_on({0xFFFFFFFF, 0xFFFFFFFF}));
    CHECK(!kept_on({keep(true).said, 0}));
}

TEST(what_was_told_is_fresh_for_two_seconds_and_dated_by_the_quarter) {
    Freshness freshness;
    CHECK(!freshness.covers(0, 0));
    freshness.tell(0, 1);
    freshness.tell(249999, 2);
    freshness.tell(250000, 3);
    CHECK(freshness.covers(2000000, 1) && !freshness.covers(2000000, 0) && !freshness.covers(2000000, 4));
    CHECK(freshness.covers(2000001, 3) && !freshness.covers(2000001, 2));
    CHECK(!freshness.covers(2250001, 3));
}

TEST(what_was_told_for_long_is_remembered_as_far_as_it_is_fresh) {
    Freshness freshness;
    for (uint32_t number = 1; number <= 100; ++number) {
        freshness.tell(number * 100000, number);
    }
    CHECK(freshness.covers(10000000, 82) && freshness.covers(10000000, 100));
    CHECK(!freshness.covers(10000000, 79) && !freshness.covers(10000000, 101));
}

}  // namespace arboleda

int main() { return check::run(); }
