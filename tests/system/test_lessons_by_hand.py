"""The tutorial's second terminal: what a person types there is done while the first one runs.

The commands `ros2` and `mosquitto_*` come from elsewhere and may not be installed: rclpy and paho say
here, on the same topics, what those would.
"""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
import time
from array import array
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import pytest
import yaml
from paho.mqtt.client import Client
from paho.mqtt.enums import CallbackAPIVersion

from ..patience import PATIENCE_S
from .conftest import paths

pytestmark = pytest.mark.system

ROOT = Path(__file__).parents[2]


def terminals(page: str) -> tuple[str, list[str]]:
    """The command of the first terminal, and those of the second."""
    text = (ROOT / "docs" / "tutorial" / f"{page}.md").read_text("utf-8")
    first, second = re.findall(r"^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)
    return first.strip(), second.strip().splitlines()


def as_installed(command: str) -> str:
    """The command with the Python of the tests, where a person has .venv."""
    programs = {"python": "", "arboleda": " -c 'from arboleda.cli.main import main; main()'"}
    return re.sub(r"\.venv/bin/(\w+)", lambda found: f"{sys.executable}{programs[found[1]]}", command)


@pytest.fixture
def first(start: Callable[..., Any], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[..., Any]:
    """`first(command)`: the first terminal, in the folder of the repository."""
    monkeypatch.setenv("PYTHONPATH", paths())
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    monkeypatch.chdir(ROOT)
    return lambda command: start(*shlex.split(as_installed(command)))


@pytest.mark.requires("rclpy")
def test_the_ros_2_robots_are_driven_by_hand(first: Callable[..., Any], observer: Any) -> None:
    command, typed = terminals("07_ros2_cell")
    told = {"path_cmd": "rm_sis_a stands still", "joint_goals_q": "ra1 stands still"}
    shell = first(command)
    shell.wait_for("Drive them by hand")
    for line in typed:
        words = shlex.split(line.removesuffix("&"))
        assert words[:2] == ["ros2", "topic"], line
        topic = words[4] if words[2] == "pub" else words[3]
        if words[2] == "echo":
            echo(observer, topic)
            continue
        assert words[2:4] == ["pub", "--once"], line
        before = shell.output.count(told.get(topic.split("/")[-1], "nothing"))
        publish(observer, topic, words[5], yaml.safe_load(words[6]))
        if topic.split("/")[-1] in told:
            shell.wait_for(told[topic.split("/")[-1]], times=before + 1)
    assert "rm_sis_a moves" in shell.output and shell.output.count("ra1 moves") == 2
    assert shell.interrupt() == 0, shell.output


def echo(observer: Any, topic: str) -> None:
    from sensor_msgs.msg import JointState

    observer.listen(JointState, topic)
    observer.wait(lambda: observer.heard[topic], f"nobody speaks on {topic}")


def publish(observer: Any, topic: str, kind: str, fields: dict[str, Any]) -> None:
    """What `ros2 topic pub --once` does."""
    package, _, name = kind.split("/")
    message = getattr(__import__(f"{package}.msg", fromlist=[name]), name)()
    for key, value in fields.items():
        setattr(message, key, array("f", value) if isinstance(value, list) else value)
    observer.publisher(type(message), topic).publish(message)


class Wire:
    """An MQTT client that keeps what it hears."""

    def __init__(self, port: int) -> None:
        self.heard: SimpleQueue[tuple[str, bytes]] = SimpleQueue()
        self.client = Client(CallbackAPIVersion.VERSION2)
        self.client.on_message = lambda _client, _data, said: self.heard.put((said.topic, said.payload))
        self.client.connect("127.0.0.1", port)
        self.client.loop_start()

    def wait(self, topic: str, arrived: Callable[[Any], object]) -> None:
        while True:
            heard, payload = self.heard.get(timeout=PATIENCE_S)
            if heard == topic and arrived(json.loads(payload)):
                return

    def close(self) -> None:
        self.client.disconnect()
        self.client.loop_stop()


@pytest.fixture
def wire(free_port: int) -> Iterator[Callable[[], Wire]]:
    made: list[Wire] = []

    def go() -> Wire:
        made.append(Wire(free_port))
        return made[-1]

    yield go
    for each in made:
        each.close()


def test_a_board_is_spoken_to_by_hand(
    first: Callable[..., Any], wire: Callable[[], Wire], free_port: int
) -> None:
    command, typed = terminals("09_mqtt_board")
    shell = first(f"{command} --port {free_port}")
    shell.wait_for("is on the broker")
    hand = wire()
    for line in typed:
        program, *words = shlex.split(line.removesuffix("&"))
        assert words[:2] == ["-p", "1883"], line
        given = dict(pairwise(words))
        if program == "mosquitto_sub":
            hand.client.subscribe(given["-t"])
            hand.wait("ra_1/sensores", lambda said: said["estado"] == 0)
            continue
        assert program == "mosquitto_pub", line
        hand.client.publish(given["-t"], given["-m"], qos=1)
        number = json.loads(given["-m"])["seq"]
        hand.wait("ra_1/sensores", lambda said, number=number: said.get("ack") == number)
    hand.wait("ra_1/sensores", lambda said: said.get("hecho") == 5 and said["estado"] == 0)
    assert shell.interrupt() == 0, shell.output


@pytest.mark.requires("rclpy")
def test_the_whole_plant_runs_over_ros_2_too(first: Callable[..., Any], ros_domain: int) -> None:
    shell = first(".venv/bin/python examples/10_plant.py --ros --rate 4")
    shell.wait_for("So it ended: lot1 done, lot2 done, lot3 failed, lot4 done, lot5 done")
    assert shell.wait() == 0, shell.output


def test_a_running_plant_is_looked_at_and_operated(first: Callable[..., Any], tmp_path: Path) -> None:
    command, typed = terminals("10_plant")
    more = '"sis_a 0B 8" "sis_a 0B 1"'  # still at work where each command takes ten seconds
    shell = first(f"{command} {more} --rate 0.1")
    shell.wait_for("running")
    *before, resume = typed
    printed = [second_terminal(line, tmp_path) for line in before]
    wait_until_held(typed[0], tmp_path)
    printed.append(second_terminal(resume, tmp_path))
    status, tree, png, submitted, held, resumed = printed
    assert "0B 7" in status and "sis_b" in status
    assert tree.startswith("{o} storage [*]") and "drive path 0B" in tree
    assert png == "" and (tmp_path / "live.png").read_bytes().startswith(b"\x89PNG")
    assert submitted.startswith(("queued", "running"))
    assert held == "done: hold, sis_a\n" and resumed == "done: resume, sis_a\n"
    assert shell.interrupt() == 0, shell.output


def wait_until_held(status: str, folder: Path) -> None:
    """What a person does who reads the table until the robot has stopped."""
    until = time.monotonic() + PATIENCE_S
    while "held" not in second_terminal(status, folder):
        assert time.monotonic() < until, "the cell is never held"


def second_terminal(command: str, folder: Path) -> str:
    """What a command prints; what it writes goes to `folder`."""
    plant = str(ROOT / "examples" / "plants" / "lessons.yaml")
    words = as_installed(command).replace("examples/plants/lessons.yaml", plant)
    ran = subprocess.run(
        words, shell=True, cwd=folder, capture_output=True, text=True, timeout=PATIENCE_S, check=False
    )
    assert ran.returncode == 0, ran.stderr
    return ran.stdout
