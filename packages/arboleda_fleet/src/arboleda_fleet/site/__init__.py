"""Many plants on one page: their addresses, their states, and requests to them."""
