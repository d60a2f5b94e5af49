"""Work of the arm, a move or the way to readiness, judged by what servos show."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from arboleda_drivers.connections.receipts import NOTHING, Look

from .servos import Reading

TAKE_S = 0.2  # a servo shows its new goal within this time
SETTLE_S = 0.2  # an arm that stands for so long has come to rest
STALL_S = 1.0  # one that stands for so long away from its goal gets no further
STEP_S = 0.5  # between two tries to switch the torque of a servo on
READY_S = 5.0
TORQUE_OFF = "torque_off"
STANDS_STILL = "stands_still"  # it should move, and tells the same position again and again
NOT_TAKEN = "goal_not_taken"
REST_TICKS = 3  # less than this is no motion


@dataclass(kw_only=True)
class Rest:
    """Positions that stand still, and since when."""

    since: float = -math.inf
    positions: tuple[int, ...] = ()

    def see(self, now: float, positions: tuple[int, ...]) -> float:
        """Take the positions read now; returns how long they have stood, s."""
        pairs = zip(self.positions, positions, strict=False)
        if not self.positions or any(abs(a - b) > REST_TICKS for a, b in pairs):
            self.since, self.positions = now, positions
        return now - self.since


@dataclass(frozen=True, kw_only=True)
class Picture:
    """Readings of all servos of one round; `rest_s` is how long the joints have stood, `names` of servos.

    `stuck`: servos that should have moved, and repeat an old position.
    """

    readings: Mapping[int, Reading]
    names: Mapping[int, str]
    rest_s: float
    stuck: Sequence[int] = ()

    @property
    def trouble(self) -> str | None:
        """The word for what keeps the arm from moving, with the servo; None if nothing does."""
        for id, reading in self.readings.items():
            if reading.alarms:
                return f"{reading.alarms[0]} of {self.names[id]}"
        if self.stuck:
            return f"{STANDS_STILL} of {self.names[self.stuck[0]]}"
        return next(
            (f"{TORQUE_OFF} of {self.names[id]}" for id, each in self.readings.items() if not each.torque),
            None,
        )

    @property
    def since(self) -> float:
        """The time of the oldest reading, s."""
        return min(each.at for each in self.readings.values())

    def other_goal(self, goals: Mapping[int, int]) -> str | None:
        """The name of a servo whose goal is another one."""
        return next((self.names[id] for id, goal in goals.items() if self.readings[id].goal != goal), None)


@dataclass(kw_only=True)
class Move:
    """Move of the joints: taken when every servo shows its goal, over when all have come to rest."""

    id: str
    goals: Mapping[int, int]
    near: Mapping[int, int]  # how far from its goal a servo may stand, ticks
    began_at: float
    taken: bool = False

    def look(self, now: float, picture: Picture) -> Look:
        if picture.since <= self.began_at:
            return NOTHING  # a reading is of before
        trouble, other = picture.trouble, picture.other_goal(self.goals)
        accepted = not self.taken and other is None
        self.taken = self.taken or accepted
        if trouble is not None:
            return Look(accepted=accepted, failed=trouble) if self.taken else Look(refused=trouble)
        if other is not None and self.taken:
            return Look(failed=f"another_goal of {other}")
        if other is not None:
            return Look(refused=f"{NOT_TAKEN} by {other}") if now - self.began_at > TAKE_S else NOTHING
        if accepted:
            return Look(accepted=True)
        # One that stands away from its goal gets no further: the plant finds it there, and the move failed.
        there = all(
            abs(picture.readings[id].position - goal) <= self.near[id] for id, goal in self.goals.items()
        )
        return Look(done=min(picture.rest_s, now - self.began_at) >= (SETTLE_S if there else STALL_S))


@dataclass(kw_only=True)
class Readying:
    """Way to readiness: alarms end, and each servo holds where it is."""

    id: str
    began_at: float
    tried: dict[int, float] = field(default_factory=dict)

    def look(self, now: float, picture: Picture) -> Look:
        if picture.trouble is None:
            return Look(done=True)
        return Look(failed=picture.trouble) if now - self.began_at > READY_S else NOTHING

    def due(self, now: float, picture: Picture) -> list[int]:
        """The servos that are to be made ready now."""
        rows = picture.readings.items()
        unready = [id for id, each in rows if each.alarms or not each.torque or id in picture.stuck]
        found = [id for id in unready if now - self.tried.get(id, -READY_S) >= STEP_S]
        self.tried.update(dict.fromkeys(found, now))
        return found
