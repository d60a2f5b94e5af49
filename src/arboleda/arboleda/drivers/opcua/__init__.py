"""Devices behind OPC UA, without a socket: nodes of values, method calls, and reports."""
