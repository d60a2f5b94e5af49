"""Memory of a plant: SQLite in a file, or PostgreSQL, behind one port."""
