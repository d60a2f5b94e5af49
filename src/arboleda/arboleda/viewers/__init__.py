"""What viewers that others made are shown: their messages and files. Pure: no clock, socket or thread."""
