"""Runs the contract against any arm's board: a pure judge, and its way over MQTT."""
