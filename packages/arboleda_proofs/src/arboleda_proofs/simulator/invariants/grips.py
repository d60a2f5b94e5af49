"""Invariants of effectors, by what they truly did: where they switch, and what tasks bring with them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from arboleda.drivers import Evidence
from arboleda.engine.inspection import tasks_of
from arboleda.model import text
from arboleda.model.messages import Check
from arboleda.sim.starts import supplies_of
from arboleda.wire.payloads import EffectorGoal

from ..truth.arm import ArmTruth
from ..truth.grips import Effector, Switching
from ..truth.robot import RobotTruth
from .invariant import Look, Trigger, invariant


@invariant(Trigger.DEEDS)
def effector_on_only_for_a_part(look: Look) -> Iterable[str]:
    """An effector goes on only for a task that runs, where a part can be taken, and is off when a task
    begins; in between a plant that failed keeps its grip.
    """
    return _grips(look)


@invariant(Trigger.SWITCHED)
def effector_off_only_where_legal(look: Look) -> Iterator[str]:
    """An effector is opened only where a part can be put, or by an operator."""
    for switching in look.truth.grips.switched:
        excused = (
            switching.lost_power
            or switching.by_others
            or look.truth.released(switching.arm)
            or _is_excused(look, switching)
        )
        if not (switching.on or switching.is_at_place or excused):
            yield f"the effector of {switching.arm} is opened at {switching.where}"


@invariant(Trigger.CHANGED)
def parts_conserved(look: Look) -> Iterator[str]:
    """An effector holds a part only where one lay and while it is on; one that stays on loses it only by a
    fault.
    """
    world = look.world
    for arm in look.truth.changed:
        if not isinstance(arm, ArmTruth) or arm.holding == arm.was_holding == arm.on:
            continue
        name = arm.robot.name
        if arm.holding and not arm.on:
            yield f"{name} holds a part with its effector off"
        elif arm.holding and not arm.was_holding and not _lies_ready(arm):
            yield f"{name} holds a part where none lay"
        calm = not world.faults_active and world.last_fault_at < world.now
        is_lost = arm.was_holding and not arm.holding and arm.on and calm and not arm.taken_away
        if is_lost and not _was_let_go(arm):
            yield f"{name} loses its part with its effector on"


@invariant(Trigger.DONE_TASKS)
def done_tasks_bring_their_parts(look: Look) -> Iterator[str]:
    """A task is not called done whose arm was told to let go of a part that it had not brought, if its board
    had said so: that there is none, or that somebody has opened its effector. A task that says that nobody
    checked is excused.
    """
    for cell, task, began in look.truth.done_tasks:
        for effector in look.truth.grips.of(cell, began):
            empty_handed = effector.empty_handed
            if empty_handed is None or empty_handed.told.cell != cell:
                continue
            if empty_handed.robbed and not _untold(look, effector.arm, began):
                yield f"{task} is called done, but its part was taken from the effector"
            elif not (empty_handed.robbed or _is_unchecked(look, task, effector, began)):
                yield f"{task} is called done, and its arm brought no part"


def _is_unchecked(look: Look, task: str, effector: Effector, began: float) -> bool:
    """True where nobody could know, or looked, whether an effector has a part."""
    is_blind = effector.unseen_at >= began
    lies = look.truth.deceived_since(effector.arm.robot.mqtt, "piece", began)
    return is_blind or lies or Check.GRIP in look.truth.unchecked[task]


@invariant(Trigger.DONE_TASKS)
def unchecked_is_as_said(look: Look) -> Iterator[str]:
    """A done task says that its grip is unchecked where no piece sensor speaks, and its release where the
    board says nothing of its effector, or has booted, as that of any other holder of its cell may have; where
    all is said, only of a grip that its recipe, or the plant file, leaves unchecked.
    """
    for cell, task, began in look.truth.done_tasks:
        arms = [each.arm for each in look.truth.grips.of(cell, began) if each.let_go is not None]
        if not arms:
            continue
        silent = any(arm.robot.evidence is not Evidence.IDS for arm in arms)
        may_miss = any(_may_miss_a_release(look, each, began) for each in _holders(look, cell))
        unchecked = look.truth.unchecked[task]
        if (Check.GRIP in unchecked) not in _may_be_unchecked(look, cell, task, silent=silent):
            yield f"{task} is done, and its grip is {_checked(Check.GRIP, unchecked)}"
        if (Check.RELEASE in unchecked) is not silent and not may_miss:
            yield f"{task} is done, and its release is {_checked(Check.RELEASE, unchecked)}"


def _holders(look: Look, cell: str) -> Iterator[RobotTruth]:
    found = (look.truth.robot(name) for name in look.world.model.cell(cell).holders)
    return (each for each in found if each is not None)


def _may_miss_a_release(look: Look, holder: RobotTruth, began: float) -> bool:
    """True for what has booted since then, and for a device that is no arm and names no command, if it was
    told to open since then.
    """
    is_silent = holder.robot.evidence is not Evidence.IDS and not isinstance(holder, ArmTruth)
    was_told = look.truth.places.was_told_to_open(holder.robot.name, since=began)
    return (is_silent and was_told) or holder.booted_us / 1e6 >= began


def _may_be_unchecked(look: Look, cell: str, task: str, *, silent: bool) -> tuple[bool, ...]:
    """The answers that a task may give to whether its grip is unchecked; a recipe of the plant may choose."""
    model, known = look.world.model.cell(cell), tasks_of(look.world.plant).get(task)
    if silent:
        return (True,)
    if known is None or not model.recipe(text.parse(known.order.text, look.world.model).recipe).is_shipped:
        return (True, False)
    return (model.piece_check is False,)


def _checked(check: Check, unchecked: tuple[Check, ...]) -> str:
    return "not checked" if check in unchecked else "checked"


def _grips(look: Look) -> Iterator[str]:
    truth = look.truth
    for name in truth.grips.stray:
        yield f"{name} is told to grip while no task of its cell runs"
    for switching in truth.grips.switched:
        if switching.on and not switching.is_at_place and not _is_excused(look, switching):
            yield f"{switching.arm} grips at {switching.where}: no part is gripped there"
    for cell, task in truth.begun_tasks:
        for name in look.world.model.cell(cell).own:
            effector = truth.grips.effectors.get(name)
            if effector is not None and effector.arm.on and not _untold(look, effector.arm, look.world.now):
                yield f"{task} begins, and the effector of {name} is on"


def _is_excused(look: Look, switching: Switching) -> bool:
    """True where the plant could not know where an arm stood, or did not give the order."""
    arm = look.truth.grips.effectors[switching.arm].arm
    return switching.outdated or switching.taken_away or look.truth.unseen(arm)


def _was_let_go(arm: ArmTruth) -> bool:
    """True where its board carried out a command to let go in this step; late commands come many at once."""
    return any(isinstance(act.goal, EffectorGoal) and not act.goal.on for act in arm.acts)


def _lies_ready(arm: ArmTruth) -> bool:
    """True where a part lay where an arm stands, or stood before it moved on in this step."""
    names = {pose.name for pose in supplies_of(arm.cell, arm.robot.name)}
    return not names.isdisjoint(arm.stood | arm.reaches)


def _untold(look: Look, arm: ArmTruth, since: float) -> bool:
    """True if nobody can tell what an effector did: its board lied or says nothing of it."""
    unproven = arm.robot.evidence is not Evidence.IDS
    return unproven or look.truth.deceived_since(arm.robot.mqtt, "effector", since)


GRIPS = (
    effector_on_only_for_a_part,
    effector_off_only_where_legal,
    parts_conserved,
    done_tasks_bring_their_parts,
    unchecked_is_as_said,
)
