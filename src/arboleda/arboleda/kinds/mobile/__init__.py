"""Mobile robot: it drives over the nodes of a grid."""

from .commands import FollowPath
from .grid import Grid
from .robot import Mobile

__all__ = ["FollowPath", "Grid", "Mobile"]
