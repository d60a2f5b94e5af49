"""One I/O library per file; each carries messages and decides nothing."""
