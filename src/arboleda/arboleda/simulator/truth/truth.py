"""The truth about a whole world, step by step."""

from __future__ import annotations

from arboleda.core import text
from arboleda.core.commands import Home, Stop
from arboleda.core.messages import Fact, OperatorAnswer, Remember, TaskChanged, TaskState, Verb
from arboleda.core.model import Evidence
from arboleda.core.task import Order
from arboleda.kinds.arm import Arm, MoveJoints, SetEffector
from arboleda.kinds.mobile import FollowPath, Mobile

from ..world import BRIDGE, World
from .arm import ArmTruth
from .books import Books
from .boots import Boots
from .deeds import CellTruth, Ended
from .mobile import MobileTruth
from .parts import Parts
from .robot import BEATS, Act, RobotTruth
from .stops import Stops, robots_of
from .zones import ZonesTruth

SAMPLE_S = 1.0  # no deception is shorter: it lasts until what was said cannot be believed any more
COMMANDS = (MoveJoints, FollowPath, SetEffector, Stop, Home)


class Truth:
    """Looks at the boards' bodies, and at what was said, after every step; robots and cells by name.

    Of this step: `changed`, the robots of which there is more to say than that they stand or go on as
    before; `begun`, the cells whose task began, and `ended`, the tasks that did; `stray_grips`, the arms that
    the plant told to grip though no task of their cell ran; `defied`, what boards began although an
    operator's stop holds; `deeds`: whether any of the first four is not empty. Robots without a virtual
    board are left out.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.arms: dict[str, ArmTruth] = {}
        self.mobiles: dict[str, MobileTruth] = {}
        self.changed: list[RobotTruth] = []
        self.begun: list[CellTruth] = []
        self.ended: list[Ended] = []
        self.stray_grips: list[str] = []
        self.defied: list[tuple[str, Act]] = []
        self.deeds = False
        self.books = Books(world)
        self.stops = Stops(world.model)
        self.parts = Parts()
        self._boards: dict[str, RobotTruth] = {}
        for name in world.model.robots:
            self._add(name)
        self._robots = list(self._boards.values())
        self.cells = {
            cell.name: CellTruth(cell, self.arms.get(cell.arm.name), self.mobiles.get(cell.mobile.name))
            for cell in world.model.cells
        }
        for arm in self.arms.values():
            self.parts.start(arm)
        self.zones = ZonesTruth(world, self.arms, self.mistaken)
        self.boots = Boots(self._boards.values())
        self._deceived: dict[tuple[str, str], float] = {}
        self._sampled_at = -SAMPLE_S
        self._orders: dict[str, Order] = {}
        self._plant = world.plant

    def robot(self, name: str) -> RobotTruth | None:
        """The robot of that name; None where it has no virtual board."""
        return self.arms.get(name) or self.mobiles.get(name)

    def deceived_since(self, board: str, what: str, at: float) -> bool:
        """Whether a board may have lied about something since then."""
        now_so = self.world.deceptions.get((board, what), 0) > 0
        return now_so or self._deceived.get((board, what), -SAMPLE_S) + SAMPLE_S >= at

    def unseen(self, arm: ArmTruth) -> bool:
        """Whether nobody can know where an arm is, as its board says too little.

        At `joints` nothing tells whether what it says is older than its last command, if that took its time,
        and a lie about place or state is all it takes.
        """
        if arm.blind or arm.robot.evidence is not Evidence.JOINTS:
            return arm.blind
        board, now = arm.robot.mqtt, self.world.now
        lies = any(self.deceived_since(board, what, now) for what in ("q", "state"))
        return lies or arm.robot.name in self.books.late

    def mistaken(self, arm: ArmTruth) -> bool:
        """Whether what the plant is told of an arm's place may be wrong: `unseen`, or its board lies."""
        return self.unseen(arm) or self.deceived_since(arm.robot.mqtt, "q", self.world.now)

    def look(self) -> None:
        """Take in what happened in this step; called before any invariant."""
        if self.deeds:
            self._forget()
        if self.world.plant is not self._plant:
            self._new_plant()
        self._look_at_messages()
        self._look_at_robots()
        self._look_at_plant()
        if self.world.model.zones:
            self.zones.look(bool(self.changed))
        self.deeds = bool(self.changed or self.begun or self.ended or self.stray_grips)

    def _look_at_messages(self) -> None:
        """What reached the boards, and what they carry out."""
        moment = self.world.moment
        if moment.published or moment.delivered:
            self._overhear()
        for board, goal in moment.executed:
            self._boards[board].carry_out(goal)
        for board in moment.opened:
            if isinstance(arm := self._boards[board], ArmTruth):
                arm.be_opened(self.world.now)
        for board in moment.put_right:
            self._boards[board].put_right(self.world.now)

    def _look_at_robots(self) -> None:
        """What the robots did; before the plant, which steps after them."""
        self.books.look()
        for booked in self.books.ended:  # whether that is true is judged by the present
            if (robot := self.robot(booked.command.robot)) is not None:
                robot.again = True
        now_us = round(self.world.now * 1e6)
        for robot in self._robots:
            if robot.look(now_us):
                self.changed.append(robot)
        if self.changed:
            self._follow_changes()

    def _look_at_plant(self) -> None:
        """What the plant heard, was deceived about and sent."""
        world, moment = self.world, self.world.moment
        if self.boots.mute:
            self.boots.look(moment.heard, asked=bool(moment.asked))
        if world.deceptions and world.now >= self._sampled_at + SAMPLE_S:
            self._sampled_at = world.now
            self._deceived.update({key: world.now for key, number in world.deceptions.items() if number})
        if moment.sent:
            for message in moment.sent:
                self._take_in(message)
            self.stops.settle()

    def _forget(self) -> None:
        for robot in self.changed:
            robot.forget()
        for cell in self.cells.values():
            cell.switch = None
        self.parts.forget()
        self.changed, self.begun, self.ended, self.stray_grips, self.defied = [], [], [], [], []

    def _add(self, name: str) -> None:
        model, world = self.world.model, self.world
        robot, cell = model.robots[name], model.cell_of[name]
        board, client = world.boards.get(robot.mqtt), world.broker.clients.get(robot.mqtt)
        if board is None or client is None:
            return
        if isinstance(robot, Arm):
            self._boards[robot.mqtt] = self.arms[name] = ArmTruth(robot, cell, board, client)
        elif isinstance(robot, Mobile):
            self._boards[robot.mqtt] = self.mobiles[name] = MobileTruth(robot, cell, board, client)

    def _new_plant(self) -> None:
        """The old one took its books and its tasks with it."""
        self._plant = self.world.plant
        self.books.drop()
        for name, cell in self.cells.items():
            cell.end()
            self.parts.empty(name)

    def _overhear(self) -> None:
        """What our bridge publishes, and what reaches the boards."""
        boards = self._boards
        for client, publication in self.world.moment.published:
            if client == BRIDGE and not publication.topic.endswith(BEATS):
                robot = boards.get(publication.topic.partition("/")[0])
                if robot is not None:
                    robot.expect(publication)
        for client, delivery in self.world.moment.delivered:
            if client in boards and not delivery.topic.endswith(BEATS):
                boards[client].reach(delivery)

    def _follow_changes(self) -> None:
        for robot in self.changed:
            for act in robot.acts:
                if act.starts and self.stops.breaks(robot.robot, act, self.world.now):
                    self.defied.append((robot.robot.name, act))
        for name in dict.fromkeys(robot.cell.name for robot in self.changed):
            cell = self.cells[name]
            cell.look()
            if cell.arm is not None:
                cell.blind = cell.blind or self.unseen(cell.arm)
                self.parts.look(cell, cell.arm)

    def _take_in(self, message: object) -> None:
        if isinstance(message, TaskChanged):
            self._task(message)
        elif isinstance(message, COMMANDS):
            self._command(message)
        elif isinstance(message, OperatorAnswer) and message.refusal is None:
            self._answered(message)
        elif isinstance(message, Remember) and message.fact is Fact.LATCH:
            self.stops.remembered(message)

    def _command(self, command: MoveJoints | FollowPath | SetEffector | Stop | Home) -> None:
        self.books.sent(command)
        self.stops.sent(command, self.world.now)
        grips = isinstance(command, SetEffector) and command.on
        if grips and self.cells[self.world.model.cell_of[command.robot].name].task is None:
            self.stray_grips.append(command.robot)

    def _answered(self, answer: OperatorAnswer) -> None:
        self.stops.answered(answer)
        if answer.verb is Verb.OVERRIDE:
            self.zones.overridden(answer.scope.strip().lower())
        elif answer.verb is Verb.RELEASE:
            for name in robots_of(self.world.model, answer.scope):
                self.cells[self.world.model.cell_of[name].name].released = True

    def _task(self, change: TaskChanged) -> None:
        cell = self.cells.get(change.cell or "")
        if cell is None:
            return
        if change.state is TaskState.RUNNING and change.task == cell.task:
            return  # somebody asked for it again
        if change.state is TaskState.RUNNING:
            cell.begin(change.task, self._order(change.text), self.world.now)
            self.begun.append(cell)
        elif change.task == cell.task and change.state is not TaskState.QUEUED:
            self.ended.append(cell.end(change.text, done=change.state is TaskState.DONE))
            self.parts.empty(cell.cell.name)

    def _order(self, words: str) -> Order:
        if words not in self._orders:
            self._orders[words] = text.parse(words, self.world.model)
        return self._orders[words]
