"""Mends: edits of a plant's files after which it was tried, and found better."""
