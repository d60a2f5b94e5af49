"""A record's inputs as a case of the simulator: the acts of people and the troubles of devices."""
