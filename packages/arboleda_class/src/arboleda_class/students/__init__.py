"""Students of a class: a plant for each, with the tokens that let teacher and student in."""
