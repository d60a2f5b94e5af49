#include "network.h"

#include <WiFi.h>
#include <espMqttClient.h>
#include <freertos/FreeRTOS.h>
#include <freertos/task.h>
#include <stdio.h>
#include <string.h>

#include "board_config.h"

namespace arboleda {

namespace {

constexpr int kCore = 0;
constexpr unsigned kPriority = 5;
constexpr uint32_t kStackBytes = 8192;
constexpr uint16_t kKeepaliveS = 5;
constexpr uint32_t kRetryMs = 1000;
constexpr size_t kTopic = 96;
constexpr uint8_t kBestQos = 2;  // a higher code is a refusal

#ifdef ARBOLEDA_TLS
using Client = espMqttClientSecure;
#else
using Client = espMqttClient;
#endif

class Network {
public:
    Network(const Settings& settings, Exchange* exchange) : settings_(settings), exchange_(*exchange) {}

    void begin();
    void turn();
    bool connected() const { return client_.connected(); }

private:
    void name_topics();
    void on_connect();
    void on_subscribe(const espMqttClientTypes::SubscribeReturncode* codes, size_t count);
    void on_piece(const espMqttClientTypes::MessageProperties& properties, const char* topic,
                  const uint8_t* piece, size_t size, size_t index, size_t total);
    void on_message(const char* topic, bool retained, size_t total);
    void put(Heard::What what) { exchange_.heard.put({what, profile::Incoming()}); }
    void say(const Said& said);

    const Settings settings_;
    Exchange& exchange_;
    Client client_{kPriority, kCore};
    char topics_[profile::kTopics][kTopic] = {};
    char presence_[kTopic] = "";
    char telemetry_[kTopic] = "";
    uint8_t message_[kMessageBytes] = {};  // one that comes in pieces
    uint32_t tried_ms_ = 0;
};

Network* network = nullptr;

void Network::name_topics() {
    for (uint8_t channel = 0; channel < profile::kTopics; ++channel) {
        snprintf(topics_[channel], kTopic, "%s/%s", settings_.robot, profile::topic(channel));
    }
    snprintf(presence_, kTopic, "%s/conexion", settings_.robot);
    snprintf(telemetry_, kTopic, "%s/sensores", settings_.robot);
}

void Network::begin() {
    name_topics();
    WiFi.mode(WIFI_STA);
    WiFi.setSleep(false);
    WiFi.setAutoReconnect(true);
    WiFi.begin(settings_.wifi, settings_.wifi_password);
#ifdef ARBOLEDA_TLS
    client_.setCACert(kBrokerCa);
    if (sizeof kBoardCertificate > 1) {
        client_.setCertificate(kBoardCertificate);
        client_.setPrivateKey(kBoardKey);
    }
#endif
    client_.setServer(settings_.broker, settings_.port);
    client_.setClientId(settings_.robot);
    client_.setKeepAlive(kKeepaliveS);
    client_.setCleanSession(true);  // a session that is kept replays old goals
    client_.setWill(presence_, 1, true, "0");
    if (settings_.user[0] != '\0') {
        client_.setCredentials(settings_.user, settings_.password);
    }
    client_.onConnect([this](bool) { on_connect(); });
    client_.onDisconnect([this](espMqttClientTypes::DisconnectReason) { put(Heard::What::kDown); });
    client_.onSubscribe([this](uint16_t, const espMqttClientTypes::SubscribeReturncode* codes, size_t count) {
        on_subscribe(codes, count);
    });
    client_.onMessage([this](const espMqttClientTypes::MessageProperties& properties, const char* topic,
                             const uint8_t* piece, size_t size, size_t index, size_t total) {
        on_piece(properties, topic, piece, size, index, total);
    });
}

// Says what the board says; connects where it is not.
void Network::turn() {
    Said said;
    while (exchange_.said.take(&said)) {
        say(said);
    }
    if (WiFi.status() == WL_CONNECTED && client_.disconnected() && millis() - tried_ms_ > kRetryMs) {
        tried_ms_ = millis();
        client_.connect();
    }
}

void Network::on_connect() {
#ifdef ARBOLEDA_DEVICE
    client_.subscribe(topics_[0], 1, topics_[1], 1, topics_[2], 1);
#else
    client_.subscribe(topics_[0], 1, topics_[1], 1, topics_[2], 1, topics_[3], 1, topics_[4], 1);
#endif
}

// A board that cannot hear its commands does not say that it is there.
void Network::on_subscribe(const espMqttClientTypes::SubscribeReturncode* codes, size_t count) {
    for (size_t at = 0; at < count; ++at) {
        if (static_cast<uint8_t>(codes[at]) > kBestQos) {
            return;
        }
    }
    put(Heard::What::kUp);
}

void Network::on_piece(const espMqttClientTypes::MessageProperties& properties, const char* topic,
                       const uint8_t* piece, size_t size, size_t index, size_t total) {
    if (total <= kMessageBytes) {
        memcpy(message_ + index, piece, size);
    }
    if (index + size == total) {
        on_message(topic, properties.retain, total);
    }
}

void Network::on_message(const char* topic, bool retained, size_t total) {
    for (uint8_t channel = 0; channel < profile::kTopics; ++channel) {
        if (strcmp(topics_[channel], topic) == 0) {
            // one that is too long was not kept: as an empty one it is refused as well
            const size_t size = total <= kMessageBytes ? total : 0;
            exchange_.heard.put({Heard::What::kMessage, profile::read(channel, message_, size, retained)});
        }
    }
}

void Network::say(const Said& said) {
    if (said.present) {
        client_.publish(presence_, 1, true, "1");
        return;
    }
    char payload[kMessageBytes];
    const size_t size = profile::write(said.telemetry, payload, sizeof payload);
    if (size > 0) {
        client_.publish(telemetry_, 0, false, reinterpret_cast<const uint8_t*>(payload), size);
    }
}

void run(void*) {
    for (;;) {
        network->turn();
        vTaskDelay(2);
    }
}

}  // namespace

void start_network(const Settings& settings, Exchange* exchange) {
    static Network only(settings, exchange);
    network = &only;
    network->begin();
    xTaskCreatePinnedToCore(run, "network", kStackBytes, nullptr, kPriority, nullptr, kCore);
}

bool on_wifi() { return WiFi.status() == WL_CONNECTED; }

bool on_broker() { return network != nullptr && network->connected(); }

}  // namespace arboleda
