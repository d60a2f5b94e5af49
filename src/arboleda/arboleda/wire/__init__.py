"""MQTT contract without sockets: topics, payloads, units, and the state machine of the bridge."""
