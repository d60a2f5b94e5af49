"""Rigs for drivers: a plant with one driver under the faults of its virtual controller, seed by seed."""
