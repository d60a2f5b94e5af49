"""Exercises with a judge: what is to be done, what was handed in, and whether that does it."""
