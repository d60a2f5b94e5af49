"""The firmware's boards as programs on this machine, one process for each SCARA."""

from __future__ import annotations

import logging
import os
import subprocess
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import cast

from arboleda.drivers import Evidence, plain, quoted
from arboleda.extension import StartError
from arboleda.kinds.arm import Arm
from arboleda.model.plant_model import Link, PlantModel
from arboleda.runtime.parts.devices import FirmwareBoards, Survey
from arboleda.runtime.parts.part import Broker, Crash, Part
from arboleda.runtime.registry import Assembly, Factory, Phase
from arboleda.sim.starts import supplies_of
from arboleda.wire.units import to_wire

LOG = logging.getLogger(__name__)
PROGRAM = "ARBOLEDA_BOARD"  # names another program than the checkout's
BUILT = Path(__file__).parents[4] / "firmware" / "build" / "board"
MODEL = "scara"  # what the firmware is built for
END_S = 5.0


def on_linux(model: PlantModel) -> tuple[Arm, ...]:
    """The robots whose boards can be the firmware's; StartError where there is none."""
    arms = [cast(Arm, robot) for robot in model.robots.values() if robot.joints]
    fitting = tuple(arm for arm in arms if arm.model == MODEL and arm.link is Link.MQTT and _speaks_as(arm))
    if not fitting:
        raise StartError(
            "--boards linux: this plant has no scara with link mqtt, evidence ids or joints, and a stop"
        )
    return fitting


def firmware_boards(
    model: PlantModel, broker: Broker, crash: Crash, survey: Survey | None
) -> tuple[list[str], LinuxBoards]:
    """The robots whose boards are the firmware's, and these boards."""
    robots = on_linux(model)
    if broker.secure:
        raise StartError(
            "the firmware's boards speak no TLS: leave out --boards linux, or mqtts:// and --broker-tls"
        )
    return [robot.name for robot in robots], LinuxBoards(model, robots, broker, crash, survey)


def offer(assembly: Assembly) -> Iterator[LinuxBoards]:
    """Offer the firmware's boards, which play the real ones where that is wanted."""
    assembly.offer(FirmwareBoards, firmware_boards)
    yield from ()


FACTORIES = (Factory(phase=Phase.LINKS, make=offer),)


class LinuxBoards:
    """Starts a board for each of the robots, and ends them; one that ends by itself is a crash."""

    def __init__(
        self,
        model: PlantModel,
        robots: Sequence[Arm],
        broker: Broker,
        crash: Crash,
        survey: Survey | None,
    ) -> None:
        self._model = model
        self._robots = tuple(robots)
        self._broker = broker
        self._crash = crash
        self._survey = survey
        self._program = _program()
        self._lookout: Part | None = None
        self._lock = threading.Lock()
        self._stopping = False
        self._running: list[tuple[subprocess.Popen[str], threading.Thread]] = []

    def start(self) -> None:
        """Join the broker; with a `survey`, only after it was seen that no board has these names."""
        if self._survey is None:
            self._join()
            return
        self._lookout = self._survey([robot.mqtt for robot in self._robots], self._join)
        self._lookout.start()

    def stop(self) -> None:
        if self._lookout is not None:
            self._lookout.stop()
        with self._lock:
            self._stopping = True
            running, self._running = self._running, []
        for process, _ in running:
            process.terminate()
        for process, reader in running:
            _end(process)
            reader.join()

    def _join(self) -> None:
        with self._lock:
            if not self._stopping:
                self._running = [self._board(robot) for robot in self._robots]

    def _board(self, robot: Arm) -> tuple[subprocess.Popen[str], threading.Thread]:
        process = subprocess.Popen(
            [self._program, *self._arguments(robot)],
            stdin=subprocess.PIPE,  # its end is the board's, however this process ends
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, **self._login()},
            start_new_session=True,  # Ctrl-C is for the plant, which halts its robots first
        )
        reader = threading.Thread(target=self._listen, args=(robot, process), name=f"board {robot.mqtt}")
        reader.start()
        return process, reader

    def _arguments(self, robot: Arm) -> Iterator[str]:
        cell = self._model.cell_of[robot.name]
        home = cell.reach[robot.name].home
        yield from ("--robot", robot.mqtt, "--broker", str(self._broker.address), "--until-eof")
        yield from ("--level", robot.evidence.value)
        yield f"--at={_pose(robot, home.joints)}"
        for place in dict.fromkeys(pose.joints for pose in supplies_of(cell, robot.name)):
            yield f"--place={_pose(robot, place)}"
        if robot.assume_homed:
            yield "--assume-homed"

    def _login(self) -> dict[str, str]:
        login = self._broker.credentials
        return {"ARBOLEDA_MQTT_USER": login.user, "ARBOLEDA_MQTT_PASSWORD": login.password} if login else {}

    def _listen(self, robot: Arm, process: subprocess.Popen[str]) -> None:
        last_line = ""
        assert process.stderr is not None
        for line in process.stderr:
            last_line = line.strip()
            LOG.debug("%s says: %s", robot.mqtt, plain(last_line))
        process.stderr.close()
        with self._lock:
            stopping = self._stopping
        if not stopping:
            self._crash(
                "linux boards",
                StartError(f"the board of {robot.name} has ended; it said last: {quoted(last_line, 200)}"),
            )


def _speaks_as(arm: Arm) -> bool:
    return arm.evidence in (Evidence.IDS, Evidence.JOINTS) and arm.has_stop


def _program() -> str:
    program = Path(os.environ.get(PROGRAM, BUILT))
    if not os.access(program, os.X_OK):
        raise StartError(f"the firmware's board is not at {program}; type: make firmware")
    return str(program)


def _pose(robot: Arm, q: tuple[float, ...]) -> str:
    return ",".join(repr(to_wire(joint, value)) for joint, value in zip(robot.joints, q, strict=True))


def _end(process: subprocess.Popen[str]) -> None:
    try:
        process.wait(END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    if process.stdin is not None:
        process.stdin.close()
