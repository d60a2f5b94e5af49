"""Boards that speak MQTT at evidence `ids`; a move is over when its time is, and every moment is kept.

They obey, acknowledge and report as the contract wants it, and simulate no motor: what is measured is the
chain behind them.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import count

from arboleda.adapters.broker_login import Address
from arboleda.adapters.mqtt import MqttClient
from arboleda.drivers import Command, FollowPath, MotionState, MoveJoints, Robot, SetEffector
from arboleda.kinds.arm import Arm
from arboleda.kinds.mobile import Mobile
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire.payloads import (
    EffectorGoal,
    Goal,
    JointsGoal,
    PathGoal,
    Presence,
    StopGoal,
    Telemetry,
    decode,
    encode,
)
from arboleda.wire.topics import Channel, parse, topic
from arboleda.wire.transport import Connection, Delivery, Publication
from arboleda.wire.units import from_wire

from . import steps
from .clockwork import Clockwork, now
from .moments import Moment

DECLARED = {"link": "mqtt", "evidence": "ids"}  # what the plant file says of them
TELEMETRY_S = 0.1
COMMANDS = (Channel.JOINTS, Channel.PATH, Channel.EFFECTOR, Channel.STOP)


class Boards:
    """All boards of a plant behind one MQTT client; `moments` has what happened in each cell, in order."""

    def __init__(self, model: PlantModel, broker: Address, move_s: Callable[[], float]) -> None:
        self.moments: dict[str, list[Moment]] = {cell.name: [] for cell in model.cells}
        self._clockwork = Clockwork()
        self._boards = {
            robot.mqtt: Board(robot, cell, self._clockwork, move_s, self._say, self.moments[cell.name])
            for cell in model.cells
            for robot in cell.robots
        }
        topics = [topic(name, channel) for name in self._boards for channel in COMMANDS]
        self._client = MqttClient(
            "bench_boards", broker, on_event=self._note, subscriptions=topics, clock=now
        )

    @property
    def missing(self) -> list[str]:
        """Nothing, ever: a task waits anyway until its robots are heard."""
        return []

    def start(self) -> None:
        self._clockwork.start()
        self._client.start()

    def stop(self) -> None:
        self._clockwork.stop()
        self._client.close()

    def _say(self, publication: Publication) -> None:
        self._client.publish(publication)

    def _note(self, event: Delivery | Connection) -> None:
        if isinstance(event, Delivery):
            name, channel = parse(event.topic)
            self._boards[name].obey(event.at, channel, event.payload)
        elif event.up:
            for board in self._boards.values():
                board.appear()
                self._clockwork.every(TELEMETRY_S, board.tell)


class Board:
    """One board: it acknowledges a command, moves for `move_s()`, and is at its goal then."""

    def __init__(
        self,
        robot: Robot,
        cell: Cell,
        clockwork: Clockwork,
        move_s: Callable[[], float],
        say: Callable[[Publication], None],
        moments: list[Moment],
    ) -> None:
        self._robot = robot
        self._layout = StorageLayout(cell)
        self._clockwork = clockwork
        self._move_s = move_s
        self._say = say
        self._moments = moments
        self._axes = len(robot.joints) if isinstance(robot, Arm) else None
        self._number = count(1)
        self._moving: Goal | None = None
        self._q = (0.0,) * self._axes if self._axes else None
        self._node = cell.paths[steps.PATH].nodes[-1] if isinstance(robot, Mobile) else None
        self._effector = False if self._axes else None
        self._epoch: int | None = None
        self._ack: int | None = None
        self._done: int | None = None

    def appear(self) -> None:
        """Take in that its client is connected."""
        present = topic(self._robot.mqtt, Channel.PRESENCE)
        self._say(Publication(topic=present, payload=encode(Presence(online=True)), retain=True))

    def tell(self) -> None:
        """Publish telemetry."""
        self._say(self._telemetry())

    def obey(self, at: float, channel: Channel, payload: bytes) -> None:
        """Carry out one command, received at `at`."""
        goal = decode(channel, payload, axes=self._axes)
        if isinstance(goal, StopGoal):
            self._moving = None
            self.tell()
            return
        assert isinstance(goal, JointsGoal | PathGoal | EffectorGoal)
        self._moments.append(Moment(at=at, command=self._command(goal), ended=False))
        self._epoch, self._ack = goal.epoch, goal.seq
        if isinstance(goal, EffectorGoal):
            self._effector = goal.on
        else:
            self._moving = goal
            self._clockwork.after(self._move_s() - (now() - at), lambda: self._arrive(goal))
        self.tell()

    def _arrive(self, goal: JointsGoal | PathGoal) -> None:
        if self._moving is not goal:
            return
        self._moving, self._done = None, goal.seq
        if isinstance(goal, JointsGoal):
            self._q = goal.q_deg
        else:
            self._node = goal.nodes[-1]
        command, telemetry = self._command(goal), self._telemetry()
        home = isinstance(command, MoveJoints) and self._layout.arm.motion.reached(
            command.q, self._layout.home.joints
        )
        self._moments.append(Moment(at=now(), command=command, ended=True, last=home))
        self._say(telemetry)

    def _telemetry(self) -> Publication:
        said = Telemetry(
            state=MotionState.MOVING if self._moving else MotionState.STOPPED,
            q_deg=self._q,
            node=self._node,
            seq=next(self._number),
            ack_epoch=self._epoch,
            ack=self._ack,
            done=self._done,
            boot_id=1,
            homed=True,
            effector=self._effector,
        )
        return Publication(topic=topic(self._robot.mqtt, Channel.TELEMETRY), payload=encode(said), qos=0)

    def _command(self, goal: JointsGoal | PathGoal | EffectorGoal) -> Command:
        """The command of the plant that led to this goal."""
        id, robot = f"{goal.epoch}-{goal.seq}", self._robot
        if isinstance(goal, EffectorGoal):
            return SetEffector(id=id, robot=robot.name, on=goal.on)
        if isinstance(goal, PathGoal):
            return FollowPath(id=id, robot=robot.name, nodes=goal.nodes)
        assert isinstance(robot, Arm)
        rows = zip(robot.joints, goal.q_deg, strict=True)
        return MoveJoints(id=id, robot=robot.name, q=tuple(from_wire(joint, value) for joint, value in rows))
