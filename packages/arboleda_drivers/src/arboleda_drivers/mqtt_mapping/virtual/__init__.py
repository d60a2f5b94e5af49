"""The virtual device of a mapping: it takes what the plant sends, and says what the plant hears."""
