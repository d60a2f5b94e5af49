"""The page's sections on changing a plant: make, draw, teach, and versions of its files."""
