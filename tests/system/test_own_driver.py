"""The example with a driver of its own, as it is typed: against its virtual controller, and without one."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.system

EXAMPLE = Path(__file__).parents[2] / "examples/own_driver"


@pytest.fixture
def plant(tmp_path: Path, free_port: int) -> tuple[str, int]:
    """The plant file with a port of the test's own."""
    for name in ("recipes.py", "drivers/line_tcp.py", "plant.yaml"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        text = (EXAMPLE / name).read_text("utf-8")
        (tmp_path / name).write_text(text.replace("port: 4711", f"port: {free_port}"), "utf-8")
    return str(tmp_path / "plant.yaml"), free_port


def test_the_press_works_behind_its_driver(
    start: Callable[..., Any], arboleda: Callable[..., Any], plant: tuple[str, int]
) -> None:
    file, port = plant
    controller = start(sys.executable, str(EXAMPLE / "controller.py"), "--port", str(port))
    controller.wait_for("the press listens on port")
    run = arboleda("run", "shop form 2", "--plant", file, "--boards", "real", "--no-ros")
    assert run.wait() == 0, run.output
    assert "done      shop 2" in run.output and "simulated" not in run.output


def test_a_controller_that_ends_at_work_fails_the_task_with_the_reason(
    start: Callable[..., Any], arboleda: Callable[..., Any], plant: tuple[str, int]
) -> None:
    file, port = plant
    controller = start(sys.executable, str(EXAMPLE / "controller.py"), "--port", str(port))
    controller.wait_for("the press listens on port")
    up = arboleda("up", "shop form 3", "--plant", file, "--boards", "real", "--no-ros")
    up.wait_for("press press 3")
    controller.kill()
    up.wait_for("the link was lost while doing")
    assert up.interrupt() == 0, up.output
    assert "Traceback" not in up.output


def test_a_controller_that_is_not_there_is_named_after_a_time(
    arboleda: Callable[..., Any], plant: tuple[str, int]
) -> None:
    real = ("run", "shop form 2", "--plant", plant[0], "--boards", "real", "--no-ros")
    run = arboleda(*real, "--wait-for-devices", "1")
    assert run.wait() == 1, run.output
    assert f"  press is offline: 127.0.0.1:{plant[1]}: " in run.output
    assert "After 1 s no task can begin" in run.output and "cancelled shop 2" in run.output
    assert "Traceback" not in run.output


def test_ctrl_c_ends_the_wait_for_a_controller(arboleda: Callable[..., Any], plant: tuple[str, int]) -> None:
    run = arboleda(
        "run", "shop form 2", "--plant", plant[0], "--boards", "real", "--no-ros", "--wait-for-devices", "900"
    )
    run.wait_for("queued    shop 2")
    assert run.interrupt() == 1, run.output
    assert "cancelled shop 2" in run.output and "After 900 s" not in run.output


def test_without_real_boards_the_press_is_simulated(
    arboleda: Callable[..., Any], plant: tuple[str, int]
) -> None:
    run = arboleda("run", "shop form 1", "--plant", plant[0], "--rate", "10", "--no-ros")
    assert run.wait() == 0, run.output
    assert "press: simulated; with --boards real their drivers reach them" in run.output


OBEDIENT = """\
import threading
from dataclasses import replace

from arboleda.drivers import FollowPath, MotionState, MoveJoints, Report, SetEffector, driver


@driver("obedient")
class Obedient:
    \"\"\"Robots that have done what they are told as soon as they hear it.\"\"\"

    def start(self, devices, hear, clock):
        self.hear, self.clock, self.over = hear, clock, threading.Event()
        still = {"at": 0.0, "state": MotionState.STOPPED, "homed": True, "boot_id": 1}
        self.said = {
            each.name: Report(robot=each.name, q=each.reference, effector=False, **still)
            if each.joints
            else Report(robot=each.name, node=0, **still)
            for each in devices
        }
        self.thread = threading.Thread(target=self.tell)
        self.thread.start()

    def tell(self):
        while not self.over.wait(0.1):
            for name in self.said:
                self.say(name)

    def say(self, name, **news):
        self.said[name] = replace(self.said[name], at=self.clock(), **news)
        self.hear(self.said[name])

    def send(self, command):
        news = {"accepted": command.id}
        if isinstance(command, MoveJoints):
            news |= {"q": command.q, "done": command.id}
        elif isinstance(command, FollowPath):
            news |= {"node": command.nodes[-1], "done": command.id}
        elif isinstance(command, SetEffector):
            news |= {"effector": command.on}
        self.say(command.robot, **news)

    def stop(self):
        self.over.set()
        self.thread.join()
"""
STORAGE = """\
name: racks
uses: [obedient.py]
paths: {0B: [0, 3, 4, 7]}
stations: {0: {deg: [20, 10], mm: 50}}
cells:
  sis_a:
    arm: {name: ra1, model: scara, driver: obedient, evidence: ids}
    mobile: {name: rm1, driver: obedient, evidence: ids}
    home: {deg: [0, 0], mm: 0}
    pickup: {deg: [45, 10], mm: 0}
"""


def test_a_part_is_stored_by_robots_behind_a_driver(tmp_path: Path, arboleda: Callable[..., Any]) -> None:
    (tmp_path / "obedient.py").write_text(OBEDIENT, "utf-8")
    (tmp_path / "plant.yaml").write_text(STORAGE, "utf-8")
    file = str(tmp_path / "plant.yaml")
    run = arboleda("run", "sis_a 0B 0", "--plant", file, "--boards", "real", "--no-ros")
    assert run.wait() == 0, run.output
    assert "done      sis_a 0B 0" in run.output and "simulated" not in run.output
