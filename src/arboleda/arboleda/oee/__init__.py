"""OEE of cells: its figures, and the rows of a plant's memory that they are made of."""
