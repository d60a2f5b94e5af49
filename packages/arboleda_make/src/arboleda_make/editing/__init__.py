"""Edits of a file of trees, which leave all else as it was, and what an editor shows of it."""
