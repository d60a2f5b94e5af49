"""Devices behind Modbus: addresses of values, requests, and reports."""
