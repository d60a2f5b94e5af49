"""A plant in a notebook: a world that is stepped by hand, and what a notebook draws of it in place."""

from .drawn import Drawing
from .world import World

__all__ = ["Drawing", "World"]
