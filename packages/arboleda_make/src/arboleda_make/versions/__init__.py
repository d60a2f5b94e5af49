"""Versions of a plant file: what was put to work, and what comes next."""
