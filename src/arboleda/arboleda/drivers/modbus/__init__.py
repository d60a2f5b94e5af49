"""Devices behind Modbus, without a socket: where their values are, what is written and read, what it says."""
