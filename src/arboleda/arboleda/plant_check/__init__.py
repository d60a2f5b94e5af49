"""Check of a plant beyond its reading: what its recipes lead to, mistakes of its layout, unstated rules."""
