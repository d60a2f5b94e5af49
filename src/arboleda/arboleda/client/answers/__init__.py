"""Answers of a plant, a type each: the client in Python returns them, and the API is described by them.

Beside the type of a field, in `Annotated`, a string says what the field is, and an enumeration has its words:
the field stays a text, as a newer plant may have more of them.
"""
