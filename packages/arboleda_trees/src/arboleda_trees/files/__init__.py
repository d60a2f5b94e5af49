"""Files of trees: those that a plant uses, and those that a person names."""
