"""For tests of plants: the whole chain in one process, with time moved by hand."""

from .rig import Rig

__all__ = ["Rig"]
