"""A virtual machine of three axes whose controller runs GRBL 1.1, Marlin or Klipper."""
