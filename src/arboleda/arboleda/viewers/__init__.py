"""Messages and files for viewers made by others. Pure: no clock, socket or thread."""
