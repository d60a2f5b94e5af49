"""What packages may do with a plant that runs."""
