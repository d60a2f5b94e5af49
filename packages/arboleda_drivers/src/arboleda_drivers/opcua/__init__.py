"""Devices behind OPC UA: nodes of values, method calls, and reports."""
