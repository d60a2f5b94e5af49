"""Model: the parts of a plant, and the data that cross the border of its engine."""
