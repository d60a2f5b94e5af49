"""The plant's own MQTT broker: packets, permissions, limits, and the clients of one event loop."""
