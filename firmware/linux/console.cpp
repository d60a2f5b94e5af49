#include "console.h"

#include <stdio.h>
#include <string.h>

#include "program.h"

namespace arboleda {

namespace {

constexpr char kHelp[] =
    "reboot           power lost and back\n"
    "stall MS         its loop hangs so long; at speed this loses steps\n"
    "mute S           it goes on, and publishes nothing\n"
    "lose JOINT STEPS an axis slips, joints from 1; the counter does not notice\n"
    "press JOINT 0|1  a homing switch is closed, wherever the arm is\n"
    "fail, repair     a driver's alarm, and its end\n"
    "supply 0|1       parts lie at their places\n"
    "grip 0|1         the effector closes on parts\n"
    "stick 0|1        the effector does not follow its switch\n"
    "drop             the part falls\n"
    "state            where the arm is\n"
    "quit             end\n";

constexpr uint64_t kUsPerMs = 1000;
constexpr int kLongest = 3600000;

void say_state(const Board& board, World* world) {
    const Axes& axes = board.axes();
    for (uint8_t axis = 0; axis < axes.count(); ++axis) {
        printf("q%d %.4f deg, %ld steps counted, %ld true\n", axis + 1, axes.degrees(axis),
               static_cast<long>(axes[axis].position()), static_cast<long>(world->true_steps(axis)));
    }
    printf("estado %d, homed %d, effector %d, refused %lu, lost steps %lu\n", static_cast<int>(board.state()),
           board.homed(), world->effector(), static_cast<unsigned long>(board.refusals()),
           static_cast<unsigned long>(board.lost_steps()));
}

bool is(const char* word, const char* known) { return strcmp(word, known) == 0; }

// The words that only touch board and world; false for any other.
bool done_here(const char* word, int first, int second, uint64_t now_us, Board* board, World* world) {
    const bool yes = first != 0;
    if (is(word, "fail")) {
        board->fail(now_us);
    } else if (is(word, "repair")) {
        board->repair(now_us);
    } else if (is(word, "lose") && first >= 1 && first <= board->axes().count()) {
        world->slip(static_cast<uint8_t>(first - 1), second);
    } else if (is(word, "press") && first >= 1 && first <= board->axes().count()) {
        world->pressed[first - 1] = second != 0;
    } else if (is(word, "supply")) {
        world->supplied = yes;
    } else if (is(word, "grip")) {
        world->grips = yes;
    } else if (is(word, "stick")) {
        world->stuck = yes;
    } else if (is(word, "drop")) {
        world->drop();
    } else if (is(word, "state")) {
        say_state(*board, world);
    } else {
        return false;
    }
    return true;
}

}  // namespace

Wish obey(const char* line, uint64_t now_us, Board* board, World* world) {
    char word[16] = "";
    int first = 0;
    int second = 0;
    const int read = sscanf(line, "%15s %d %d", word, &first, &second);
    const bool span = read >= 2 && first > 0 && first <= kLongest;
    if (read < 1 || done_here(word, first, second, now_us, board, world)) {
        return Wish();
    }
    if (is(word, "quit")) {
        return {Wish::What::kQuit, 0};
    }
    if (is(word, "reboot")) {
        return {Wish::What::kReboot, 0};
    }
    if (is(word, "stall") && span) {
        return {Wish::What::kStall, static_cast<uint64_t>(first) * kUsPerMs};
    }
    if (is(word, "mute") && span) {
        return {Wish::What::kMute, static_cast<uint64_t>(first) * kUsPerS};
    }
    printf("%s", kHelp);
    return Wish();
}

}  // namespace arboleda
