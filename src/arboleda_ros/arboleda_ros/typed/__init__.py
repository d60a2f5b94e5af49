"""What the orchestrator offers where arboleda_interfaces is built; only this package imports it."""
