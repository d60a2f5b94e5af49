"""Steps of a tree that ask for the parts at a place, or wait for them."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from arboleda.drivers import Value
from arboleda.engine import Context, Places, Require
from arboleda.model.messages import Failure, Reason
from arboleda.recipes import Phrase, Step
from arboleda.recipes.place_questions import HAS_PART, HAS_ROOM, PlaceHandle
from arboleda_trees.bt_xml import leaves

NO_PART = Phrase("xml.no_part", "no part is at {place}")
NO_ROOM = Phrase("xml.no_room", "{place} has no room for another part")
CHECKS: Mapping[str, tuple[Phrase, Callable[[Places, str], bool], Phrase]] = {
    leaves.HAS_PART: (HAS_PART, Places.is_filled, NO_PART),
    leaves.HAS_ROOM: (HAS_ROOM, Places.is_free, NO_ROOM),
}
WAITS: Mapping[str, Callable[..., Step]] = {
    leaves.GETS_PART: PlaceHandle.gets_part,
    leaves.GETS_ROOM: PlaceHandle.gets_room,
}


def step(context: Context, kind: str, values: Mapping[str, Value]) -> Step:
    """The step of a kind of node with these values."""
    place = str(values["place"])
    if kind in WAITS:
        return WAITS[kind](PlaceHandle(place, context), at_most_s=values["at_most_s"])
    return _check(context, place, *CHECKS[kind])


def _check(
    context: Context, place: str, title: Phrase, is_so: Callable[[Places, str], bool], otherwise: Phrase
) -> Step:
    failure = Failure(reason=Reason.PRECONDITION, sentence=otherwise(place=place))

    def obstacle() -> Failure | None:
        return None if is_so(context.places, place) else failure

    return Require(title(place=place), context.failures, obstacle)
