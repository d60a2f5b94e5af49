"""Virtual devices: boards that speak the wire contract and move as time is handed to them."""
