"""Reports of a device in a record that its virtual one cannot make as long as nothing goes wrong with it."""
