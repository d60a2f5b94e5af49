"""What a device of a record told, and its virtual one cannot tell as long as nothing goes wrong with it."""
