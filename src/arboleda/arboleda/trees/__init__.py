"""Behavior trees: leaves, what recipes are made of, and what is kept of a tree that runs; pure."""
