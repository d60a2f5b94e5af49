#include "link.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

namespace arboleda {

namespace {

constexpr int kKeepaliveS = 5;
constexpr int kGoodbyeMs = 1000;
constexpr int kLookMs = 1000;  // the library looks at its keep-alive when it wakes
constexpr int kRetryMs = 500;

}  // namespace

Link::Link(const Options& options) : options_(options) {
    for (uint8_t channel = 0; channel < profile::kTopics; ++channel) {
        snprintf(topics_[channel], sizeof topics_[channel], "%s/%s", options.robot, profile::topic(channel));
    }
    snprintf(presence_, sizeof presence_, "%s/conexion", options.robot);
    snprintf(telemetry_, sizeof telemetry_, "%s/sensores", options.robot);
}

Link::~Link() {
    if (served_) {
        leave();
        mosquitto_destroy(client_);
    }
    mosquitto_lib_cleanup();
}

// The library drops what waits when it disconnects: the last word has to arrive before.
void Link::leave() {
    const int goodbye = present("0");
    for (int waited_ms = 0; goodbye != 0 && last_sent_ != goodbye && waited_ms < kGoodbyeMs; ++waited_ms) {
        usleep(1000);
    }
    leaving_ = true;
    mosquitto_disconnect(client_);
    pthread_join(thread_, nullptr);
}

bool Link::start() {
    mosquitto_lib_init();
    client_ = mosquitto_new(options_.robot, true, this);
    if (client_ == nullptr || pipe(wake_) != 0) {
        fprintf(stderr, "board: no memory for an MQTT client\n");
        return false;
    }
    fcntl(wake_[0], F_SETFL, O_NONBLOCK);
    fcntl(wake_[1], F_SETFL, O_NONBLOCK);
    mosquitto_int_option(client_, MOSQ_OPT_TCP_NODELAY, 1);
    mosquitto_will_set(client_, presence_, 1, "0", 1, true);
    mosquitto_threaded_set(client_, true);
    mosquitto_username_pw_set(client_, getenv("ARBOLEDA_MQTT_USER"), getenv("ARBOLEDA_MQTT_PASSWORD"));
    mosquitto_connect_callback_set(
        client_, [](mosquitto*, void* self, int refusal) { static_cast<Link*>(self)->on_connect(refusal); });
    mosquitto_disconnect_callback_set(client_, [](mosquitto*, void* self, int) {
        static_cast<Link*>(self)->put({Heard::What::kDown, profile::Incoming()});
    });
    mosquitto_publish_callback_set(
        client_, [](mosquitto*, void* self, int number) { static_cast<Link*>(self)->last_sent_ = number; });
    mosquitto_subscribe_callback_set(client_, [](mosquitto*, void* self, int, int count, const int* granted) {
        static_cast<Link*>(self)->on_subscribe(count, granted);
    });
    mosquitto_message_callback_set(client_, [](mosquitto*, void* self, const mosquitto_message* received) {
        static_cast<Link*>(self)->on_message(*received);
    });
    const auto run = [](void* self) -> void* {
        static_cast<Link*>(self)->serve();
        return nullptr;
    };
    served_ = pthread_create(&thread_, nullptr, run, this) == 0;
    return served_;
}

// The client's thread: the library's own does not try again where the first attempt fails.
void Link::serve() {
    while (!leaving_) {
        if (mosquitto_connect(client_, options_.host, options_.port, kKeepaliveS) != MOSQ_ERR_SUCCESS) {
            say_once("is not there");
        }
        while (mosquitto_loop(client_, kLookMs, 1) == MOSQ_ERR_SUCCESS) {
        }
        for (int waited_ms = 0; !leaving_ && waited_ms < kRetryMs; waited_ms += 10) {
            usleep(10000);
        }
    }
}

bool Link::take(Heard* heard) {
    char drained[64];
    while (read(wake_[0], drained, sizeof drained) > 0) {
    }
    return heard_.take(heard);
}

int Link::present(const char* there) {
    int number = 0;
    const int trouble = mosquitto_publish(client_, &number, presence_, 1, there, 1, true);
    return trouble == MOSQ_ERR_SUCCESS ? number : 0;
}

void Link::tell(const profile::Outgoing& said) {
    char payload[kMessageBytes];
    const size_t size = profile::write(said, payload, sizeof payload);
    if (size > 0) {
        mosquitto_publish(client_, nullptr, telemetry_, static_cast<int>(size), payload, 0, false);
    }
}

void Link::on_connect(int refusal) {
    if (refusal != 0) {
        say_once(mosquitto_connack_string(refusal));
        return;
    }
    char* topics[profile::kTopics];
    for (int channel = 0; channel < profile::kTopics; ++channel) {
        topics[channel] = topics_[channel];
    }
    mosquitto_subscribe_multiple(client_, nullptr, profile::kTopics, topics, 1, 0, nullptr);
}

void Link::on_subscribe(int count, const int* granted) {
    for (int channel = 0; channel < count; ++channel) {
        if (granted[channel] > 1) {
            say_once("does not let this board hear its commands");
            return;
        }
    }
    say_once("is there");
    put({Heard::What::kUp, profile::Incoming()});
}

void Link::on_message(const mosquitto_message& received) {
    for (uint8_t channel = 0; channel < profile::kTopics; ++channel) {
        if (strcmp(topics_[channel], received.topic) == 0) {
            const auto* bytes = static_cast<const uint8_t*>(received.payload);
            const auto size = static_cast<size_t>(received.payloadlen);
            put({Heard::What::kMessage, profile::read(channel, bytes, size, received.retain)});
        }
    }
}

void Link::put(const Heard& heard) {
    if (!heard_.put(heard)) {
        fprintf(stderr, "board: a message came while 64 others waited; it is lost\n");
    }
    const ssize_t woken = write(wake_[1], "!", 1);
    static_cast<void>(woken);  // a full pipe wakes as well
}

// One line when something changes, not one per attempt.
void Link::say_once(const char* trouble) {
    if (trouble != trouble_) {
        fprintf(stderr, "board: the MQTT broker at %s:%d %s\n", options_.host, options_.port, trouble);
        trouble_ = trouble;
    }
}

}  // namespace arboleda
