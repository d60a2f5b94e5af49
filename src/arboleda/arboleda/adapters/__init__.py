"""I/O, one library per file; each file carries messages and decides nothing."""
