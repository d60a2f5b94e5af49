"""Robots that get the firmware's board, and the name of its program."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from arboleda.adapters.broker_login import Address, Credentials
from arboleda.model.errors import StartError
from arboleda.model.plant_model import Evidence, Link, PlantModel
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda_boards.linux_boards import LinuxBoards, on_linux


class Broker:
    """Broker to which the boards are sent."""

    address = Address(host="127.0.0.1", port=1884)
    credentials: Credentials | None = None


def test_every_scara_and_nobody_else_has_the_firmwares_board() -> None:
    assert [robot.name for robot in on_linux(shipped())] == ["ra1", "ra2"]


@pytest.mark.parametrize(
    "plant",
    [
        shipped("sis_c"),
        shipped("sis_a", evidence=Evidence.STATE),
        shipped("sis_a", has_stop=False),
        shipped("sis_a", link=Link.ROS),
    ],
    ids=["a CR10A", "codes only", "no stop", "on ROS"],
)
def test_a_plant_without_one_is_refused(plant: PlantModel) -> None:
    with pytest.raises(StartError, match="no scara"):
        on_linux(plant)


def test_a_board_is_told_where_its_arm_stands_and_parts_lie(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    program = tmp_path / "board"
    program.touch(mode=0o755)
    monkeypatch.setenv("ARBOLEDA_BOARD", str(program))
    plant = shipped("sis_a", evidence=Evidence.JOINTS)
    robot = replace(StorageLayout(plant.cell("sis_a")).arm, assume_homed=True)
    boards = LinuxBoards(plant, [robot], Broker(), lambda *_: None, None)
    assert list(boards._arguments(robot)) == [
        *("--robot", "ra_1", "--broker", "127.0.0.1:1884", "--until-eof", "--level", "joints"),
        "--at=0.0,0.0,0.0",
        *("--place=45.0,10.0,0.0", "--place=44.09,0.9,0.0", "--place=54.7,-0.9,0.0"),
        "--assume-homed",
    ]


def test_a_program_that_is_not_there_names_the_command(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("ARBOLEDA_BOARD", str(tmp_path / "board"))
    with pytest.raises(StartError, match="type: make firmware"):
        LinuxBoards(shipped("sis_a"), [], Broker(), lambda *_: None, None)
