"""Views of several cells and plants: the OEE of cells, and the page on many plants."""
