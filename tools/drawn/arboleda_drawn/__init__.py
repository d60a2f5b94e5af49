"""Plants drawn from seeds, odd values included, and simulated as those of people are."""
