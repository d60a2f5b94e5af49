"""Devices behind OPC UA, without a socket: where their values are, what is called, what they say."""
