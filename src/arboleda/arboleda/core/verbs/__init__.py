"""Verbs of the operators: what each of them does, and when it is refused."""
