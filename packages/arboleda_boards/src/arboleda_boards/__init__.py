"""Kit for the boards of devices: the judge of a board (`conformance`) and the header of its firmware."""
