"""Departures: when messages may leave a plant, who of two may send them, and stops past all else; pure."""
