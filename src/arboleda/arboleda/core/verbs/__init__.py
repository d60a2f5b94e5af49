"""Verbs of operators: what each verb does, and when it is refused."""
