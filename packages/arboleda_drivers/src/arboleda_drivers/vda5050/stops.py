"""Stops of a vehicle, sent until they have ended: a message may be lost, or a vehicle deaf for a while."""

from __future__ import annotations

import math
from collections.abc import Sequence

from arboleda.drivers import StopMode

from .orders import Action
from .state import VehicleState

AGAIN_S = 2.0  # after this time an unanswered stop or request is sent again
PAUSES = 3  # requests, where a vehicle has ended a pause and says that it is not paused
TYPES = {
    StopMode.HALT: ("cancelOrder",),
    StopMode.LATCH: ("startPause", "cancelOrder"),
    StopMode.CLEAR: ("stopPause",),
}
OPPOSITE = {"startPause": "stopPause", "stopPause": "startPause"}


class Stops:
    """Stops that have not ended: `open` has their types, each with all its actions."""

    def __init__(self) -> None:
        self._pauses_left = 0  # so often it is told again to pause, where it has said that it did and has not
        self.forget()

    def forget(self) -> None:
        self.open: dict[str, list[str]] = {}
        self._at = -math.inf  # time of the last stop

    def types(self, mode: StopMode) -> tuple[str, ...]:
        """The types of the actions of a stop that is commanded."""
        if mode is not StopMode.HALT:  # a halt takes nothing back of a latching stop
            self._pauses_left = PAUSES if mode is StopMode.LATCH else 0
        return TYPES[mode]

    def sent(self, now: float, actions: Sequence[Action]) -> None:
        self._at = now
        for action in actions:
            self.open.pop(OPPOSITE.get(action.type, ""), None)
            self.open.setdefault(action.type, []).append(action.id)

    def see(self, state: VehicleState) -> None:
        self.open = {type: ids for type, ids in self.open.items() if not _is_over(state, ids)}

    def are_due(self, now: float) -> bool:
        """True where the last one was sent long enough ago."""
        return now - self._at >= AGAIN_S

    def again(self, state: VehicleState | None) -> tuple[str, ...]:
        """The types of the actions that are to be sent again."""
        if self.open:
            return tuple(self.open)
        if not self._pauses_left or state is None or state.paused:
            self._pauses_left = 0
            return ()
        self._pauses_left -= 1
        return ("startPause",)


def _is_over(state: VehicleState, ids: Sequence[str]) -> bool:
    """True if a stop that was sent as these actions has ended, or was refused and none of them is under way.

    Some vehicles refuse an action by an error alone, also a second cancel beside one under way.
    """
    if any(map(state.is_over, ids)):
        return True
    is_under_way = any(id in state.actions for id in ids)
    return not is_under_way and any(state.trouble_with(id) is not None for id in ids)
