// What the port uses of espMqttClient 1.7, for a syntax check only.
#pragma once

#include <functional>
#include <stddef.h>
#include <stdint.h>

namespace espMqttClientTypes {

enum class DisconnectReason : uint8_t {};
enum class SubscribeReturncode : uint8_t {};

struct MessageProperties {
    uint8_t qos;
    bool dup;
    bool retain;
    uint16_t packetId;
};

using OnConnect = std::function<void(bool)>;
using OnDisconnect = std::function<void(DisconnectReason)>;
using OnSubscribe = std::function<void(uint16_t, const SubscribeReturncode*, size_t)>;
using OnMessage =
    std::function<void(const MessageProperties&, const char*, const uint8_t*, size_t, size_t, size_t)>;

}  // namespace espMqttClientTypes

class MqttClient {
public:
    bool connected() const;
    bool disconnected() const;
    bool connect();
    template <typename... More>
    uint16_t subscribe(const char* topic, uint8_t qos, More&&... more);
    uint16_t publish(const char* topic, uint8_t qos, bool retain, const uint8_t* payload, size_t size);
    uint16_t publish(const char* topic, uint8_t qos, bool retain, const char* payload);
};

template <typename Self>
class MqttClientSetup : public MqttClient {
public:
    Self& setKeepAlive(uint16_t seconds);
    Self& setClientId(const char* id);
    Self& setCleanSession(bool clean);
    Self& setCredentials(const char* user, const char* password);
    Self& setWill(const char* topic, uint8_t qos, bool retain, const char* payload);
    Self& setServer(const char* host, uint16_t port);
    Self& onConnect(espMqttClientTypes::OnConnect callback);
    Self& onDisconnect(espMqttClientTypes::OnDisconnect callback);
    Self& onSubscribe(espMqttClientTypes::OnSubscribe callback);
    Self& onMessage(espMqttClientTypes::OnMessage callback);
};

class espMqttClient : public MqttClientSetup<espMqttClient> {
public:
    espMqttClient(uint8_t priority, uint8_t core);
};

class espMqttClientSecure : public MqttClientSetup<espMqttClientSecure> {
public:
    espMqttClientSecure(uint8_t priority, uint8_t core);
    espMqttClientSecure& setCACert(const char* pem);
    espMqttClientSecure& setCertificate(const char* pem);
    espMqttClientSecure& setPrivateKey(const char* pem);
};
