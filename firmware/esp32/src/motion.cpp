#include "motion.h"

#include <esp_timer.h>
#include <freertos/FreeRTOS.h>
#include <freertos/task.h>

#include "board.h"
#include "board_config.h"
#include "hang.h"
#include "machine.h"

namespace arboleda {

namespace {

constexpr int kCore = 1;
constexpr unsigned kPriority = 20;
constexpr uint32_t kStackBytes = 8192;
constexpr uint64_t kSpinUs = 2500;  // nearer than this, sleeping for a tick of 1 ms would come too late

uint64_t now_us() { return static_cast<uint64_t>(esp_timer_get_time()); }

float part_of_speed(const Settings& settings) { return static_cast<float>(settings.speed_percent) / 100.0F; }

Robot slowed(const Settings& settings) {
    Robot robot = kScara;
    for (uint8_t axis = 0; axis < robot.axes; ++axis) {
        robot.joints[axis].max_speed_steps_s *= part_of_speed(settings);
    }
    return robot;
}

Config configured(const Settings& settings, const Robot* robot) {
    Config config = scara_config();
    config.robot = robot;
    config.level = settings.numbered ? Level::kIds : Level::kJoints;
    config.has_piece_sensor = kPiecePin >= 0;
    config.effector_on_stop = settings.release_on_stop ? OnStop::kRelease : OnStop::kHold;
    for (uint8_t axis = 0; axis < robot->axes; ++axis) {
        config.home[axis].seek_steps_s *= part_of_speed(settings);
    }
    return config;
}

class Motion final : public Voice {
public:
    Motion(const Settings& settings, Exchange* exchange)
        : robot_(slowed(settings)),
          config_(configured(settings, &robot_)),
          exchange_(*exchange),
          board_(config_, machine_, *this) {}

    void begin(uint32_t boot_id) {
        machine_.begin();
        board_.boot(now_us(), boot_id, false);
    }

    void turn() {
        Heard heard;
        machine_.look(now_us());
        board_.poll(now_us());
        if (exchange_.heard.take(&heard)) {
            hear(heard);
        }
        watch_alarm();
        exchange_.moving = board_.axes().moving();
        exchange_.lost_steps = board_.lost_steps();
        exchange_.refusals = board_.refusals();
    }

    void sleep() const {
        const uint64_t now = now_us();
        const uint64_t next = board_.next_us();
        if (next == kNever || next > now + kSpinUs) {
            vTaskDelay(1);
        }
    }

    void present() override { exchange_.said.put({true, Telemetry()}); }
    void tell(const Telemetry& said) override { exchange_.said.put({false, said}); }

private:
    void hear(const Heard& heard) {
        if (heard.what == Heard::What::kMessage) {
            board_.receive(now_us(), heard.message);
        } else {
            board_.connect(now_us(), heard.what == Heard::What::kUp);
        }
    }

    void watch_alarm() {
        const bool alarm = machine_.alarm();
        if (alarm != alarmed_) {
            alarmed_ = alarm;
            alarm ? board_.fail(now_us()) : board_.repair(now_us());
        }
    }

    const Robot robot_;
    const Config config_;
    Exchange& exchange_;
    Machine machine_;
    Board board_;
    bool alarmed_ = false;
};

void run(void* motion) {
    watch_for_hangs();
    for (;;) {
        static_cast<Motion*>(motion)->turn();
        static_cast<Motion*>(motion)->sleep();
        turned();
    }
}

}  // namespace

void start_motion(const Settings& settings, uint32_t boot_id, Exchange* exchange) {
    static Motion motion(settings, exchange);
    motion.begin(boot_id);
    xTaskCreatePinnedToCore(run, "motion", kStackBytes, &motion, kPriority, nullptr, kCore);
}

}  // namespace arboleda
