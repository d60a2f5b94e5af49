// The firmware's board as a program: the core, an arm that is not there, a real broker.
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "../core/board.h"
#include "../core/keepsakes.h"
#include "../core/scara.h"
#include "console.h"
#include "link.h"
#include "options.h"
#include "program.h"
#include "world.h"

namespace {

using namespace arboleda;

Config configured(const Options& options) {
    Config config = scara_config();
    config.level = options.level;
    return config;
}

// The board and what it stands in; its steps are taken when they were due, however late this process runs.
class Program final : public Voice {
public:
    explicit Program(const Options& options);

    int run();
    void present() override { link_.present("1"); }
    void tell(const Telemetry& said) override;

private:
    void pose(const double* degrees, int32_t* steps) const;
    void catch_up(uint64_t until_us);
    void wait();
    void hear();
    void grant(const Wish& wish);
    uint32_t next_boot_id() { return boot_id(boots_++, static_cast<uint32_t>(rand())); }

    const Options& options_;
    const Config config_;
    World world_;
    Link link_;
    Board board_;
    uint32_t boots_ = static_cast<uint32_t>(time(nullptr));
    uint64_t muted_until_us_ = 0;
    Lines lines_;
    bool over_ = false;
};

Program::Program(const Options& options)
    : options_(options),
      config_(configured(options)),
      world_(config_),
      link_(options),
      board_(config_, world_, *this) {
    int32_t at[kMostAxes] = {};
    for (int place = 0; place < options.places; ++place) {
        pose(options.places_deg[place], at);
        world_.add_place(at);
    }
    pose(options.at_deg, at);
    world_.put(at);
    board_.boot(now_us(), next_boot_id(), true);
    board_.stand_at(at);
}

void Program::pose(const double* degrees, int32_t* at) const {
    for (uint8_t axis = 0; axis < config_.robot->axes; ++axis) {
        at[axis] = steps(config_.robot->joints[axis], degrees[axis]);
    }
}

int Program::run() {
    if (!link_.start()) {
        return 1;
    }
    while (!ended() && !over_) {
        catch_up(now_us());
        wait();
        catch_up(now_us());
        hear();
    }
    return 0;
}

void Program::tell(const Telemetry& said) {
    if (now_us() >= muted_until_us_) {
        link_.tell(said);
    }
}

void Program::catch_up(uint64_t until_us) {
    while (board_.next_us() <= until_us) {
        board_.poll(board_.next_us());
    }
}

// What a motor does between two reports shows nowhere: steps are caught up with every millisecond.
void Program::wait() {
    const char* line = lines_.wait(link_.wake_fd(), board_.next_us());
    over_ = over_ || (lines_.over() && options_.until_eof);
    if (line != nullptr) {
        const uint64_t now = now_us();
        catch_up(now);
        grant(obey(line, now, &board_, &world_));
        fflush(stdout);
    }
}

void Program::hear() {
    Heard heard;
    while (link_.take(&heard)) {
        const uint64_t now = now_us();
        catch_up(now);
        if (heard.what == Heard::What::kMessage) {
            board_.receive(now, heard.message);
        } else {
            board_.connect(now, heard.what == Heard::What::kUp);
        }
    }
}

void Program::grant(const Wish& wish) {
    switch (wish.what) {
        case Wish::What::kQuit:
            over_ = true;
            break;
        case Wish::What::kReboot:
            world_.power_up();
            board_.boot(now_us(), next_boot_id(), options_.assume_homed);
            break;
        case Wish::What::kStall:
            usleep(static_cast<useconds_t>(wish.duration_us));
            board_.poll(now_us());
            break;
        case Wish::What::kMute:
            muted_until_us_ = now_us() + wish.duration_us;
            break;
        default:
            break;
    }
}

}  // namespace

int main(int count, char** words) {
    Options options;
    int status = 0;
    if (!read_options(count, words, &options, &status)) {
        return status;
    }
    begin_program();
    Program program(options);
    return program.run();
}
