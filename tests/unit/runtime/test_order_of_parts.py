"""The parts of a plant start in one order, whoever brings them, and end in the opposite one."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from tests.added_package import install
from tests.packages import PACKAGES, leave_out

from arboleda.model.plant_model import Link, PlantModel
from arboleda.plant_file import loader
from arboleda.runtime.alarm_options import AlarmOptions
from arboleda.runtime.build import OF_BOARDS, PARTS, Options, build

ALL = frozenset(PARTS)
SHIPPED, RECORDING = loader.load_recorded()
SHIPPED = SHIPPED.on_boards(Link.DRIVER)
PLANT = ["Recorder", "Periodic", "Orchestrator"]
IN_EACH_PHASE = """
from arboleda.runtime.registry import Factory, Phase


def factory(phase):
    kind = type(phase.name.title(), (), {"start": lambda self: None, "stop": lambda self: None})
    return Factory(phase=phase, make=lambda assembly: [kind()])


PARTS = [factory(each) for each in Phase]
"""
DRIVEN = """name: lab
kinds:
  lamp: {facts: {lit: bool}, verbs: {shine: {effect: switch, sets: {lit: true}}}}
cells:
  bench:
    devices:
      lamp: {kind: lamp, driver: lamps}
"""
DRIVER = """
from arboleda.drivers import driver


@driver("lamps")
class Lamps:
    def start(self, reports): ...
    def send(self, command): ...
    def stop(self): ...
"""
SHINE = """
from arboleda.recipes import recipe


@recipe("shine")
def shine(cell):
    return cell.device("lamp").shine()
"""


class Ros:
    """A link to ROS 2 that reaches nobody."""

    notes = ("ROS 2: nobody",)
    log = None

    def bridge(self, *_: object) -> Any:
        return SimpleNamespace(send=None, mqtt_link=None, tell=None)

    def orchestrator(self, *_: object) -> Any:
        return SimpleNamespace()


def names(
    tmp_path: Path,
    parts: frozenset[str] = ALL,
    *,
    model: PlantModel | None = None,
    recorded: bool = True,
    **options: Any,
) -> list[str]:
    """The kinds of the parts of a plant, in the order in which they start."""
    wanted = replace(RECORDING, virtual=True) if recorded and RECORDING else None
    chosen = Options(state_dir=tmp_path / "state", page=False, recording=wanted, **options)
    app = build(model or SHIPPED, parts, chosen)
    app.stop()
    return [type(each).__name__ for each in app.parts]


@pytest.fixture
def alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No package beside the runner is installed."""
    leave_out(monkeypatch, tmp_path / "site", *PACKAGES)


pytestmark = pytest.mark.usefixtures("alone")


def test_a_plant_with_everything_in_one_process(tmp_path: Path) -> None:
    assert names(tmp_path) == ["OwnBroker", "BridgePart", "DevicesPart", *PLANT, "WebPart"]


def test_in_each_phase_the_parts_of_a_package_come_after_those_of_the_runner(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "socket"))
    install(tmp_path / "site", "everywhere", IN_EACH_PHASE)
    try:
        found = names(tmp_path, of_parts=(AlarmOptions(topic="arboleda/alarms"),))
    finally:
        sys.modules.pop("everywhere", None)
    assert found == [
        *("OwnBroker", "Links", "BridgePart", "DevicesPart", "Devices", "Reports"),
        *("Recorder", "Periodic", "Record", "AlarmsPart", "Alarms", "Orchestrator", "Plant"),
        *("WebPart", "Page", "Views", "After", "SystemdPart", "Ready"),
    ]


def test_a_plant_with_ros_has_it_right_after_its_broker(tmp_path: Path) -> None:
    found = names(tmp_path, link=Ros())
    assert found == ["OwnBroker", "RosPart", "BridgePart", "DevicesPart", *PLANT, "WebPart"]


@pytest.mark.parametrize(
    ("parts", "expected"),
    [
        ({"bridge"}, ["OtherBroker", "RosPart", "BridgePart"]),
        ({"devices"}, ["OtherBroker", "RosPart", "DevicesPart"]),
        ({"devices", "broker"}, ["OwnBroker", "RosPart", "DevicesPart"]),
        ({"orchestrator"}, ["OtherBroker", "RosPart", *PLANT]),
        ({"orchestrator", "web"}, ["OtherBroker", "RosPart", *PLANT, "WebPart"]),
    ],
)
def test_a_node_of_ros_has_its_own_parts(tmp_path: Path, parts: set[str], expected: list[str]) -> None:
    assert names(tmp_path, frozenset(parts), link=Ros()) == expected


def test_alarms_start_right_before_the_plant(tmp_path: Path) -> None:
    found = names(tmp_path, of_parts=(AlarmOptions(topic="arboleda/alarms"),))
    assert found[found.index("Orchestrator") - 1] == "AlarmsPart"


def test_drivers_start_before_what_keeps_the_plant(tmp_path: Path) -> None:
    (tmp_path / "lab.yaml").write_text(DRIVEN + "uses: [lamps.py, shine.py]\n", "utf-8")
    (tmp_path / "shine.py").write_text(SHINE, "utf-8")
    (tmp_path / "lamps.py").write_text(DRIVER, "utf-8")
    model = loader.load(tmp_path / "lab.yaml")
    found = names(tmp_path, ALL - OF_BOARDS, model=model, recorded=False)
    assert found == ["OtherBroker", "DriversPart", "Periodic", "Orchestrator", "WebPart"]


def test_systemd_is_told_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "socket"))
    assert names(tmp_path)[-1] == "SystemdPart"
