"""The parts of a plant start in one order, whoever brings them, and end in the opposite one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from arboleda.model.plant_model import Link, PlantModel
from arboleda.plant_file import loader
from arboleda.runtime import holdings
from arboleda.runtime.alarm_options import AlarmOptions
from arboleda.runtime.build import OF_BOARDS, PARTS, Options, build
from arboleda.runtime.demo_options import DemoOptions
from arboleda.store.plant_memory import PlantMemory

ALL = frozenset(PARTS)
SHIPPED, RECORDING = loader.load_recorded()
SHIPPED = SHIPPED.on_boards(Link.DRIVER)
PLANT = ["ReportsPart", "Recorder", "Periodic", "CellTimes", "Orchestrator"]
MADE = ["DraftDesk", "MakeBench", "ProposalDesk"]
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
SHINE = '<root BTCPP_format="4"><BehaviorTree ID="Shine"><lamp_shine/></BehaviorTree></root>'


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


def test_a_plant_with_everything_in_one_process(tmp_path: Path) -> None:
    assert names(tmp_path) == [
        *("OwnBroker", "BridgePart", "DevicesPart"),
        *PLANT,
        *("WebPart", *MADE, "HangUpPart"),
    ]


def test_a_plant_with_ros_has_it_right_after_its_broker(tmp_path: Path) -> None:
    found = names(tmp_path, link=Ros())
    assert found[:3] == ["OwnBroker", "RosPart", "BridgePart"]
    assert found[3:] == ["DevicesPart", *PLANT, "WebPart", *MADE, "HangUpPart"]


@pytest.mark.parametrize(
    ("parts", "expected"),
    [
        ({"bridge"}, ["OtherBroker", "RosPart", "BridgePart"]),
        ({"devices"}, ["OtherBroker", "RosPart", "DevicesPart"]),
        ({"devices", "broker"}, ["OwnBroker", "RosPart", "DevicesPart"]),
        ({"orchestrator"}, ["OtherBroker", "RosPart", *PLANT, "HangUpPart"]),
        ({"orchestrator", "web"}, ["OtherBroker", "RosPart", *PLANT, "WebPart", *MADE, "HangUpPart"]),
    ],
)
def test_a_node_of_ros_has_its_own_parts(tmp_path: Path, parts: set[str], expected: list[str]) -> None:
    assert names(tmp_path, frozenset(parts), link=Ros()) == expected


def test_a_plant_that_keeps_no_record_has_no_reports_and_no_drafts(tmp_path: Path) -> None:
    found = names(tmp_path, recorded=False)
    assert found[3:] == ["Periodic", "CellTimes", "Orchestrator", "WebPart"]


def test_a_demonstration_comes_after_the_page(tmp_path: Path) -> None:
    assert names(tmp_path, of_parts=(DemoOptions(),))[-6:] == ["WebPart", *MADE, "DemoPart", "HangUpPart"]


def test_views_for_other_programs_come_between_the_page_and_a_demonstration(tmp_path: Path) -> None:
    model = replace(SHIPPED, groot2_port=0)
    model = replace(model, opcua_view=SimpleNamespace(port=0, isa95=()))
    found = names(tmp_path, model=model, of_parts=(DemoOptions(),))
    assert found[-5:] == ["ProposalDesk", "Groot2Part", "OpcUaViewPart", "DemoPart", "HangUpPart"]


def test_alarms_start_right_before_the_plant(tmp_path: Path) -> None:
    found = names(tmp_path, of_parts=(AlarmOptions(topic="arboleda/alarms"),))
    assert found[found.index("Orchestrator") - 2 :][:2] == ["CellTimes", "AlarmsPart"]


def test_drivers_start_before_what_keeps_the_plant(tmp_path: Path) -> None:
    (tmp_path / "lab.yaml").write_text(DRIVEN + "uses: [lamps.py, shine.xml]\n", "utf-8")
    (tmp_path / "shine.xml").write_text(SHINE, "utf-8")
    (tmp_path / "lamps.py").write_text(DRIVER, "utf-8")
    model = loader.load(tmp_path / "lab.yaml")
    found = names(tmp_path, ALL - OF_BOARDS, model=model, recorded=False)
    assert found == ["OtherBroker", "DriversPart", "Periodic", "CellTimes", "Orchestrator", "WebPart"]


def test_who_shares_a_memory_keeps_the_lead_before_a_device_is_reached(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    memory_of = holdings.memory_of

    def leased(*about: Any) -> PlantMemory:
        memory = memory_of(*about)
        memory.lead.renew_s = 1.0
        return memory

    monkeypatch.setattr(holdings, "memory_of", leased)
    found = names(tmp_path, of_parts=(DemoOptions(),))
    assert found[:3] == ["OwnBroker", "LeasePart", "BridgePart"]
    assert found[-3:] == ["DemoPart", "CellResumption", "HangUpPart"]


def test_systemd_is_told_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "socket"))
    assert names(tmp_path)[-2:] == ["HangUpPart", "SystemdPart"]
