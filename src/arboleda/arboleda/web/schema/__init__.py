"""Requests and answers of the API: their models, how they are read and written, and their description."""
