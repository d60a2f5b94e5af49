"""Bytes without sockets: topics, payloads, units at the device edge, and the bridge's state machine."""
