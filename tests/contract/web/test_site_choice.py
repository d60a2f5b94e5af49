"""A task that names cells of several plants goes to the one that is expected to have done it first."""

from __future__ import annotations

from collections.abc import Awaitable, Callable

import pytest

from arboleda.dashboard.site.side import RequestOutcome
from arboleda.runtime.endpoints import Place
from arboleda.site.watch import Site

from .conftest import QUEUED, Plant, running
from .test_site import called, deaf, heard, seen, watched

BOTH = "north/sis_a,south/sis_b,south/sis_a 0b 7"


def ask(text: str, *names: str) -> Callable[[Site], Awaitable[RequestOutcome]]:
    async def act(site: Site) -> RequestOutcome:
        await seen(site, lambda plants: heard(plants) == list(names))
        return await site.submit("", text)

    return act


def two() -> tuple[Plant, Plant]:
    """The second is to be done first."""
    north, south = called("north"), called("south")
    north.seconds, south.seconds = 50.0, 20.0
    return north, south


def test_it_is_given_to_the_plant_that_promises_to_be_first_with_the_reason() -> None:
    north, south = two()
    with running(north) as one, running(south) as other:
        places = [Place(url=one.origin), Place(url=other.origin)]
        answer = watched(places, ask(BOTH, "north", "south"))
    assert (north.texts, south.texts) == ([], ["sis_b 0B 7"])
    why = "south/sis_b is expected to have done it first, in 20 s; north/sis_a in 50 s, south/sis_a in 20 s"
    assert south.choices == [why]
    assert answer.good and str(answer.sentence) == f"south has taken sis_a 0b 7 (#t-1); {why}"


def test_a_plant_that_does_not_answer_is_left_out_and_said_to_be() -> None:
    north, _ = two()
    with deaf() as silent, running(north) as one:
        places = [Place(url=one.origin), Place(url=silent, plant="south")]
        answer = watched(places, ask("south/sis_a,north/sis_a 0b 7", "north"))
    assert answer.good and north.texts == ["sis_a 0B 7"]
    assert "south" in north.choices[0] and "north/sis_a is expected" in north.choices[0]


def test_with_an_id_it_is_given_to_nobody_while_a_plant_does_not_answer() -> None:
    north, _ = two()
    with deaf() as silent, running(north) as one:
        places = [Place(url=one.origin), Place(url=silent, plant="south")]
        answer = watched(places, ask("south/sis_a,north/sis_a 0b 7 #lot1", "north"))
    assert not answer.good and north.texts == []
    assert "may have #lot1 already" in str(answer.sentence)


def test_a_task_that_a_plant_has_already_stays_there() -> None:
    north, south = two()
    known, south.find = QUEUED, lambda task: None  # type: ignore[method-assign]
    north.find = lambda task: known if task == "lot1" else None  # type: ignore[method-assign]
    with running(north) as one, running(south) as other:
        places = [Place(url=one.origin), Place(url=other.origin)]
        answer = watched(places, ask(f"{BOTH} #lot1", "north", "south"))
    assert answer.good and (north.texts, south.texts) == (["sis_a 0b 7 #lot1"], [])


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("north/sis_a,sis_b 0b 7", "write plant/cell,plant/cell and the task"),
        ("north/sis_a,west/sis_b 0b 7", "there is no plant west on this page"),
        ("north/sis_a,south/sis_z 0b 7", "south ('sis_z' is not a cell of this plant"),
    ],
)
def test_a_text_with_a_mistake_is_given_to_nobody(text: str, why: str) -> None:
    north, south = two()
    with running(north) as one, running(south) as other:
        places = [Place(url=one.origin), Place(url=other.origin)]
        answer = watched(places, ask(text, "north", "south"))
    assert not answer.good and why in str(answer.sentence)
    assert north.texts == south.texts == []
