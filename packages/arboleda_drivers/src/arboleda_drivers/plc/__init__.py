"""Parts that drivers of PLCs share: numbers that a PLC echoes, and reports made of its values."""
