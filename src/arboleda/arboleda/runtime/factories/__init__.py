"""Factories of the runner's own parts; those of packages beside it are found by their entry points."""
