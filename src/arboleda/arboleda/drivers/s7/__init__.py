"""Devices behind a Siemens S7, without a socket: absolute addresses, what is written, and reports."""
