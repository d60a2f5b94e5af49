"""Kills a whole plant with -9 at random instants, over the real chain, and counts what came of its tasks."""
