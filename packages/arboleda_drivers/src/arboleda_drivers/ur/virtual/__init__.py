"""A virtual controller of an arm of Universal Robots."""
