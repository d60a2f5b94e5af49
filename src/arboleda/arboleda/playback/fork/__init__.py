"""A record that goes on otherwise: from a time on, with virtual devices, and with what somebody changed."""
