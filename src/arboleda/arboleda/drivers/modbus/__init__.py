"""Devices behind Modbus, without a socket: addresses of values, requests, and reports."""
