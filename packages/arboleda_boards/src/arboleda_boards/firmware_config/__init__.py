"""Header of C++ for the firmware's board: a declared device and its wiring."""
