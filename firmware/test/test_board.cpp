// What the core does beyond the virtual board: switches, lost steps, held-back targets, the effector on a stop.
#include "bench.h"
#include "check.h"

namespace arboleda {

namespace {

constexpr uint64_t kSecondUs = 1000000;

constexpr const char* kMove = R"({"q1":45,"q2":45,"q3":90,"seq":1,"epoca":5})";
constexpr const char* kFresh = R"({"q1":45,"q2":45,"q3":90,"seq":2,"epoca":5,"visto":%u})";
constexpr const char* kHome = R"({"ref":1,"seq":1,"epoca":5})";

bool at_reference(World& world) {
    return world.true_steps(0) == 0 && world.true_steps(1) == 0 && world.true_steps(2) == 0;
}

// All homing switches look closed for so long.
void press_all(Bench& bench, uint64_t pulse_us) {
    memset(bench.world.pressed, 1, sizeof bench.world.pressed);
    bench.board.poll(bench.now_us);
    bench.run(pulse_us - 1);
    memset(bench.world.pressed, 0, sizeof bench.world.pressed);
    ++bench.now_us;
    bench.board.poll(bench.now_us);
}

// The move of number 2, by who had heard so much of the board.
void move_after(Bench& bench, uint32_t heard) {
    char text[96];
    snprintf(text, sizeof text, kFresh, heard);
    bench.send(Channel::kJoints, text);
}

// The same, which waited so long on its way to a board that has run for a while.
void move_that_waited(Bench& bench, uint64_t waited_us) {
    bench.run(5 * kSecondUs);
    const uint32_t heard = bench.last.number;
    bench.run(waited_us);
    move_after(bench, heard);
}

}  // namespace

TEST(homing_finds_the_reference_from_anywhere) {
    const int32_t places[][3] = {{0, 0, 0}, {7000, 140, 280}, {-7776, -150, 0}, {-7900, -160, -10}};
    for (const auto& place : places) {
        Bench bench;
        bench.world.put(place);
        bench.board.boot(bench.now_us, 101, false);
        CHECK(bench.board.state() == State::kNotHomed);
        bench.send(Channel::kHome, kHome);
        CHECK(bench.board.state() == State::kMoving);
        bench.run(60 * kSecondUs);
        CHECK(bench.board.homed());
        CHECK(bench.board.state() == State::kStopped);
        CHECK(bench.last.receipts.finished().known && bench.last.receipts.finished().value == 1);
        CHECK(at_reference(bench.world));
        CHECK(bench.board.axes()[0].position() == 0);
    }
}

TEST(homing_raises_the_tool_before_the_arm_turns) {
    Bench bench;
    const int32_t low[] = {1000, 50, 200};
    bench.world.put(low);
    bench.board.boot(bench.now_us, 101, false);
    bench.send(Channel::kHome, kHome);
    bench.run(kSecondUs);
    CHECK(bench.world.true_steps(0) == 1000 && bench.world.true_steps(1) == 50);
    CHECK(bench.world.true_steps(2) < 200);
}

TEST(homing_with_a_dead_switch_is_a_fault) {
    Config config = scara_config();
    config.home[0].switch_steps = -1000000;
    Bench bench(config);
    bench.send(Channel::kHome, kHome);
    bench.run(60 * kSecondUs);
    CHECK(bench.board.state() == State::kFault);
    CHECK(!bench.board.homed());
    CHECK(!bench.last.receipts.finished().known);
}

TEST(homing_with_a_stuck_switch_is_a_fault) {
    Config config = scara_config();
    config.home[2].switch_steps = 1000000;
    Bench bench(config);
    bench.send(Channel::kHome, kHome);
    bench.run(60 * kSecondUs);
    CHECK(bench.board.state() == State::kFault);
}

TEST(a_halt_ends_homing_and_leaves_the_board_not_homed) {
    Bench bench;
    bench.send(Channel::kHome, kHome);
    bench.run(2 * kSecondUs);
    bench.send(Channel::kStop, R"({"paro":2,"seq":2,"epoca":5})");
    bench.run(5 * kSecondUs);
    CHECK(bench.board.state() == State::kNotHomed);
    bench.send(Channel::kJoints, R"({"q1":1,"q2":1,"q3":1,"seq":3,"epoca":5})");
    CHECK(bench.last.receipts.refusal() == Refusal::kNotHomed);
}

TEST(after_homing_an_arm_has_its_full_speed_again) {
    Bench homed;
    homed.send(Channel::kHome, kHome);
    homed.run(60 * kSecondUs);
    homed.send(Channel::kJoints, R"({"q1":90,"q2":0,"q3":0,"seq":2,"epoca":5})");
    homed.run(1600000);  // 90 deg at 90 deg/s and 180 deg/s2 take 1.5 s
    CHECK(homed.board.state() == State::kStopped);
}

TEST(a_stalled_loop_at_speed_loses_steps_and_asks_for_homing) {
    Bench bench;
    bench.send(Channel::kJoints, kMove);
    bench.run(300000);
    bench.stall(20000);
    CHECK(bench.board.lost_steps() == 1);
    CHECK(bench.board.state() == State::kNotHomed);
    CHECK(!bench.last.receipts.finished().known);
    const int32_t there = bench.world.true_steps(0);
    bench.run(5 * kSecondUs);
    CHECK(bench.world.true_steps(0) == there);
    bench.send(Channel::kJoints, R"({"q1":0,"q2":0,"q3":0,"seq":2,"epoca":5})");
    CHECK(bench.last.receipts.refusal() == Refusal::kNotHomed);
}

TEST(a_stall_while_nothing_moves_loses_nothing) {
    Bench bench;
    bench.stall(3 * kSecondUs);
    CHECK(bench.board.lost_steps() == 0 && bench.board.homed());
}

TEST(missed_reports_are_not_made_up_for) {
    Bench bench;
    const int before = bench.told;
    bench.stall(350000);
    bench.run(40000);
    CHECK(bench.told == before + 1);
    bench.run(15000);
    CHECK(bench.told == before + 2);
}

TEST(a_late_poll_within_bounds_loses_nothing) {
    Bench bench;
    bench.send(Channel::kJoints, kMove);
    bench.run(300000);
    bench.stall(4000);
    bench.run(5 * kSecondUs);
    CHECK(bench.board.lost_steps() == 0);
    CHECK(bench.board.state() == State::kStopped && bench.last.receipts.finished().known);
}

TEST(a_switch_met_on_a_way_means_that_steps_were_lost) {
    Bench bench;
    bench.world.slip(0, -7500);
    bench.send(Channel::kJoints, R"({"q1":-90,"q2":0,"q3":0,"seq":1,"epoca":5})");
    bench.run(3 * kSecondUs);
    CHECK(bench.board.state() == State::kNotHomed);
    CHECK(bench.board.lost_steps() == 1);
}

TEST(a_switch_stops_a_move_once_it_was_closed_for_5_ms) {
    Bench bench;
    bench.send(Channel::kJoints, kMove);
    bench.run(300000);
    bench.world.pressed[2] = true;
    bench.board.poll(bench.now_us);
    bench.run(4999);
    CHECK(bench.board.state() == State::kMoving && bench.board.lost_steps() == 0);
    bench.run(1);
    CHECK(bench.board.state() == State::kNotHomed && bench.board.lost_steps() == 1);
}

// 1 us stands for the 80 ns that the ESP32 pulls its pins 36 and 39 down: however short, one look at them meets it.
TEST(a_short_pulse_at_a_switch_stops_nothing) {
    const uint64_t pulses_us[] = {1, 4999};
    for (const uint64_t pulse_us : pulses_us) {
        Bench bench;
        press_all(bench, pulse_us);
        bench.send(Channel::kJoints, kMove);
        for (int pulses = 0; pulses < 200; ++pulses) {
            press_all(bench, pulse_us);
            bench.run(1);
        }
        bench.run(5 * kSecondUs);
        CHECK(bench.board.lost_steps() == 0 && bench.board.homed());
        CHECK(bench.last.receipts.finished().value == 1);
    }
}

TEST(homing_finds_the_reference_while_short_pulses_come) {
    Bench bench;
    const int32_t there[] = {700, 140, 28};
    bench.world.put(there);
    bench.board.boot(bench.now_us, 101, false);
    bench.send(Channel::kHome, kHome);
    for (int pulses = 0; pulses < 8000; ++pulses) {
        press_all(bench, 1);
        bench.run(7000);
    }
    CHECK(bench.board.homed() && at_reference(bench.world));
}

TEST(a_switch_counts_before_an_axis_that_creeps_takes_its_next_step) {
    const Config config = scara_config();
    for (uint8_t axis = 0; axis < config.robot->axes; ++axis) {
        Stepper creeping;
        creeping.set_acceleration(config.robot->joints[axis].acceleration_steps_s2);
        creeping.set_max_speed(config.home[axis].creep_steps_s);
        creeping.move_to(100);
        uint32_t now_us = 0;
        while (!creeping.still()) {
            const uint32_t wait_us = creeping.wait_us(now_us);
            CHECK(wait_us > config.debounce_us + 4000);  // what is left for the motor to get there, and for bouncing
            now_us += wait_us;
            creeping.run(now_us);
        }
    }
}

TEST(alternating_targets_do_not_speed_a_motor_up) {
    Bench calm;
    calm.send(Channel::kJoints, R"({"q1":0,"q2":90,"q3":0,"seq":1,"epoca":5})");
    calm.run(200000);
    Bench bench;
    for (int seq = 1; seq < 400; ++seq) {
        char text[96];
        const char* q2 = seq % 2 != 0 ? "90" : "91";
        snprintf(text, sizeof text, R"({"q1":0,"q2":%s,"q3":0,"seq":%d,"epoca":5})", q2, seq);
        bench.send(Channel::kJoints, text);
        bench.run(500);
    }
    const int32_t ahead = bench.board.axes()[1].position() - calm.board.axes()[1].position();
    CHECK(ahead >= 0 && ahead <= 2);  // one for each target that was let through
    bench.run(5 * kSecondUs);
    CHECK(bench.last.receipts.finished().value == 399);
    CHECK(bench.board.axes()[1].position() == 100);
}

TEST(a_held_back_target_dies_with_a_halt) {
    Bench bench;
    bench.send(Channel::kJoints, kMove);
    bench.run(50000);
    bench.send(Channel::kJoints, R"({"q1":-45,"q2":0,"q3":0,"seq":2,"epoca":5})");
    bench.send(Channel::kStop, R"({"paro":2,"seq":3,"epoca":5})");
    bench.run(5 * kSecondUs);
    CHECK(bench.board.state() == State::kStopped);
    CHECK(bench.board.axes()[0].position() > 0 && bench.board.axes()[0].position() < 200);
}

TEST(an_effector_keeps_its_state_on_a_stop) {
    Bench bench;
    bench.send(Channel::kEffector, R"({"efector":1,"seq":1,"epoca":5})");
    bench.send(Channel::kStop, R"({"paro":1,"seq":2,"epoca":5})");
    CHECK(bench.world.effector() && bench.board.state() == State::kLatched);
}

TEST(an_effector_lets_go_on_a_stop_where_it_is_configured) {
    Config config = scara_config();
    config.effector_on_stop = OnStop::kRelease;
    Bench bench(config);
    bench.send(Channel::kEffector, R"({"efector":1,"seq":1,"epoca":5})");
    bench.send(Channel::kStop, R"({"paro":2,"seq":2,"epoca":5})");
    CHECK(bench.world.effector());
    bench.send(Channel::kStop, R"({"paro":1,"seq":3,"epoca":5})");
    CHECK(!bench.world.effector());
}

TEST(a_move_by_who_has_heard_the_board_lately_is_carried_out) {
    Bench bench;
    move_that_waited(bench, 1700000);
    CHECK(bench.board.state() == State::kMoving);
}

TEST(a_move_that_waited_is_too_late_and_moves_nothing) {
    Bench bench;
    move_that_waited(bench, 2300000);
    CHECK(bench.board.state() == State::kStopped && bench.last.receipts.refusal() == Refusal::kLate);
    CHECK(bench.last.receipts.refused() == 2);
}

TEST(a_move_by_who_heard_what_this_boot_never_told_is_too_late) {
    Bench bench;
    bench.run(5 * kSecondUs);
    const uint32_t heard = bench.last.number;
    move_after(bench, heard + 1);
    CHECK(bench.last.receipts.refusal() == Refusal::kLate);
    bench.board.boot(bench.now_us, 101, true);
    move_after(bench, heard);
    CHECK(bench.last.receipts.refusal() == Refusal::kLate && bench.board.state() == State::kStopped);
}

TEST(a_late_command_lets_nothing_go_and_a_late_stop_stops) {
    Bench bench;
    bench.send(Channel::kEffector, R"({"efector":1,"seq":1,"epoca":5})");
    bench.run(5 * kSecondUs);
    bench.send(Channel::kEffector, R"({"efector":0,"seq":2,"epoca":5,"visto":1})");
    CHECK(bench.world.effector() && bench.last.receipts.refused() == 2);
    bench.send(Channel::kStop, R"({"paro":1,"seq":3,"epoca":5,"visto":1})");
    CHECK(bench.board.state() == State::kLatched && bench.last.receipts.accepted().value == 3);
}

TEST(what_else_is_against_a_late_move_is_said_first) {
    Bench bench;
    bench.board.boot(bench.now_us, 101, false);
    move_that_waited(bench, 2300000);
    CHECK(bench.last.receipts.refusal() == Refusal::kNotHomed);
}

TEST(the_tokens_of_the_last_accepted_and_the_last_done_command_are_echoed) {
    Bench bench;
    bench.send(Channel::kJoints, R"({"q1":45,"q2":45,"q3":90,"seq":1,"epoca":5,"ficha":"0a3f9x001a01"})");
    bench.run(9 * kSecondUs);
    bench.send(Channel::kEffector, R"({"efector":1,"seq":2,"epoca":5,"ficha":"0a3f9x001b01"})");
    CHECK(strcmp(bench.last.receipts.accepted_token(), "0a3f9x001b01") == 0);
    CHECK(strcmp(bench.last.receipts.finished_token(), "0a3f9x001a01") == 0);
    CHECK(bench.last.receipts.finished().value == 1);
}

TEST(a_command_without_a_token_takes_the_place_of_the_one_before) {
    Bench bench;
    bench.send(Channel::kEffector, R"({"efector":1,"seq":1,"epoca":5,"ficha":"0a3f9x001b01"})");
    bench.send(Channel::kStop, R"({"paro":2,"seq":2,"epoca":5,"ficha":"0a3f9x001b01"})");
    CHECK(bench.last.receipts.accepted().value == 2 && bench.last.receipts.accepted_token()[0] == '\0');
}

TEST(a_refused_command_and_another_epoch_leave_no_token_of_theirs) {
    Bench bench;
    bench.send(Channel::kEffector, R"({"efector":1,"seq":1,"epoca":5,"ficha":"0a3f9x001b01"})");
    bench.send(Channel::kJoints, R"({"q1":999,"q2":45,"q3":90,"seq":2,"epoca":5,"ficha":"0a3f9x001c01"})");
    CHECK(strcmp(bench.last.receipts.accepted_token(), "0a3f9x001b01") == 0);
    bench.send(Channel::kJoints, R"({"q1":999,"q2":45,"q3":90,"seq":1,"epoca":6,"ficha":"0a3f9x001c01"})");
    CHECK(!bench.last.receipts.accepted().known && bench.last.receipts.accepted_token()[0] == '\0');
}

TEST(who_heard_a_board_before_it_was_away_has_to_hear_it_again) {
    Bench bench;
    bench.run(kSecondUs);
    const uint32_t heard = bench.last.number;
    bench.board.connect(bench.now_us, false);
    bench.run(3 * kSecondUs);
    bench.board.connect(bench.now_us, true);
    move_after(bench, heard);
    CHECK(bench.last.receipts.refusal() == Refusal::kLate);
    bench.send(Channel::kJoints, R"({"q1":1,"q2":1,"q3":1,"seq":3,"epoca":5})");
    CHECK(bench.last.receipts.accepted().value == 3);
}

}  // namespace arboleda
