"""Parts of a running plant: faults by hand, the demonstration, reports of failures."""
