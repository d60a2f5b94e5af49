"""A virtual controller of a Dobot CR arm, version 4."""
