"""Invariants of grips and of places of parts, by what effectors truly did."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from arboleda.model.messages import Check
from arboleda.model.plant_model import Evidence

from ..invariants.invariant import Look, Trigger, invariant
from ..truth.arm import ArmTruth
from .deeds import CellTruth, EndedTask, Switch, named
from .parts import FELL, FLOOR, GRIPPED, OUTDATED, POWER, RELEASED


@invariant(Trigger.DEEDS)
def effector_on_only_between_pick_and_place(look: Look) -> Iterable[str]:
    """An effector goes on only at the pick-up of a running task that has not placed its part, and is off
    when a task begins and when one is done; in between a plant that failed keeps its grip.
    """
    return _grips(look)


@invariant(Trigger.CHANGED)
def effector_off_only_where_legal(look: Look) -> Iterable[str]:
    """An effector is opened only at a pick-up, where the cell's part belongs, or by an operator."""
    return _opened(look)


@invariant(Trigger.PASSED)
def no_part_dropped(look: Look) -> Iterator[str]:
    """A part ends on the floor only by a fault that takes it, with the power, or by an operator's release."""
    world = look.world
    for passage in look.truth.storage.parts.passages:
        taken = passage.cause == FELL and (world.faults_active > 0 or world.last_fault_at == world.now)
        excused = taken or passage.cause in (POWER, RELEASED, OUTDATED)
        arm = look.truth.storage.arms[passage.arm]
        if passage.place == FLOOR and not (excused or arm.taken_away or look.truth.unseen(arm)):
            yield f"{passage.arm} drops part {passage.part.number} ({passage.cause})"


@invariant(Trigger.CHANGED)
def parts_conserved(look: Look) -> Iterator[str]:
    """An effector holds a part only where one lay and it was on; an effector that is off holds none."""
    for passage in look.truth.storage.parts.passages:
        if passage.cause == GRIPPED and not passage.lay_there:
            yield f"{passage.arm} holds a part where none lay"
    for robot in look.truth.changed:
        if isinstance(robot, ArmTruth) and robot.holding and not robot.on:
            yield f"{robot.robot.name} holds a part with its effector off"


@invariant(Trigger.PASSED)
def station_gets_one_part(look: Look) -> Iterator[str]:
    """No part is put into a station that has one; the customer takes it when its task has ended."""
    for (cell, station), parts in look.truth.storage.parts.stations.items():
        if len(parts) > 1:
            yield f"{station} of {cell} holds {len(parts)} parts"


@invariant(Trigger.DEEDS)
def one_pick_one_place(look: Look) -> Iterable[str]:
    """At most one part leaves the pick-up for a task, and at most one comes to its place."""
    return _repeated(look)


@invariant(Trigger.DEEDS)
def one_pick_one_place_over_all_starts(look: Look) -> Iterator[str]:
    """Over all starts at most one part leaves the pick-up for a task, and at most one comes to its place."""
    for each in look.truth.storage.cells.values():
        if each.task is None or each.blind or each.earlier == (0, 0):
            continue
        picks, places = each.earlier[0] + each.picks, each.earlier[1] + each.places
        if picks > 1 or places > 1:
            yield f"task {each.task} has {picks} picks and {places} places over all starts"


@invariant(Trigger.ENDED)
def done_task_is_true(look: Look) -> Iterable[str]:
    """Of a task that is called done the effector gripped at the pick-up and opened at its place, and arm and
    mobile got to where they end.
    """
    return _not_done(look)


@invariant(Trigger.ENDED)
def robbed_task_is_not_done(look: Look) -> Iterator[str]:
    """A task is not called done whose effector somebody else opened on the way, if its board says so."""
    for ended in look.truth.storage.ended:
        if ended.done and ended.robbed and not _untold(look, ended.cell.arm, ended.began_at):
            yield f"{ended.task} ({ended.text}) is called done, but its part was taken from the effector"


@invariant(Trigger.ENDED)
def done_task_has_its_part(look: Look) -> Iterator[str]:
    """A task is not called done whose arm came without a part to where that belongs, if its board had said so
    and it does not say that nobody checked.
    """
    for ended in look.truth.storage.ended:
        arm = ended.cell.arm
        if not (ended.done and ended.empty_handed) or Check.GRIP in ended.unchecked or arm is None:
            continue
        if not (ended.blind or look.truth.deceived_since(arm.robot.mqtt, "piece", ended.began_at)):
            yield f"{ended.task} ({ended.text}) is called done, and its arm brought no part"


@invariant(Trigger.ENDED)
def unchecked_is_as_said(look: Look) -> Iterator[str]:
    """A done task says that its grip is unchecked exactly where no piece sensor speaks, or nobody is to ask
    it, and its release where the board says nothing of its effector, or has booted.
    """
    for ended in look.truth.storage.ended:
        if not ended.done or ended.cell.arm is None:
            continue
        silent = ended.cell.arm.robot.evidence is not Evidence.IDS
        booted = ended.cell.arm.booted_us / 1e6 >= ended.began_at
        if (Check.GRIP in ended.unchecked) is not (silent or ended.cell.cell.cell.piece_check is False):
            yield f"{ended.task} is done, and its grip is {_checked(ended, Check.GRIP)}"
        if (Check.RELEASE in ended.unchecked) is not silent and not booted:
            yield f"{ended.task} is done, and its release is {_checked(ended, Check.RELEASE)}"


def _checked(ended: EndedTask, check: Check) -> str:
    return "not checked" if check in ended.unchecked else "checked"


def _grips(look: Look) -> Iterator[str]:
    truth = look.truth
    for name in truth.storage.stray_grips:
        yield f"{name} is told to grip while no task of its cell runs"
    for switch in _switches(look):
        excused = switch.outdated or switch.taken_away or truth.unseen(truth.storage.arms[switch.arm])
        if not switch.on or excused:
            continue
        if why := _grips_wrongly(truth.storage.cells[switch.cell], switch):
            yield f"{switch.arm} grips at {named(switch.poses)}: {why}"
    for cell in truth.storage.begun:
        if cell.arm is not None and cell.arm.on and not _untold(look, cell.arm, look.world.now):
            yield f"{cell.task} begins, and the effector of its arm is on"
    for ended in truth.storage.ended:
        if ended.done and ended.grips and not _untold(look, ended.cell.arm, ended.began_at):
            yield f"{ended.task} is done, and the effector of its arm is on"


def _opened(look: Look) -> Iterator[str]:
    for switch in _switches(look):
        excused = (
            switch.lost_power
            or switch.by_others
            or switch.outdated
            or switch.released
            or switch.taken_away
            or look.truth.unseen(look.truth.storage.arms[switch.arm])
        )
        if not switch.on and not switch.legal and not excused:
            yield f"the effector of {switch.arm} is opened at {named(switch.poses)}"


def _repeated(look: Look) -> Iterator[str]:
    storage = look.truth.storage
    known: tuple[CellTruth | EndedTask, ...] = (*storage.cells.values(), *storage.ended)
    for each in known:
        if not each.blind and (each.picks > 1 or each.places > 1):
            yield f"task {each.task} has {each.picks} picks and {each.places} places"


def _not_done(look: Look) -> Iterator[str]:
    for ended in look.truth.storage.ended:
        if ended.missing is None or ended.unprovable:
            continue
        if not _untold(look, ended.cell.arm, ended.began_at):
            yield f"{ended.task} ({ended.text}) is called done, but {ended.missing}"


def _switches(look: Look) -> list[Switch]:
    """The effectors that changed in this step."""
    return [cell.switch for cell in look.truth.storage.cells.values() if cell.switch is not None]


def _grips_wrongly(cell: CellTruth, switch: Switch) -> str | None:
    """The reason why the effector must not be on there; a command of a stopped task may still arrive."""
    if cell.order is None:
        return "no task asked for that"
    if not switch.legal:
        return "no part is gripped there"
    return "its task has put its part down" if cell.let_go and not cell.blind else None


def _untold(look: Look, arm: ArmTruth | None, since: float) -> bool:
    """True if nobody can tell what an effector did: its board lied or says nothing of it."""
    if arm is None:
        return True
    unproven = arm.robot.evidence is not Evidence.IDS
    return unproven or look.truth.deceived_since(arm.robot.mqtt, "effector", since)


GRIP = (
    effector_on_only_between_pick_and_place,
    effector_off_only_where_legal,
    no_part_dropped,
    parts_conserved,
    station_gets_one_part,
    one_pick_one_place,
    done_task_is_true,
    robbed_task_is_not_done,
    done_task_has_its_part,
    unchecked_is_as_said,
)
OVER_ALL_STARTS = (one_pick_one_place_over_all_starts,)
