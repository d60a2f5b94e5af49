"""HTTP and websockets of a running plant: its API, who may use it, and the server under both."""
