"""Behavior trees: leaves, what recipes are made of, and how a tree runs; pure."""
