"""Effects of mishaps: whether one has something to do now, and what it waits for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from arboleda.rig.world import World
from arboleda_proofs.simulator.faults.targets import arm_body, machine_body, robot_of

from .acts import MishapBegun

DARK, STUCK = "meets_dark", "meets_stuck"
WAITS = {
    "no_part": "waits_grip",
    "no_grip": "waits_grip",
    "stuck_effector": "waits_switch",
    "lost_steps": "waits_homing",
    "jam": "waits_end",
    "busy": "waits_order",
    "slow": "waits_order",
    "never_ends": "waits_order",
    "only_says_done": "waits_order",
}
"""By mishap, the playground's word for what it waits for."""


@dataclass(frozen=True, kw_only=True)
class Effect:
    """Effect of a mishap as it began: a word of the playground, "" where it acts at once. `nothing`: it had
    nothing to do, and never will."""

    word: str
    nothing: bool = False


@dataclass(frozen=True, kw_only=True)
class Provoked:
    """A mishap that has begun `at_s` after the run did, for `seconds`; `name` is that of its target."""

    act: MishapBegun
    name: str
    effect: Effect
    at_s: float
    seconds: float


def effect(world: World, act: MishapBegun) -> Effect:
    """The effect of a mishap that is about to begin."""
    if act.target not in world.boards:
        return Effect(word="")
    if not world.is_on(act.target):
        return Effect(word=DARK, nothing=True)
    idle = NOTHING.get(act.name, _something)(world, act.target)
    return Effect(word=idle, nothing=True) if idle else Effect(word=WAITS.get(act.name, ""))


def _something(world: World, board: str) -> str:
    return ""


def _holds_none(world: World, board: str) -> str:
    return "" if arm_body(world, board).holding else "meets_no_part"


def _is_open(world: World, board: str) -> str:
    body = arm_body(world, board)
    if body.stuck:
        return STUCK
    return "" if body.effector else "meets_open"


def _is_empty(world: World, board: str) -> str:
    held = robot_of(world.model, board).held_fact
    return "" if held is not None and machine_body(world, board).true_facts[held] else "meets_empty"


NOTHING: dict[str, Callable[[World, str], str]] = {
    "lost_part": _holds_none,
    "opened_effector": _is_open,
    "opened_device": _is_empty,
}
"""By mishap, the word for why it has nothing to do now, "" where it has."""
