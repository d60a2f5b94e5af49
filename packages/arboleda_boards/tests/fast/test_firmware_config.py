"""The header that has the firmware play a declared device: what is written, mistakes with their lines."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.kinds.declared import Device
from arboleda.model.errors import ConfigError
from arboleda.plant_file.loader import load
from arboleda_boards.firmware_config.header import header
from arboleda_boards.firmware_config.resolving import tables
from arboleda_boards.firmware_config.tables import Tables

ROOT = Path(__file__).parents[4]
PRESS = ROOT / "examples/press_board"
WIRING = (PRESS / "press.wiring.yaml").read_text()
WRITTEN = [
    ("press", "examples/press_board/plant.yaml", PRESS / "press.wiring.yaml", "esp32/src/device_config.h"),
    (
        "valve",
        "examples/own_board/plant.yaml",
        ROOT / "firmware/test/valve.wiring.yaml",
        "test/valve_config.h",
    ),
]


@cache
def device(plant: str, name: str) -> Device:
    found = load(ROOT / plant).robots[name]
    assert isinstance(found, Device)
    return found


@pytest.mark.parametrize(("name", "plant", "wiring", "written"), WRITTEN)
def test_the_firmwares_headers_are_what_the_command_writes(
    name: str, plant: str, wiring: Path, written: str
) -> None:
    assert (ROOT / "firmware" / written).read_text() == header(tables(device(plant, name), wiring))


def read(text: str, folder: Path) -> Tables:
    path = folder / "w.yaml"
    path.write_text(text)
    return tables(device("examples/press_board/plant.yaml", "press"), path)


def changed(*replacements: tuple[str, str]) -> str:
    text = WIRING
    for old, new in replacements:
        assert old in text
        text = text.replace(old, new, 1)
    return text


MISTAKES = [
    ("pin: 34, active", "pin: 35, active", "inputs.gate_down.pin: pin 35 is gate_up already"),
    ("pin: 25", "pin: 34", "pin 34 can only be an input; outputs: 4, 13, 14"),
    ("pin: 25", "pin: 12", "pin 12 is read, and may be driven, at boot"),
    ("pin: 25", "pin: 7", "pin 7 belongs to the flash memory"),
    ("pin: 25", "pin: 1", "pin 1 is the serial console"),
    ("pin: 25", "pin: 77", "outputs.clamp.pin: must be at most 39"),
    ("pressure: {pin: 33", "pressure: {pin: 13", "pin 13 cannot measure while Wi-Fi is on"),
    ("on_above: 4.2, ", "", "inputs.at_force: needs on_above and off_below"),
    (
        "analog: pressure, on",
        "analog: presure, on",
        'there is no analog input "presure"; did you mean "pressure"?',
    ),
    ("degrees: [0, 90]", "degrees: [90, 0]", "degrees go from less to more"),
    (", else: between}", "}", 'no word fits some states of its inputs; add "else"'),
    ("else: between", "else: betwen", 'there is no value "betwen"; did you mean "between"?'),
    ("open: {gate_up: on}", "open: {gate_upp: on}", 'there is no input "gate_upp"'),
    ("gate:    {open", "gatter:  {open", 'there is no fact of a press "gatter"'),
    ("part:    {input: part_in}", "part:    {analog: pressure}", "an analog input says a number"),
    (
        "gate:    {open: {gate_up: on}, closed: {gate_down: on}, else: between}",
        "gate: {input: gate_up}",
        "bool",
    ),
    ("  part:    {input: part_in}\n", "", "part is missing: each fact of a press is wired"),
    ("  relieve: {start: {relief: on}}\n", "", "relieve is missing: each verb of a press is wired"),
    ("open:    {start: {gate: 90}}", "open:    {start: {gate: 91}}", "must be degrees from 0 to 90, is 91"),
    ("{start: {clamp: $on}}", "{start: {clamp: $off}}", 'there is no value "$off"; there are: $on'),
    ("{start: {clamp: $on}}", "{start: {gate: 0}}", "only a motion or a process starts it"),
    ("{start: {clamp: $on}}", "{start: {clamp: 3}}", "an output is on or off, not 3"),
    ("relief: on}}", "relieff: on}}", 'there is no output or servo "relieff"; did you mean "relief"?'),
    ("look:    {answers", "look:    {start: {pump: on}, answers", "a query moves nothing"),
    ("{start: {relief: on}}", "{start: {relief: on}, answers: {else: present}}", "only a query is answered"),
    (
        "{start: {relief: on}}",
        "{start: {relief: on}, at_least_s: 6}",
        "at_least_s is 6, and its kind gives it up after 5 s",
    ),
    (
        "pressed: {input: at_force}",
        "pressed: {analog: pressure}",
        "no measured number is ever exactly the pressed",
    ),
    ("debounce_ms: 30", "debounce: 30", 'the key "debounce" is not known; did you mean "debounce_ms"?'),
]


@pytest.mark.parametrize(("old", "new", "sentence"), MISTAKES)
def test_a_mistake_is_told_with_its_line(old: str, new: str, sentence: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigError) as refused:
        read(changed((old, new)), tmp_path)
    told = [problem for problem in refused.value.problems if sentence in problem]
    assert told, refused.value.problems
    assert told[0].startswith(f"{tmp_path / 'w.yaml'}:")


def test_each_value_of_a_parameter_can_drive_something_of_its_own(tmp_path: Path) -> None:
    made = read(
        changed(("relief: off, pump: on}", 'relief: off, gate: {$program: {"1": 10, "2": 20}}}')), tmp_path
    )
    assert made.verbs[3].start[1].value.map == (10.0, 20.0)
    assert "20.0" in header(made)


def test_a_value_that_is_left_out_of_a_parameter_is_named(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"must have exactly 1, 2"):
        read(changed(("relief: off, pump: on}", 'relief: off, pump: {$program: {"1": on}}}')), tmp_path)


def test_what_no_input_looks_at_is_said_when_the_header_is_written(tmp_path: Path) -> None:
    into = tmp_path / "made.h"
    words = ["firmware-config", "press_1", str(PRESS / "press.wiring.yaml"), "-o", str(into)]
    run = CliRunner().invoke(cli, [*words, "--plant", str(PRESS / "plant.yaml")])
    assert run.exit_code == 0, run.output
    assert "program is said as it was told; no input looks at it, so it proves nothing" in run.output
    assert "clamped is said" not in run.output
    assert into.read_text().startswith("// press_1, written by")


def test_a_robot_that_is_no_declared_device_is_refused(tmp_path: Path) -> None:
    run = CliRunner().invoke(cli, ["firmware-config", "ra1", str(PRESS / "press.wiring.yaml")])
    assert run.exit_code == 2
    assert "'ra1' is no device of a declared kind" in " ".join(run.output.replace("│", " ").split())
