"""Answers of this package's routes, a type each: its client returns them, and they describe the API."""
