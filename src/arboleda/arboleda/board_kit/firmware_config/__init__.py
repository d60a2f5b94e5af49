"""What the firmware's board has to know of a declared device and of its wiring, as a header of C++."""
