"""Typed services, actions and topics of the orchestrator; only this package imports arboleda_interfaces."""
