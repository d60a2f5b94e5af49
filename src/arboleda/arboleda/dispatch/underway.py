"""Commands that may still be under way to a robot, or be carried out although the plant has given them up."""

from __future__ import annotations

from collections.abc import Callable, Collection

from arboleda.model.commands import Command, Switch, Work
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import QUIET_S, Cell, Evidence, PlantModel, Robot

PATIENCE_S = 1.0  # an arm that is heard, and hears the plant, names the plant's last command within this
MOST = 64  # commands per arm; whatever settles a later command settles those before it


class UnnamedCommands:
    """Commands that left for each board that numbers them, and that the board has not named yet.

    A report may prove a command done without naming it: a switch may have been as it was told. `ids` by
    robot, oldest first.
    """

    def __init__(self, model: PlantModel) -> None:
        robots = model.robots.values()
        self.ids: dict[str, list[str]] = {
            robot.name: [] for robot in robots if robot.evidence is Evidence.IDS
        }

    def leaves(self, command: Command) -> None:
        """Note a command that leaves for its robot."""
        if (ids := self.ids.get(command.robot)) is not None:
            ids.append(command.id)
            del ids[:-MOST]

    def hear(self, report: Report) -> None:
        """Drop the commands that a report names."""
        if ids := self.ids.get(report.robot):
            _settle(ids, report)


class UnderWay:
    """Commands to each arm that shares zones, or is shared, which no report has settled.

    Until then the arm may carry out a command that it has not heard yet, so the place where it stands does
    not prove that it stays there. An arm that names commands, and can be stopped, settles a command by naming
    it. Commands reach a board in order, so a command that it took settles all before it. A rejected command
    settles itself alone, since the bridge may have refused it. Of any other arm only work counts: it is
    settled by its end, or once the arm was heard for as long as an answer may take. `ids` by robot, oldest
    first.

    Shared devices that hold parts and name commands are followed, too. `movers` are the others.
    """

    def __init__(self, model: PlantModel) -> None:
        names = (name for cell in model.cells for name in (*cell.zone_users, *cell.shared_movers))
        users = [model.robots[name] for name in names]
        self.movers = frozenset(robot.name for robot in users)
        holders = (model.robots[name] for cell in model.cells for name in _shared_holders(cell))
        self._naming = frozenset(robot.name for robot in (*users, *holders) if _names_commands(robot))
        self._others = frozenset(robot.name for robot in users) - self._naming
        self.ids: dict[str, list[str]] = {}
        self._reporting_since: dict[str, float] = {}  # since the last one left

    def leaves(self, command: Command) -> None:
        """Note a command that leaves for its robot."""
        works = command.robot in self._others and isinstance(command, Work)
        if works or command.robot in self._naming:
            self.ids[command.robot] = [*self.ids.get(command.robot, ())[-MOST:], command.id]
            self._reporting_since.pop(command.robot, None)

    def hear(self, report: Report, now: float) -> None:
        """Drop the commands that a report settles."""
        ids = self.ids.get(report.robot)
        if ids is None:
            return
        reporting_since = self._reporting_since.setdefault(report.robot, now)
        if report.robot in self._others and now >= reporting_since + QUIET_S:
            ids.clear()
        _settle(ids, report)
        if not ids:
            del self.ids[report.robot]

    def ended(self, command: Command) -> None:
        """Drop a command that is done, or whose robot was seen to stand since it was cancelled."""
        if command.robot in self._others:
            self.ids.pop(command.robot, None)

    def is_overdue(self, robot: str, now: float) -> bool:
        """True where a command to a robot must have been lost."""
        waits = robot in self.ids and robot in self._naming
        return waits and now >= self._reporting_since.get(robot, now) + PATIENCE_S


class Unfinished:
    """Commands that are over for the plant, and that a device may still carry out.

    They count at devices on which zones depend, and at those that cells hand on to each other empty. A
    command is dropped once its device names it as ended, has done another command of the same facts, or was
    heard without a fault for as long as the command may take. Work is dropped also once the device has taken
    it and is at rest, and a boot drops all. Reports of a device that has named neither the command nor a
    later one may be older than the command, so the time begins with such a name. `by_device` has each command
    with its time (s).
    """

    def __init__(self, model: PlantModel) -> None:
        self._devices = frozenset(
            name for cell in model.cells for name in (*cell.interlocked, *_shared_holders(cell))
        )
        self.by_device: dict[str, list[tuple[Switch | Work, float]]] = {}
        self._well_since: dict[str, float] = {}

    def expect(self, command: Command, allowed_s: float, now: float) -> None:
        """Note that a device may still carry out this command, for `allowed_s`."""
        if command.robot in self._devices and isinstance(command, (Switch, Work)):
            self.by_device.setdefault(command.robot, []).append((command, allowed_s))
            self._well_since[command.robot] = now

    def may_grip(self, device: str) -> bool:
        """True where a device may still grip a part."""
        return any(
            command.grips for command, _ in self.by_device.get(device, ()) if isinstance(command, Switch)
        )

    def may_be_news(self, device: str, unnamed: Collection[str]) -> bool:
        """True where all reports of a device may be older than one of its commands, which is unnamed."""
        return any(command.id in unnamed for command, _ in self.by_device.get(device, ()))

    def done(self, command: Command) -> None:
        """Drop the commands that set facts which a command that is done has set again."""
        facts = {name for name, _ in command.sets}
        self._keep(command.robot, lambda other, _: facts.isdisjoint(name for name, _ in other.sets))

    def hear(self, report: Report, now: float, *, is_well: bool, unnamed: Collection[str]) -> bool:
        """Drop the commands that a report ends; True where there were any. `is_well`: it reports no fault.

        `unnamed` are the commands that the device has not named, nor any later one.
        """
        before = self.by_device[report.robot]
        if not is_well or self.may_be_news(report.robot, unnamed):
            self._well_since[report.robot] = now
        well_s = now - self._well_since[report.robot]
        ended = {report.done, report.failed, report.rejected}
        at_rest = None if report.state is MotionState.MOVING else report.accepted
        self._keep(
            report.robot,
            lambda command, allowed_s: (
                well_s < allowed_s
                and command.id not in ended
                and not (isinstance(command, Work) and command.id == at_rest)
            ),
        )
        return len(self.by_device.get(report.robot, ())) < len(before)

    def _keep(self, device: str, stays: Callable[[Switch | Work, float], bool]) -> None:
        remaining = [each for each in self.by_device.pop(device, ()) if stays(*each)]
        if remaining:
            self.by_device[device] = remaining


def _settle(ids: list[str], report: Report) -> None:
    """Take out the commands that a report names, and those that left before one that was taken."""
    for taken in (report.accepted, report.done):
        if taken in ids:
            del ids[: ids.index(taken) + 1]
    if report.rejected in ids:
        ids.remove(report.rejected)


def _names_commands(robot: Robot) -> bool:
    return robot.evidence is Evidence.IDS and robot.has_stop


def _shared_holders(cell: Cell) -> tuple[str, ...]:
    """The devices that a cell shares and that can hold a part."""
    return tuple(name for name in cell.shared if name in cell.holders)
