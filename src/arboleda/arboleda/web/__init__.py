"""HTTP and websockets of a running plant: its API, access control, and the server under both."""
