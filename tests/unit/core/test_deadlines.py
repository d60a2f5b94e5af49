"""The next deadline of a plant: worked out when somebody asks for it, and equal where nobody asks."""

from __future__ import annotations

from typing import Any

from arboleda.testing import shipped
from arboleda_bench.obedient import Yard, command_in, is_over
from arboleda_bench.step import begin_task, go_on


def played(yard: Yard, *, asks: bool) -> tuple[list[Any], list[float]]:
    """All that a plant sends for one task, and its deadlines where it is asked for them."""
    out = begin_task(yard)
    sent, deadlines = [*out], list[float]()
    while not is_over(out):
        out = go_on(yard, command_in(out))
        sent += out
        if asks:
            deadlines.append(yard.plant.next_deadline)
    return sent, [*deadlines, yard.plant.next_deadline]


def test_a_plant_that_is_not_asked_for_its_deadline_does_the_same() -> None:
    asked, unasked = (played(Yard(shipped("sis_a")), asks=asks) for asks in (True, False))
    assert asked[0] == unasked[0] and len(asked[0]) > 10
    assert asked[1][-1] == unasked[1][-1]
