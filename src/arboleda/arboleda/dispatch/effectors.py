"""Effectors: what each of them may hold, by commands and by reports."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum

from arboleda.model.commands import Command, Switch
from arboleda.model.grips import Grip, Grips
from arboleda.model.messages import Fact, Report
from arboleda.model.plant_model import PlantModel
from arboleda.model.sentence import BOTH, Phrase, Sentence

from . import evidence
from .belief import Belief
from .evidence import Before
from .fact_memory import EMPTIED, FactMemory, Memory
from .interference import Interferences
from .ledger import Ledger

OPENED = Phrase("effector.opened", "{arm}: the effector opened while it held a part, {how}")
DEVICE_OPENED = Phrase("device.let_go", "{device} let go of the part that it held, {how}")
UNBIDDEN = Phrase("effector.unbidden", "not commanded by this plant")
AS_REBOOTED = Phrase("effector.as_rebooted", "as its board rebooted")


class HandlingStep(Enum):
    """Step of a part's way through an effector."""

    TOLD_TO_TAKE = "told to take"
    TOLD_TO_MAKE = "told to make"  # a device, at a place of its own
    NOT_MADE = "not made"  # it refused to, or was never told
    HELD = "held"
    MISSED = "missed"  # it closed on nothing, as its sensor says on the way
    LOST = "lost"  # its sensor has seen it on the way, and does not any more
    TOLD_TO_LET_GO = "told to let go"
    EMPTY = "empty"
    TAKEN_OUT = "taken out"  # by a person


class Effectors:
    """Books of all effectors of a plant. `version` grows whenever a grip changes, or what is in it.

    `unopened` are robots whose last command to let go failed. `opened` has a sentence for each robot whose
    effector let go unbidden since its last command. `cut_off` are robots that may still switch on a command
    of an earlier start. `watchers` of a device are called at each step of a part's way through it.
    """

    def __init__(
        self, model: PlantModel, facts: Memory, memory: FactMemory, ledger: Ledger, others: Interferences
    ) -> None:
        holders = [robot.name for robot in model.robots.values() if robot.held_fact is not None]
        spaces = [space for cell in model.cells for space in cell.reach.values()]
        self._tools = {space.robot.name: space.tool.name for space in spaces if space.tool is not None}
        self.grips = Grips(holders, facts.get(Fact.EFFECTOR, {}), self._tools.values())
        self.unopened: set[str] = set()
        self.opened: dict[str, Sentence] = {}
        self.cut_off: set[str] = set()
        self.version = 0
        self.watchers: dict[str, list[Callable[[str, HandlingStep], None]]] = {
            name: [] for name in model.robots
        }
        self._felt: dict[str, bool] = {}  # by arm: what its sensor said last on the way of a closed effector
        self._closed_at: dict[str, float] = {}  # by arm: when it was first heard to move closed
        self._emptied = {name for name in holders if memory.value(Fact.EMPTIED, name) is not None}
        self._memory = memory
        self._ledger = ledger
        self._others = others

    def opening_tool(self, robot: str) -> str | None:
        """The tool of a robot that may still let go on an earlier command, so that the robot has to stay."""
        tool = self._tools.get(robot)
        return tool if tool in self.grips.opening else None

    def command(self, command: Switch) -> None:
        """Book a command to an effector that leaves now."""
        self.opened.pop(command.robot, None)
        self._felt.pop(command.robot, None)
        self._closed_at.pop(command.robot, None)
        self._set_emptied(command.robot, emptied=False)
        if not command.grips:
            self.grips.open(command.robot, command.id)
        if not command.grips or self.grips[command.robot] is Grip.OFF:
            handling = HandlingStep.TOLD_TO_TAKE if command.grips else HandlingStep.TOLD_TO_LET_GO
            self._tell(command.robot, handling)
        self.set(command.robot, Grip.SWITCHING)

    def make(self, device: str) -> None:
        """Book a command that makes a part, which leaves now."""
        self._tell(device, HandlingStep.TOLD_TO_MAKE)

    def unmake(self, device: str) -> None:
        """Book that a device has made nothing of a command that it refused, or that never left."""
        self._tell(device, HandlingStep.NOT_MADE)

    def declare_empty(self, belief: Belief) -> None:
        """Book that a person has taken the part out of a device.

        A device that goes on reporting a part counts as empty until its next command to grip or to let go, or
        until it reports that it is empty.
        """
        robot = belief.robot.name
        self.cut_off.discard(robot)
        if belief.held_in(belief):
            self._set_emptied(robot, emptied=True)
        self.set(robot, Grip.OFF, taken_out=True)

    def set(self, robot: str, grip: Grip, *, taken_out: bool = False) -> None:
        """Book the grip of an effector; `taken_out`: a person has its part."""
        if self.grips.set(robot, grip):
            self.version += 1
            if grip is not Grip.SWITCHING:
                empty = HandlingStep.TAKEN_OUT if taken_out else HandlingStep.EMPTY
                self._tell(robot, HandlingStep.HELD if grip is Grip.ON else empty)
            self._memory.remember(Fact.EFFECTOR, robot, grip._value_)  # a call less than `value`
        if grip is Grip.OFF:
            self.unopened.discard(robot)

    def note_opening(self, belief: Belief, *, rebooted: bool) -> None:
        """Note an effector that has opened with a part, where no command of this plant is open for it."""
        arm = belief.robot.name
        if self.grips[arm] is not Grip.ON or self._switches(arm):
            return
        how = AS_REBOOTED if rebooted else UNBIDDEN
        opened = OPENED(arm=arm, how=how()) if belief.robot.has_effector else None
        sentence = opened or DEVICE_OPENED(device=arm, how=how())
        others = None if rebooted else self._others.lately_obeyed(arm, belief.heard_at or 0.0)
        self.opened[arm] = BOTH(first=sentence, second=others) if others else sentence

    def settle_cut_off(self, belief: Belief) -> None:
        """Believe the report of an effector that an earlier start was switching."""
        self.cut_off.discard(belief.robot.name)
        if (held := belief.held_in(belief)) is not None:
            self.settle(belief.robot.name, Grip.ON if held else Grip.OFF)

    def settle(self, robot: str, grip: Grip) -> None:
        """Believe the report of an effector that no command is switching, and that will not open late.

        An effector that a person has emptied counts as empty until it reports that itself.
        """
        if robot in self._emptied:
            if grip is not Grip.OFF:
                return
            self._set_emptied(robot, emptied=False)
        if self.grips[robot] is grip or self._switches(robot):
            return
        if grip is not Grip.ON or robot not in self.grips.opening:
            self.set(robot, grip)

    def feel(self, belief: Belief, *, debounce_s: float) -> None:
        """Believe the sensor of an arm that moves with its effector closed.

        On its way it sees nothing but what is in the hand; at a place it may see what lies there. So a word
        counts that it has said on this way, in this boot, and has stood by for the debounce.
        """
        robot, sees, felt = belief.robot, belief.piece, self._felt.get(belief.robot.name)
        arm, heard_at = robot.name, belief.heard_at or 0.0
        if sees is None or sees is felt or self.grips[arm] is not Grip.ON:
            return
        closed_at = self._closed_at.setdefault(arm, heard_at)
        said_at = heard_at if robot.piece_on_change else belief.piece_at
        since = max(belief.moves_since, belief.piece_since, closed_at)
        if belief.piece_boot != belief.boot_id or said_at - since < debounce_s:
            return
        self._felt[arm] = sees
        self.version += not sees or felt is not None  # else it is as it was told
        missed = HandlingStep.LOST if felt else HandlingStep.MISSED
        self._tell(arm, HandlingStep.HELD if sees else missed)

    def settle_opening(self, before: Before, belief: Belief, report: Report) -> None:
        """Forget commands to let go that a tool lost in a reboot, refused, or failed to do."""
        tool = belief.robot.name
        if evidence.rebooted(before, belief, report):
            self.grips.forget_opening(tool)
        self.grips.will_not_open(tool, report.rejected, report.failed)

    def _tell(self, robot: str, handling: HandlingStep) -> None:
        for watcher in self.watchers[robot]:
            watcher(robot, handling)

    def _set_emptied(self, robot: str, *, emptied: bool) -> None:
        (self._emptied.add if emptied else self._emptied.discard)(robot)
        self._memory.remember(Fact.EMPTIED, robot, EMPTIED if emptied else None)

    def _switches(self, arm: str) -> bool:
        return arm in self.cut_off or any(_grips(entry.command) for entry in self._ledger.of_robot(arm))


def _grips(command: Command) -> bool:
    return isinstance(command, Switch) and command.grips is not None
