"""For tests of plants: the shipped plant, and the whole chain in one process with time moved by hand."""

from . import faults
from .plants import shipped, slowed
from .rig import Rig
from .witness import Witness

__all__ = ["Rig", "Witness", "faults", "shipped", "slowed"]
