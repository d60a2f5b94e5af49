// What the board of a declared device does beyond the virtual one: inputs, outputs, a servo, an analog value.
#include "check.h"
#include "device_bench.h"

namespace arboleda {

namespace {

constexpr uint64_t kMsUs = 1000;
constexpr uint64_t kSecondUs = 1000000;

enum Fact : uint8_t { kGate, kClamped, kPart, kPressed, kBar, kProgram };
enum Input : uint8_t { kGateUp, kGateDown, kClampIn, kPartIn };
enum Output : uint8_t { kClamp, kPump, kRelief };
constexpr double kClosed = 0.0;
constexpr double kOpen = 1.0;
constexpr double kBetween = 2.0;

constexpr const char* kOpenGate = R"({"verbo":"open","seq":1,"epoca":5})";
constexpr const char* kHalt = R"({"paro":2,"seq":90,"epoca":5})";
constexpr const char* kLatch = R"({"paro":1,"seq":90,"epoca":5})";

// Clamped behind a closed gate, and pressing as order 3.
void press(DeviceBench& bench) {
    bench.order(R"({"verbo":"clamp","valores":{"on":true},"seq":1,"epoca":5})");
    bench.run(kSecondUs);
    bench.order(R"({"verbo":"press","valores":{"program":2},"seq":3,"epoca":5})");
}

bool same(double one, double other) { return one - other < 0.001 && other - one < 0.001; }

}  // namespace

TEST(power_finds_outputs_safe_and_servos_slack) {
    DeviceBench bench;
    CHECK(!bench.world.output(kClamp) && !bench.world.output(kPump) && bench.world.output(kRelief));
    CHECK(bench.world.pulse_us(0) == 0);
    press(bench);
    CHECK(bench.world.output(kClamp) && bench.world.output(kPump) && !bench.world.output(kRelief));
    bench.board.boot(bench.now_us, 101);
    CHECK(!bench.world.output(kClamp) && !bench.world.output(kPump) && bench.world.output(kRelief));
    CHECK(bench.last.boot_id == 101 && !bench.last.receipts.numbers().accepted().known);
}

TEST(facts_are_what_inputs_say_and_not_what_was_told) {
    DeviceBench bench;
    bench.world.stuck = true;
    bench.order(R"({"verbo":"clamp","valores":{"on":true},"seq":1,"epoca":5})");
    bench.run(kSecondUs);
    CHECK(bench.world.output(kClamp) && bench.last.facts[kClamped] == 0.0);
    bench.world.put(kClampIn, true);
    bench.run(100 * kMsUs);
    CHECK(bench.last.facts[kClamped] == 1.0);
}

TEST(work_that_inputs_do_not_confirm_in_time_is_given_up) {
    DeviceBench bench;
    bench.world.stuck = true;
    bench.order(kOpenGate);
    bench.run(3900 * kMsUs);
    CHECK(bench.last.state == State::kMoving);
    bench.run(200 * kMsUs);
    CHECK(bench.failed(1, "plazo") && !bench.done(1) && bench.last.state == State::kStopped);
}

TEST(a_switch_that_inputs_do_not_confirm_is_given_up_as_well) {
    DeviceBench bench;
    bench.world.stuck = true;
    bench.order(R"({"verbo":"clamp","valores":{"on":true},"seq":1,"epoca":5})");
    bench.run(3100 * kMsUs);
    CHECK(bench.failed(1, "plazo"));
}

TEST(work_is_done_when_inputs_say_so_and_the_servo_is_there) {
    DeviceBench bench;
    bench.order(kOpenGate);
    CHECK(bench.last.state == State::kMoving);
    bench.run(700 * kMsUs);
    CHECK(!bench.done(1));
    bench.run(200 * kMsUs);
    CHECK(bench.done(1) && bench.last.facts[kGate] == kOpen && bench.last.state == State::kStopped);
}

TEST(a_servo_goes_no_faster_than_it_can) {
    DeviceBench bench;
    bench.order(kOpenGate);  // the first way of all: nobody knows from where, so its pulse is there at once
    CHECK(bench.world.pulse_us(0) == 2000);
    bench.run(2 * kSecondUs);
    bench.order(R"({"verbo":"close","seq":2,"epoca":5})");
    bench.run(250 * kMsUs);  // 120 deg/s: 30 of 90 degrees
    CHECK(bench.world.pulse_us(0) > 1640 && bench.world.pulse_us(0) < 1700);
    bench.run(550 * kMsUs);
    CHECK(bench.world.pulse_us(0) == 1000);
}

TEST(a_halted_servo_stays_where_it_is) {
    DeviceBench bench;
    bench.order(kOpenGate);
    bench.run(2 * kSecondUs);
    bench.order(R"({"verbo":"close","seq":2,"epoca":5})");
    bench.run(250 * kMsUs);
    bench.send(Channel::kStop, kHalt);
    const uint16_t there = bench.world.pulse_us(0);
    bench.run(5 * kSecondUs);
    CHECK(bench.world.pulse_us(0) == there && there > 1600 && !bench.done(2));
}

TEST(a_servo_that_is_halted_on_its_first_way_goes_slack) {
    DeviceBench bench;
    bench.order(kOpenGate);
    bench.run(100 * kMsUs);
    bench.send(Channel::kStop, kHalt);
    CHECK(bench.world.pulse_us(0) == 0);
}

TEST(what_only_belongs_to_work_ends_with_it_however_that_ends) {
    DeviceBench done;
    press(done);
    done.run(3 * kSecondUs);
    CHECK(done.done(3) && !done.world.output(kPump));

    DeviceBench halted;
    press(halted);
    halted.send(Channel::kStop, kHalt);
    CHECK(!halted.world.output(kPump) && halted.world.output(kClamp) && !halted.world.output(kRelief));

    DeviceBench silent;
    silent.send(Channel::kBeat, R"({"epoca":5})");
    press(silent);
    silent.run(990 * kMsUs);
    CHECK(silent.world.output(kPump));
    silent.run(20 * kMsUs);
    CHECK(!silent.world.output(kPump) && silent.failed(3, "silencio"));

    DeviceBench alarmed;
    press(alarmed);
    alarmed.board.fail(alarmed.now_us);
    CHECK(!alarmed.world.output(kPump) && alarmed.failed(3, "alarma") && alarmed.last.state == State::kFault);
}

TEST(a_latch_makes_safe_what_is_wired_so_and_leaves_the_clamp) {
    DeviceBench bench;
    press(bench);
    bench.send(Channel::kStop, kLatch);
    CHECK(!bench.world.output(kPump) && bench.world.output(kRelief) && bench.world.output(kClamp));
    CHECK(bench.last.state == State::kLatched);
    bench.order(R"({"verbo":"relieve","seq":91,"epoca":5})");
    CHECK(bench.last.receipts.numbers().refusal() == Refusal::kStopped);
    bench.order(R"({"verbo":"clamp","valores":{"on":true},"seq":92,"epoca":5})");
    CHECK(bench.last.receipts.numbers().refusal() == Refusal::kStopped);
    CHECK(bench.last.receipts.numbers().refused() == 92);
    bench.order(R"({"verbo":"clamp","valores":{"on":false},"seq":93,"epoca":5})");
    CHECK(!bench.world.output(kClamp) && bench.last.receipts.numbers().accepted().value == 93);
}

TEST(a_bouncing_input_counts_once_it_has_settled) {
    DeviceBench bench;
    const int before = bench.told;
    for (int bounce = 0; bounce < 10; ++bounce) {
        bench.world.put(kPartIn, bounce % 2 == 0);
        bench.run(4 * kMsUs);
    }
    CHECK(bench.board.fact(kPart) == 0.0 && bench.told == before);
    bench.world.put(kPartIn, true);
    bench.run(30 * kMsUs);
    CHECK(bench.last.facts[kPart] == 1.0 && bench.told == before + 1);
}

TEST(inputs_that_flap_do_not_flood_the_broker) {
    DeviceBench bench;
    const int before = bench.told;
    const uint8_t inputs[] = {kGateDown, kClampIn, kPartIn};
    for (int at = 0; at < 33; ++at) {  // each counts on its own: a change every 10 ms
        for (const uint8_t input : inputs) {
            bench.world.put(input, at % 2 == 0);
            bench.run(10 * kMsUs);
        }
    }
    CHECK(bench.told - before > 40);
    CHECK(bench.told - before <= 60);  // in a second: 10 by the clock, and at most one each 20 ms
}

TEST(an_analog_value_is_scaled_smoothed_and_rounded_and_waits_for_its_turn) {
    DeviceBench bench;
    bench.run(kSecondUs);
    const int before = bench.told;
    bench.world.set_counts(0, 1393);  // 3 bar
    bench.run(100 * kMsUs);
    CHECK(bench.told - before <= 2);
    bench.run(400 * kMsUs);
    CHECK(same(bench.last.facts[kBar], 3.0));
    bench.world.set_counts(0, 1402);  // 3.03 bar
    bench.run(500 * kMsUs);
    CHECK(same(bench.last.facts[kBar], 3.0));
}

TEST(a_comparator_has_a_hysteresis) {
    DeviceBench bench;
    const uint16_t counts[] = {1720, 1852, 1720, 1622};  // 4.0, 4.4, 4.0, 3.7 bar: on above 4.2, off below 3.8
    const double pressed[] = {0.0, 1.0, 1.0, 0.0};
    for (int at = 0; at < 4; ++at) {
        bench.world.set_counts(0, counts[at]);
        bench.run(500 * kMsUs);
        CHECK(bench.last.facts[kPressed] == pressed[at]);
    }
}

TEST(a_torn_off_sensor_is_a_fault_until_it_is_back) {
    DeviceBench bench;
    press(bench);
    bench.world.set_counts(0, 0);
    bench.run(kSecondUs);
    CHECK(bench.last.state == State::kFault && bench.failed(3, "alarma") && !bench.world.output(kPump));
    bench.order(R"({"verbo":"relieve","seq":4,"epoca":5})");
    CHECK(bench.last.receipts.numbers().refusal() == Refusal::kBusy);
    bench.world.set_counts(0, 410);
    bench.run(kSecondUs);
    CHECK(bench.last.state == State::kStopped);
}

TEST(switches_that_contradict_each_other_are_a_fault_and_change_no_fact) {
    DeviceBench bench;
    bench.world.put(kGateUp, true);  // and down as well
    bench.run(150 * kMsUs);
    CHECK(bench.last.state == State::kStopped);
    bench.run(200 * kMsUs);
    CHECK(bench.last.state == State::kFault && bench.last.facts[kGate] == kClosed);
    bench.world.put(kGateDown, false);
    bench.run(100 * kMsUs);
    CHECK(bench.last.state == State::kStopped && bench.last.facts[kGate] == kOpen);
}

TEST(a_gate_that_was_pushed_is_told_at_once_and_between_is_a_word) {
    DeviceBench bench;
    bench.run(50 * kMsUs);
    bench.world.put(kGateDown, false);
    bench.run(25 * kMsUs);
    CHECK(bench.last.facts[kGate] == kBetween);
}

TEST(a_query_is_answered_by_what_inputs_say_then) {
    DeviceBench bench;
    bench.order(R"({"verbo":"look","seq":1,"epoca":5})");
    bench.run(110 * kMsUs);
    CHECK(bench.last.receipts.answer().seq.value == 1 && bench.last.receipts.answer().choice == 1);
    bench.world.put(kPartIn, true);
    bench.order(R"({"verbo":"look","seq":2,"epoca":5})");
    bench.run(110 * kMsUs);
    CHECK(bench.last.receipts.answer().seq.value == 2 && bench.last.receipts.answer().choice == 0);
}

TEST(a_value_that_the_kind_does_not_have_drives_nothing) {
    DeviceBench bench;
    bench.order(R"({"verbo":"clamp","valores":{"on":1},"seq":1,"epoca":5})");
    CHECK(bench.last.receipts.numbers().refusal() == Refusal::kFormat && !bench.world.output(kClamp));
    bench.order(R"({"verbo":"hammer","seq":2,"epoca":5})");
    CHECK(bench.last.receipts.numbers().refused() == 2);
}

TEST(an_order_that_waited_is_too_late_and_drives_nothing) {
    DeviceBench bench;
    bench.run(3 * kSecondUs);
    char text[96];
    const uint32_t heard = bench.last.number;
    bench.run(2300 * kMsUs);
    snprintf(text, sizeof text, R"({"verbo":"clamp","valores":{"on":true},"seq":1,"epoca":5,"visto":%u})", heard);
    bench.order(text);
    CHECK(bench.last.receipts.numbers().refusal() == Refusal::kLate && !bench.world.output(kClamp));
    snprintf(text, sizeof text, R"({"verbo":"clamp","valores":{"on":true},"seq":2,"epoca":5,"visto":%u})",
             bench.last.number);
    bench.order(text);
    CHECK(bench.last.receipts.numbers().accepted().value == 2 && bench.world.output(kClamp));
}

TEST(even_what_lets_go_may_come_too_late_and_a_stop_never) {
    DeviceBench bench;
    press(bench);
    bench.run(4 * kSecondUs);
    bench.order(R"({"verbo":"clamp","valores":{"on":false},"seq":4,"epoca":5,"visto":1})");
    CHECK(bench.last.receipts.numbers().refusal() == Refusal::kLate && bench.world.output(kClamp));
    bench.order(R"({"verbo":"hammer","seq":4,"epoca":5,"visto":1})");
    CHECK(bench.last.receipts.numbers().refusal() == Refusal::kFormat);
    bench.send(Channel::kStop, R"({"paro":1,"seq":5,"epoca":5,"visto":1})");
    CHECK(bench.last.state == State::kLatched);
}

TEST(a_copy_does_not_open_the_gate_again) {
    DeviceBench bench;
    bench.order(kOpenGate);
    bench.run(2 * kSecondUs);
    const int before = bench.moves;
    bench.world.put(kGateUp, false);
    bench.order(kOpenGate);
    bench.run(kSecondUs);
    CHECK(bench.moves == before && bench.done(1));
}

TEST(the_fullest_report_of_the_press_fits) {
    DeviceBench bench;
    DeviceTelemetry said = bench.last;
    said.number = said.boot_id = UINT32_MAX;
    Message head;
    head.seq = head.epoch = {true, UINT32_MAX};
    said.receipts.objection(head);
    said.receipts.accept(head);
    said.receipts.finish(head);
    said.receipts.refuse(Refusal::kCondition, head.seq, head.epoch);
    said.receipts.answered(head, 5, 0);
    for (int at = 0; at < 4; ++at) {
        said.receipts.fail(head, "silencio");
    }
    said.facts[kBar] = -999999999.9999;
    char buffer[kMessageBytes];
    const size_t size = encode(kDevice, said, buffer, sizeof buffer);
    CHECK(size > 300 && encode(kDevice, said, buffer, size) == size && encode(kDevice, said, buffer, size - 1) == 0);
}

TEST(tokens_are_told_where_there_is_room_for_them) {
    DeviceBench bench;
    bench.order(R"({"verbo":"open","seq":1,"epoca":5,"ficha":"0a3f9x001a01"})");
    bench.run(2 * kSecondUs);
    CHECK(strcmp(bench.last.receipts.numbers().accepted_token(), "0a3f9x001a01") == 0);
    CHECK(strcmp(bench.last.receipts.numbers().finished_token(), "0a3f9x001a01") == 0);
    char buffer[kMessageBytes + 1] = {};
    const size_t size = encode(kDevice, bench.last, buffer, kMessageBytes);
    CHECK(strstr(buffer, R"("ficha_ack":"0a3f9x001a01","ficha_hecho":"0a3f9x001a01")") != nullptr);
    memset(buffer, 0, sizeof buffer);
    const size_t without = encode(kDevice, bench.last, buffer, size - 1);
    CHECK(without > 0 && without < size && strstr(buffer, "ficha") == nullptr);
}

}  // namespace arboleda
