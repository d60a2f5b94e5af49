"""For tests of plants: the shipped plant, and the whole chain in one process with time moved by hand."""

from .plants import shipped
from .rig import Rig

__all__ = ["Rig", "shipped"]
