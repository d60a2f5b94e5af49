"""Runs the contract against the board of an arm or a declared device: a pure judge, and its way over MQTT."""
