"""Forks of a record: from a time on, the plant goes on with virtual devices, and with a person's changes."""
