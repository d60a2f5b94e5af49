"""Faults of a device of a declared kind: it does not do, or does not report, as it should."""

from __future__ import annotations

from typing import Any

from arboleda.drivers import FactType, Value
from arboleda.model.plant_model import PlantModel
from arboleda.rig.world import World

from ..chance import Dice
from ..deceptions import begin_to_deceive
from . import targets
from .board_site import BoardSite
from .false_telemetry import Fields, deceive
from .kind import End, Fault, all_alike, board_kind, kind, words
from .shared_effects import hold

FOR_EVER_S = 86_400.0


@board_kind(
    targets=targets.machines,
    words=words("atasco", "sin_aire"),
    seconds=(1.0, 60.0),
    alike=all_alike,
    takes_any_word=True,
)
def gives_up(world: BoardSite, fault: Fault) -> End:
    """A device ends every order that it has carried out as failed, with this word."""
    return _behave(world, fault, "fails", lambda goal: fault.word)


@board_kind(targets=targets.machines, words=words("ocupado", "condicion"), seconds=(1.0, 30.0))
def refuses(world: BoardSite, fault: Fault) -> End:
    """A device takes no order, and says so with this word."""
    return _behave(world, fault, "refuses", lambda goal: fault.word)


@board_kind(targets=targets.machines, seconds=(1.0, 60.0))
def never_ends(world: BoardSite, fault: Fault) -> End:
    """A device goes on and on with whatever it begins, and answers nothing, until this is over."""
    return _be_late(world, fault, FOR_EVER_S)


@board_kind(targets=targets.machines, seconds=(1.0, 60.0), amount=(0.1, 60.0))
def ends_late(world: BoardSite, fault: Fault) -> End:
    """A device takes `amount` s longer for whatever it begins, and for its answers."""
    return _be_late(world, fault, fault.amount)


@kind(targets=targets.machines, seconds=(1.0, 30.0))
def only_says_done(world: World, fault: Fault) -> End:
    """A device says that it has done what it was told, and does nothing."""
    truth = begin_to_deceive(world, fault.target, ("done",))
    end = _behave(world, fault, "does", lambda goal: False)

    def stop() -> None:
        end()
        truth()

    return stop


@board_kind(targets=targets.askable, seconds=(1.0, 60.0), amount=(0.05, 10.0))
def answers_twice(world: BoardSite, fault: Fault) -> End:
    """A device answers every question once more after `amount` s, and perhaps otherwise."""
    return _behave(world, fault, "repeats", lambda goal: fault.amount)


@board_kind(targets=targets.machines)
def forgets(world: BoardSite, fault: Fault) -> None:
    """A device boots, and what was switched is as it was in the beginning."""
    if world.is_on(fault.target):
        world.power_off(fault.target)
        targets.machine_body(world, fault.target).forget_settings()
        world.power_on(fault.target)


@board_kind(targets=targets.holders)
def opened_device(world: BoardSite, fault: Fault) -> None:
    """Somebody takes out what a device holds, and it says so."""
    held = targets.robot_of(world.model, fault.target).held_fact
    if held is not None and world.is_on(fault.target):
        world.manual.set_facts(fault.target, ((held, False),))


def _facts_of(model: PlantModel, target: str) -> tuple[str, ...]:
    return tuple(targets.robot_of(model, target).fact_names)


@kind(targets=targets.tellers, words=_facts_of, seconds=(0.5, 15.0))
def stale_fact(world: World, fault: Fault) -> End:
    """A device says of a fact what was so when this began, whatever becomes of it."""
    kept = targets.machine_body(world, fault.target).facts[fault.word]
    return _lie(world, fault, kept)


@kind(targets=targets.tellers, words=_facts_of, seconds=(0.3, 10.0))
def lying_fact(world: World, fault: Fault) -> End:
    """A device says of a fact what is not so."""
    body = targets.machine_body(world, fault.target)
    other = _another(body.kind.facts[fault.word], body.facts[fault.word], Dice(fault.seed, "fact"))
    return _lie(world, fault, other)


def _another(type: FactType, now: Value, dice: Dice) -> Value:
    """Another value that a fact can have; of one within limits now and then one beyond them."""
    if type.words:
        others = [word for word in type.words if word != now]
        return dice.pick(others or list(type.words))
    if isinstance(now, bool):
        return not now
    if type.is_limited and dice.chance(0.5):
        return type.type(type.upper + 1)
    return f"{now}?" if isinstance(now, str) else now + 1


def _lie(world: World, fault: Fault, value: Value) -> End:
    def lie(fields: Fields) -> Fields:
        data = fields.get("datos") or {}
        return {**fields, "datos": {**data, fault.word: value}} if fault.word in data else fields

    return deceive(world, fault.target, ("facts",), lie)


def _behave(world: BoardSite, fault: Fault, how: str, does: Any) -> End:
    """Have a device behave so; several faults add up, until the last of them ends."""
    body = targets.machine_body(world, fault.target)
    usual = getattr(type(body)(body.kind), how)
    setattr(body, how, does)
    return hold(world, how, fault.target, lambda: setattr(body, how, usual))


def _be_late(world: BoardSite, fault: Fault, late_s: float) -> End:
    body = targets.machine_body(world, fault.target)
    end = _behave(world, fault, "lasts", lambda goal: late_s)

    def stop() -> None:
        end()
        if not world.holds["lasts", fault.target]:
            body.catch_up(round(world.now * 1e6))
            world.wake(fault.target)

    return stop


KINDS = (
    gives_up,
    refuses,
    never_ends,
    ends_late,
    only_says_done,
    answers_twice,
    forgets,
    opened_device,
    stale_fact,
    lying_fact,
)
