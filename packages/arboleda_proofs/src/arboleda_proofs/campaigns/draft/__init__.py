"""Tries and proofs of a draft for the page, each in a process that a plant starts beside itself."""
