"""Walk back into a task: judges by reports what became of the steps at which an earlier start ended.

Only a board that numbers commands proves anything. If it is of the same boot and has taken no command that
the trail cannot explain, then all that it did before is as it was left. Its last command is done, was never
taken, or was a move that stopped on its way, which is given anew as after a hold. After a power cut the board
may have taken one command more, which was not kept. Where it echoes that this command is of the very next
step, the steps before have succeeded. Anything else is for a person to judge.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Any

from py_trees.behaviour import Behaviour

from arboleda.dispatch.belief import Belief
from arboleda.dispatch.ledger import Entry
from arboleda.model.grips import Grip
from arboleda.model.messages import Failure, Reason, Receipt
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.step_token import ATTEMPTS, StepToken
from arboleda.trees.context import Context
from arboleda.trees.leaves import Act, Leaf, Note
from arboleda.trees.node_state import MOTION, OTHER, QUERY, SWITCH, Keeps, command_kept

from .succession import PASSED, steps_between
from .trail import Trail

STILL_MOVING = Phrase("walk.still_moving", "{robot} is still moving")
NOT_SAID = Phrase("walk.not_said", "{robot} has not said yet what became of its last command")
BOOTED = Phrase("walk.booted", "{robot} has booted since then, and may stand elsewhere")
MOVED = Phrase("walk.moved", "{robot} no longer stands where the task began")
NO_NUMBERS = Phrase(
    "walk.no_numbers",
    "{robot} does not number its commands, and proves nothing; look at it, as retry does the step again",
)
UNPROVEN = Phrase(
    "walk.unproven",
    "{robot} proves neither that it has done this nor that it has not; look at it, as retry does it again",
)
MORE = Phrase("walk.more", "{robot} has taken commands of which this plant knows nothing")
LOST = Phrase("walk.lost", "{robot} held a part then, and holds none now")
HOLDS = Phrase("walk.holds", "{robot} held nothing then, and says that it holds something")
NO_PART = Phrase("part.gone", "{arm} has no part to go on with")
NOBODY_KNOWS = Phrase("walk.nobody_knows", "nobody knows how far it came")


class Fate(Enum):
    """Outcome of a command that was under way when the plant stopped."""

    DONE = "done"
    UNTAKEN = "untaken"
    CUT_SHORT = "cut_short"
    UNPROVEN = "unproven"


@dataclass(frozen=True, kw_only=True)
class Judgement:
    """Judgement by the devices' reports: `waits` for a report, or the `failure` that a person has to judge.

    `stranded` is why the task can only be abandoned. `fates` are those of the steps that were under way.
    """

    waits: Sentence | None = None
    failure: Failure | None = None
    stranded: Sentence | None = None
    fates: Mapping[Keeps, Fate]
    echo: Echo | None = None


@dataclass(frozen=True)
class Doubt:
    """Reason for which a device keeps a task from going on by itself."""

    reason: Reason
    sentence: Sentence
    stranded: Sentence | None = None


@dataclass(frozen=True, kw_only=True)
class Echo:
    """Command that no trail has, by the token that its board echoes: its step, attempt and record.

    `passed` are the leaves between the step of the trail and this step.
    """

    step: Act
    attempt: int
    last: Mapping[str, Any]
    passed: Sequence[Leaf]


class WalkBack:
    """Task of an earlier start, until a person says how it goes on. `begun` are the steps under way then.

    `due` is when it has to be judged anew even without a report, s of the plant's time.
    """

    def __init__(self, trail: Trail, begun: Sequence[Keeps], nodes: Sequence[Behaviour]) -> None:
        self.trail = trail
        self.begun = begun
        self._nodes = nodes
        self.due: float | None = None
        self._reporting_since: float | None = None  # since when all of its devices are heard and stand

    def judge(self, context: Context) -> Judgement:
        """Judge the steps that were under way by the reports of the task's devices until now."""
        names = [name for name in self.trail.knowledge if context.devices.has(name)]
        beliefs = {name: context.robots.belief(name) for name in names}
        troubles: dict[str, Doubt] = {}
        echoes: dict[str, Echo] = {}
        self.due = None
        for name, belief in beliefs.items():
            obstacle = context.robots.obstacle(name)
            if obstacle is not None or belief.moves:
                waits = obstacle.sentence if obstacle else STILL_MOVING(robot=name)
                self._reporting_since = None
                return Judgement(waits=waits, fates={})
            if (echo := self._echo(belief, context.commands.task)) is not None:
                echoes[name] = echo
            if (trouble := self._changed(belief, echo)) is not None:
                troubles[name] = trouble
        if len(echoes) > 1:  # nobody knows which of two commands came first
            troubles |= {name: _more(name) for name in echoes}
        if self._reporting_since is None:
            self._reporting_since = context.time.plant_now
        settled_at = self._reporting_since + context.timing.effector_timeout_s
        early = context.time.plant_now < settled_at
        echo = next(iter(echoes.values()), None)
        fates: dict[Keeps, Fate] = {}
        if echo is not None and echo.step not in self.begun:
            fates = dict.fromkeys(self.begun, Fate.DONE)
        for step, last in self._last_commands(echo):
            name = str(last["robot"])
            belief = context.robots.belief(name)
            fates[step] = Fate.UNPROVEN if name in troubles else fate(last, belief)
            if fates[step] is Fate.UNPROVEN and early and name not in troubles:
                self.due = settled_at
                return Judgement(waits=NOT_SAID(robot=name), fates={})
            if fates[step] is Fate.UNPROVEN:
                troubles.setdefault(name, Doubt(Reason.INTERRUPTED, UNPROVEN(robot=name)))
        worst = sorted(troubles.values(), key=lambda each: each.stranded is None)
        if not worst:
            return Judgement(fates=fates, echo=echo)
        failure = Failure(reason=worst[0].reason, sentence=worst[0].sentence)
        return Judgement(failure=failure, stranded=worst[0].stranded, fates=fates, echo=echo)

    def _last_commands(self, echo: Echo | None) -> list[tuple[Act, Mapping[str, Any]]]:
        """The steps to judge, with the records of their last commands."""
        if echo is not None:
            return [(echo.step, echo.last)]
        acts = [step for step in self.begun if isinstance(step, Act)]
        return [(act, act.last) for act in acts if act.last is not None]

    def go_on(self, finding: Judgement) -> None:
        """Go on after the steps that are done, and begin all others anew that were under way."""
        for step in self.begun:
            outcome = finding.fates.get(step)
            if isinstance(step, Leaf):
                step.proven = outcome is Fate.DONE
            if isinstance(step, Act):
                step.may_have_left = step.may_have_left or outcome not in (None, Fate.UNTAKEN)
            if outcome is not Fate.DONE:
                step.begin_anew()
        echo = finding.echo
        if echo is not None and echo.step not in self.begun:
            for leaf in echo.passed:
                leaf.proven = True
            done = finding.fates.get(echo.step) is Fate.DONE
            echo.step.take_up({**echo.last, "done": done}, echo.attempt)

    def _echo(self, belief: Belief, task: str | None) -> Echo | None:
        """The one command more that a device has taken than the trail explains, if it is of the next step."""
        knowledge, now, tokens = self.trail.knowledge[belief.robot.name], belief.receipt, belief.tokens
        if now is None or tokens is None or tokens.accepted is None or len(self.begun) != 1:
            return None
        if not self._is_numbered(belief) or belief.boot_id != knowledge.boot:
            return None
        if knowledge.explains(now) or not knowledge.explains(now, others=1):
            return None
        token = StepToken.read(tokens.accepted)
        if token is None or token.task != task or token.step >= len(self._nodes):
            return None
        if now.done == now.accepted and tokens.done != tokens.accepted:
            return None
        step = self._nodes[token.step]
        return self._echo_of(step, token, belief.robot.name, now) if isinstance(step, Act) else None

    def _echo_of(self, step: Act, token: StepToken, robot: str, now: Receipt) -> Echo | None:
        """The echo of a command of the step that a token names.

        That step has to be the step of the trail, at its next attempt, or the very next step; else None.
        """
        (before,) = self.begun
        given = {"before": None, "number": now[:2], "done": False}
        record = before.last if isinstance(before, Act) else {}
        if record is None or record.get("effect") == QUERY or not isinstance(before, (Act, *PASSED)):
            return None  # it gave no command yet, its answer was not kept, or it waits for zones or devices
        if before is step:
            attempt = step.given_times + 1
            if token.attempt != attempt % ATTEMPTS or record["robot"] != robot:
                return None
            return Echo(step=step, attempt=attempt, last={**record, **given}, passed=())
        passed = steps_between(before, step)
        last = {**_record_of(step), **given}
        if passed is None or last.get("robot") != robot:
            return None
        if last["grips"] and any(type(leaf) is Note for leaf in passed):
            return None  # the note of where the part comes from needs an empty hand
        return Echo(step=step, attempt=token.attempt, last=last, passed=passed)

    def _changed(self, belief: Belief, echo: Echo | None) -> Doubt | None:
        """The doubt whether a device is still as the trail has it; None where its reports leave none."""
        name = belief.robot.name
        grip, holds = self.trail.grips.get(name), belief.held_in(belief)
        if echo is not None:
            grip = Grip.SWITCHING if echo.last["grips"] is not None else grip
        if grip == Grip.ON and holds is False:
            return Doubt(Reason.PART_LOST, LOST(robot=name), NO_PART(arm=name))
        if echo is None and name not in self.trail.used:
            return self._moved(belief) or self._more_commands(belief)
        if not self._is_numbered(belief):
            return Doubt(Reason.INTERRUPTED, NO_NUMBERS(robot=name))
        if echo is None and (more := self._more_commands(belief)) is not None:
            return more
        if (
            grip in (Grip.ON, Grip.SWITCHING) and holds is None
        ):  # an effector that was off got no command since
            return Doubt(Reason.INTERRUPTED, UNPROVEN(robot=name))
        if grip == Grip.OFF and holds:
            return Doubt(Reason.INTERRUPTED, HOLDS(robot=name))
        return None

    def _is_numbered(self, belief: Belief) -> bool:
        """True for a device that numbered its commands when the trail was kept, and does so now."""
        return belief.numbers_commands and self.trail.knowledge[belief.robot.name].boot is not None

    def _more_commands(self, belief: Belief) -> Doubt | None:
        """The doubt whether a device has taken commands that the trail does not explain.

        It is for unused devices, too: after a power cut the trail may lack the steps that used them.
        """
        name, knowledge = belief.robot.name, self.trail.knowledge[belief.robot.name]
        if not self._is_numbered(belief):
            return None
        if belief.boot_id != knowledge.boot:
            return Doubt(Reason.REBOOTED, BOOTED(robot=name))
        if not knowledge.explains(belief.receipt):
            return _more(name)
        return None

    def _moved(self, belief: Belief) -> Doubt | None:
        """The doubt whether a device that the task has not used is still where the task was planned from."""
        begun, here = self.trail.begun.planned.positions.get(belief.robot.name), belief.known_position
        if begun is None:
            return None
        if here is not None and belief.robot.motion.stands_at(here, begun):
            return None
        return Doubt(Reason.INTERRUPTED, MOVED(robot=belief.robot.name), NOBODY_KNOWS())


def _more(robot: str) -> Doubt:
    return Doubt(Reason.INTERRUPTED, MORE(robot=robot), NOBODY_KNOWS())


def _record_of(step: Act) -> Mapping[str, Any]:
    """The record of a step's command, as it would be given now; empty where the recipe raises."""
    try:
        command = step.make(id="")
    except Exception:  # noqa: BLE001 - a recipe may be user code, and count on what it has done by then
        return {}
    return command_kept(Entry(command, cell="", doing=step.doing, sent_at=0.0, deadline=0.0)) or {}


def fate(last: Mapping[str, Any], belief: Belief) -> Fate:
    """The fate of a command to a robot that stands, and has taken no command beside those of the trail."""
    if last["effect"] == QUERY:
        return Fate.CUT_SHORT  # to ask once more changes nothing
    if last["done"]:
        return Fate.DONE
    now, before = belief.receipt, last["before"]
    facts_hold = all(belief.fact(name) == value for name, value in last["sets"])
    if last["effect"] == SWITCH and last["sets"] and facts_hold:
        return Fate.DONE
    if (None if now is None else now[:2]) == (None if before is None else tuple(before[:2])):
        return Fate.UNTAKEN
    if now is None or last["effect"] == OTHER:
        return Fate.UNPROVEN
    number = None if last["number"] is None else tuple(last["number"])
    ended = now.done is not None and (now.epoch, now.done) == (number or (now.epoch, now.accepted))
    if last["effect"] == MOTION and (last["goal"] is not None or last["sets"]):
        return Fate.DONE if ended and facts_hold and _at(last["goal"], belief) else Fate.CUT_SHORT
    return Fate.DONE if ended and facts_hold and number is not None else Fate.UNPROVEN


def _at(goal: Any, belief: Belief) -> bool:
    """True for a robot at the goal of its command; for a command without a goal its facts decide."""
    if goal is None:
        return True
    place = tuple(goal) if isinstance(goal, list) else goal
    return belief.known_position is not None and belief.robot.motion.stands_at(belief.known_position, place)
