"""A mobile robot that speaks VDA 5050."""
