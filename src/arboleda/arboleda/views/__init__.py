"""Views of a plant for screens, clients and pictures, as plain data; pure, and read only."""
