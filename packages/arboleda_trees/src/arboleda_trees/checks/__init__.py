"""Checks of the nodes of trees as XML."""
