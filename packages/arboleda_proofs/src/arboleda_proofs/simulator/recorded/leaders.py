"""Record of the leaders of a plant with two hosts, apart from what these believe themselves.

`history_is_one` finds by it a store that takes what a leader of before writes.
"""

from __future__ import annotations

from itertools import pairwise

from arboleda.departures.leading import Standing
from arboleda.drivers import Stop, StopMode
from arboleda.model.messages import ENDED, Heartbeat, TaskChanged, TaskState
from arboleda.rig.hosts.database import Write
from arboleda.rig.hosts.former_leader import LateMessage
from arboleda.rig.hosts.hosts import Hosts
from arboleda.rig.world import World
from arboleda.wire.payloads import Goal
from arboleda.wire.topics import Channel, parse
from arboleda.wire.transport import Publication

from .boards import Boards

NO_ORDERS = (Channel.STOP, Channel.BEAT)


class Leaders:
    """Breaches of the rules for leaders: `twice` are numbers that were led more than once, or that went back;
    `old` are goals that a board carries out in this step under a number lower than one of which it had read a
    beat, or carried out something, since it booted; `sure` are processes that led and still were sure of that
    when the next one began; `wrong` are tasks lost or doubled in the history, and
    writes by a process that leads no more.
    """

    def __init__(self, world: World, hosts: Hosts, boards: Boards) -> None:
        self._world, self._hosts, self._boards = world, hosts, boards
        self._known = 0  # how many of the numbers have been looked at
        self._boots: dict[str, int] = {}
        self._epochs: dict[str, int] = {}
        self._beats: dict[str, tuple[int, int]] = {}  # boot and newest beat of each board before this step
        self._states: dict[str, TaskState] = {}
        self._last: Write | None = None
        self._starts = world.plant_process.starts
        self.twice: list[str] = []
        self.sure: list[str] = []
        self.old: list[str] = []
        self.wrong: list[str] = []

    def look(self) -> None:
        """Take in what happened in this step."""
        self.twice, self.old, self.wrong, self.sure = [], [], [], []
        moment = self._world.moment
        if len(self._hosts.numbers) > self._known:
            self._look_at_numbers()
        for board, goal in moment.executed:
            self._carried_out(board, goal)
        # Only now, as nothing tells if a board read the beats or the commands of one step first.
        self._beats = {name: (each.boot, each.beat or 0) for name, each in self._boards.by_name.items()}
        for write in moment.writes:
            self._wrote(write)
        if self._world.plant_process.starts != self._starts:
            self._starts = self._world.plant_process.starts
            self._look_at_found()

    def _look_at_numbers(self) -> None:
        numbers = self._hosts.numbers
        for (before, _), (number, host) in pairwise(numbers):
            if number <= before:
                self.twice.append(f"{host} leads under number {number}, after number {before}")
        self._known = len(numbers)
        for former in (each for each in self._hosts.formers if not each.over):
            process, now = former.process, self._world.now
            if process.standing is Standing.LEADS and process.lease.lasts(process.host.clock(now)):
                who = f"{process.host.name}, which led under number {process.epoch},"
                self.sure.append(f"{numbers[-1][1]} leads, and {who} is sure that it does")

    def _carried_out(self, board: str, goal: Goal) -> None:
        """Take in goals that boards carried out; a board that booted knows no numbers any more."""
        if goal.epoch is None:
            return
        boot = self._world.boards[board].boot_id
        if self._boots.get(board) != boot:
            self._boots[board] = boot
            self._epochs.pop(board, None)
        of_boot, beat = self._beats.get(board, (boot, 0))
        epoch = max(self._epochs.get(board, 0), beat if of_boot == boot else 0)
        if goal.epoch < epoch:
            self.old.append(f"{board} was led under number {epoch}, and carries out {goal}")
        self._epochs[board] = max(epoch, goal.epoch)

    def _wrote(self, write: Write) -> None:
        if write.epoch != write.leads:
            self.wrong.append(
                f"who led under number {write.epoch} writes {write.message} while {write.leads} leads"
            )
        again = self._last is not None and self._last.message is write.message  # an answer was lost
        self._last = write
        if isinstance(write.message, TaskChanged) and not again:
            self._changed(write.message)

    def _changed(self, change: TaskChanged) -> None:
        before = self._states.get(change.task)
        if before in ENDED and change.state is not before:
            self.wrong.append(
                f"task {change.task} had ended as {before.value}, is kept as {change.state.value}"
            )
        if before is None and change.state is not TaskState.QUEUED:
            self.wrong.append(f"task {change.task} is {change.state.value}, and was never kept as accepted")
        if before not in ENDED:
            self._states[change.task] = change.state

    def _look_at_found(self) -> None:
        """Check that a process that starts finds all that the store took."""
        tasks = self._world.disk.tasks
        for id, state in self._states.items():
            found = tasks.get(id)
            if found is None or found.state is not state:
                now = "nothing" if found is None else found.state.value
                self.wrong.append(f"the store took task {id} as {state.value}, and knows of it {now}")


def may_follow(late: LateMessage) -> bool:
    """True for what may leave a superseded process: a stop, if it cannot find out that it is superseded, and
    the beat without which a stop does not count; what its bridge makes of these, or stops by itself.
    """
    if isinstance(late.message, Publication):
        return parse(late.message.topic)[1] in NO_ORDERS
    is_stop = isinstance(late.message, Stop) and late.message.mode is not StopMode.CLEAR
    return late.standing is Standing.UNSURE and (is_stop or isinstance(late.message, Heartbeat))
