"""The state of a stop (software), as far as the robots themselves have confirmed it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from . import Face
from .moment import Moment

NAMED = 8  # robots named below the button; of more only the number
LATCHED = 4  # MotionState.STOP_LATCHED


@dataclass(frozen=True, kw_only=True)
class StopState:
    """The robots under a stop: those that confirmed it, those that have not yet, those that cannot."""

    confirmed: tuple[str, ...]
    waiting: tuple[str, ...]
    silent: tuple[str, ...]
    free: tuple[str, ...]

    @property
    def state(self) -> str:
        """ready, stopping, stopped, partly (some robots are free), unconfirmed (some are silent)."""
        if self.waiting:
            return "stopping"
        if self.silent:
            return "unconfirmed"
        if not self.confirmed:
            return "ready"
        return "partly" if self.free else "stopped"


def stopped(snapshot: dict[str, Any], no_stop: frozenset[str]) -> StopState:
    """The robots of a stop by state; those of `no_stop` know no latch: standing still confirms theirs."""
    groups: dict[str, list[str]] = {"confirmed": [], "waiting": [], "silent": [], "free": []}
    for robot in snapshot["robots"]:
        groups[_group(robot, no_stop)].append(robot["name"])
    return StopState(**{name: tuple(robots) for name, robots in groups.items()})


def _group(robot: dict[str, Any], no_stop: frozenset[str]) -> str:
    if not robot["latched"]:
        return "free"
    if not robot["online"]:
        return "silent"
    latched = robot["state"] == LATCHED or robot["name"] in no_stop
    return "confirmed" if robot["still"] and latched else "waiting"


def face(moment: Moment) -> Face:
    """The line under the stop button."""
    no_stop = moment.layout["no_stop"]
    found = stopped(moment.snapshot, frozenset(no_stop))
    robots = {
        "stopping": found.waiting,
        "unconfirmed": found.silent,
        "partly": found.confirmed,
    }.get(found.state, ())
    sentence = moment.words(f"stop.{found.state}", robots=_named(moment, robots), count=len(found.confirmed))
    if no_stop:
        beyond = moment.words("stop.beyond", robots=_named(moment, tuple(no_stop)))
        sentence = f"{sentence}. {beyond}"
    return {"text/stop": [sentence, found.state]}


def _named(moment: Moment, robots: tuple[str, ...]) -> str:
    names = ", ".join(robots[:NAMED])
    more = len(robots) - NAMED
    return moment.words("stop.and_more", robots=names, count=more) if more > 0 else names
