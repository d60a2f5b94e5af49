"""Devices behind a Siemens S7: absolute addresses, what is written, and reports."""
