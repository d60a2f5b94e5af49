"""Many plants on one page: where they are, what they say, and what is asked of them."""
