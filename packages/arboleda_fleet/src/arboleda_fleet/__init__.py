"""Several hosts and many plants: standby, PostgreSQL, a page of all plants, OEE, and the OPC UA view."""
