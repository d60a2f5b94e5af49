"""A virtual arm of bus servos, of Feetech's STS series or Dynamixel's X series."""
