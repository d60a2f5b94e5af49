"""What a plant consists of, and what crosses the border of its engine: data without behaviour of its own."""
