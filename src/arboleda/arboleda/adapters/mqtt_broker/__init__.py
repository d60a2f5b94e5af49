"""The plant's own MQTT broker: packets, who may do what, limits, and the clients of one event loop."""
