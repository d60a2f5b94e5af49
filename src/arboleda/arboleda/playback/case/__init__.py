"""A record's inputs as a case of the simulator: what people did, and what befell devices."""
