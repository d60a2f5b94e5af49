// The task of a declared device on core 1: the only one that touches its board, and never the network.
#include <esp_timer.h>
#include <freertos/FreeRTOS.h>
#include <freertos/task.h>

#include "device_board.h"
#include "device_config.h"
#include "device_machine.h"
#include "hang.h"
#include "motion.h"

namespace arboleda {

namespace {

constexpr int kCore = 1;
constexpr unsigned kPriority = 20;
constexpr uint32_t kStackBytes = 8192;

uint64_t now_us() { return static_cast<uint64_t>(esp_timer_get_time()); }

class DeviceMotion final : public DeviceVoice {
public:
    explicit DeviceMotion(Exchange* exchange) : exchange_(*exchange) {}

    void begin(uint32_t boot_id) {
        machine_.begin();
        board_.boot(now_us(), boot_id);
    }

    void turn() {
        Heard heard;
        board_.poll(now_us());
        if (exchange_.heard.take(&heard)) {
            hear(heard);
        }
        exchange_.moving = board_.working();
        exchange_.refusals = board_.refusals();
    }

    void present() override { exchange_.said.put({true, DeviceTelemetry()}); }
    void tell(const DeviceTelemetry& said) override { exchange_.said.put({false, said}); }

private:
    void hear(const Heard& heard) {
        if (heard.what != Heard::What::kMessage) {
            board_.connect(now_us(), heard.what == Heard::What::kUp);
        } else if (heard.message.is_order) {
            board_.receive(now_us(), heard.message.order);
        } else {
            board_.receive(now_us(), heard.message.message);
        }
    }

    Exchange& exchange_;
    DeviceMachine machine_;
    DeviceBoard board_{kDevice, machine_, *this};
};

void run(void* motion) {
    watch_for_hangs();  // a reset makes outputs safe
    for (;;) {
        static_cast<DeviceMotion*>(motion)->turn();
        vTaskDelay(1);
        turned();
    }
}

}  // namespace

void start_motion(const Settings&, uint32_t boot_id, Exchange* exchange) {
    static DeviceMotion motion(exchange);
    motion.begin(boot_id);
    xTaskCreatePinnedToCore(run, "device", kStackBytes, &motion, kPriority, nullptr, kCore);
}

}  // namespace arboleda
