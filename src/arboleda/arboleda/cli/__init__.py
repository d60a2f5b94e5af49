"""The command line: one file for each command, and the terminal side of a running plant."""
