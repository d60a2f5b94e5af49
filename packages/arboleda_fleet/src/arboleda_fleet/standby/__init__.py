"""Two hosts for one plant: one process leads, another waits to; nobody else needs what is here."""
