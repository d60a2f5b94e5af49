"""Benchmarks: each compares Arboleda with a floor that is measured in the same run."""
