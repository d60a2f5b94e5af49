"""Collection of Python's garbage between the steps of a plant, and not in the middle of one."""

from __future__ import annotations

import gc
import math

from arboleda.adapters import clock
from arboleda.engine import Plant

YOUNG = 10_000  # objects more than before at which they are looked at, for some milliseconds
MOST_YOUNG = 50_000  # objects at which Python collects by itself, as where the plant's thread hangs
SHARE = 0.001  # of the time for collections of everything, at most: one of a large plant takes 0.1 s


def leave_out_more() -> None:
    """Leave out what was loaded later, too, in a process that leaves anything out."""
    if gc.get_freeze_count():
        gc.freeze()


class Garbage:
    """Garbage: collects once a step is over and its commands have left.

    What ends is given back without it, trees of tasks as well; left are pages and what exceptions refer to.
    So it collects seldom: no thread of Python runs meanwhile, not even for a stop. `start` leaves out for
    good what is there by then, which is hardly any garbage: a collection of everything would look at every
    library again.
    """

    def __init__(self) -> None:
        self._often = gc.get_threshold()
        self._all_from = -math.inf
        self._runs = False

    def start(self, *, has_steps: bool) -> None:
        """Begin; without steps Python collects as ever."""
        if gc.get_freeze_count():  # whoever runs this process has seen to it
            return
        gc.freeze()
        if has_steps:
            gc.set_threshold(MOST_YOUNG, *self._often[1:])
        self._runs = True

    def stop(self) -> None:
        if self._runs:
            self._runs = False
            gc.set_threshold(*self._often)
            gc.unfreeze()

    def stepped(self, _plant: Plant) -> None:
        """Collect what is due."""
        if not self._runs:
            return
        most = (YOUNG, *self._often[1:])
        young, middle, old = (count > limit for count, limit in zip(gc.get_count(), most, strict=True))
        if old and clock.seconds() >= self._all_from:
            self._collect_all()
        elif middle:
            gc.collect(1)
        elif young:
            gc.collect(0)

    def _collect_all(self) -> None:
        began = clock.seconds()
        gc.collect()
        ended = clock.seconds()
        self._all_from = ended + (ended - began) / SHARE
