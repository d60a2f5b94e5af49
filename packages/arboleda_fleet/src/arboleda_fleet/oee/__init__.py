"""OEE of cells: what is kept for it, the rows of a plant's memory that it is made of, and who tells it."""
