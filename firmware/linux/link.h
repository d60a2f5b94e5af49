// The board's MQTT client. Its own thread hears; the board's thread takes what it heard, and publishes.
#pragma once

#include <mosquitto.h>
#include <pthread.h>

#include "../core/profile.h"
#include "../core/ring.h"
#include "options.h"

namespace arboleda {

struct Heard {
    enum class What : uint8_t { kUp, kDown, kMessage } what = What::kDown;
    profile::Incoming message;
};

class Link {
public:
    explicit Link(const Options& options);
    ~Link();

    bool start();  // false: a sentence was said on standard error
    int wake_fd() const { return wake_[0]; }
    bool take(Heard* heard);
    int present(const char* there);  // `conexion`: "1" or "0", retained; the number of the message
    void tell(const profile::Outgoing& said);

private:
    void on_connect(int refusal);
    void on_subscribe(int count, const int* granted);
    void serve();
    void leave();
    void on_message(const mosquitto_message& received);
    void put(const Heard& heard);
    void say_once(const char* trouble);

    const Options& options_;
    mosquitto* client_ = nullptr;
    int wake_[2] = {-1, -1};
    char topics_[profile::kTopics][96] = {};
    char presence_[96] = "";
    char telemetry_[96] = "";
    pthread_t thread_ = {};
    bool served_ = false;  // the thread runs
    volatile bool leaving_ = false;
    volatile int last_sent_ = 0;  // number of the message that the broker acknowledged last
    const char* trouble_ = nullptr;  // what was said of it last
    Ring<Heard, 64> heard_;
};

}  // namespace arboleda
