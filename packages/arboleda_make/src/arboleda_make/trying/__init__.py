"""Draft as a plant: what the page asks of it is done in processes beside the one that runs."""
