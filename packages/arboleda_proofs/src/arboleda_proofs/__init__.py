"""Simulator with truth, proofs, replay and forks of records."""
