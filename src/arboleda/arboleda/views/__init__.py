"""What screens, clients and pictures see of a plant, as plain data; pure, and read only."""
