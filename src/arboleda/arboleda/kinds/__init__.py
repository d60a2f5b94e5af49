"""Kinds of devices beside arms and mobile robots."""
