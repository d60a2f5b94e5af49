"""Two hosts of one plant in a simulated world: a leader, a standby, and the store that both reach."""
