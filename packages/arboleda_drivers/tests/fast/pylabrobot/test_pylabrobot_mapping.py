"""Mappings of PyLabRobot in a plant file: what is wrong is told with its place and what to write."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.packages import ROOT

from arboleda.model.errors import ConfigError
from arboleda.plant_file.loader import load

EXAMPLE = ROOT / "examples/plate_bench"
CELSIUS = "celsius: {read: get_temperature(), near: 0.5, otherwise: 0}"
SHAKE = "shake: {calls: [{call: shake, arguments: {speed: $rpm, duration: $seconds}}]}"


@pytest.mark.sampled(10)
@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (CELSIUS, "warmth: {read: get_temperature()}", "a hotplate has no fact warmth; there are celsius"),
        (CELSIUS, "celsius: {near: 0.5}", "read is missing: say where the machine shows it"),
        (CELSIUS, "celsius: {read: a b}", "a b is no path; write it as head[0].has_tip"),
        (CELSIUS, "celsius: {read: t, otherwise: 5}", "5 is none of its values; allowed: 0, 37, 60"),
        (CELSIUS, "celsius: {read: t, words: {37: [9, 1]}}", "37 needs its least and its greatest value"),
        (SHAKE, "", "shake of a hotplate is missing: say what is called for it"),
        (SHAKE, "shake: {}", "nothing is called for shake; write calls"),
        ("$rpm", "$speed", "shake has no parameter speed; there are rpm, seconds"),
        ("call: shake,", "call: shake(),", "shake() is no method; write it as set_temperature"),
        ("halt: [{call: stop_shaking}, {call: deactivate}]", "poll_s: 1.0", "heat could not be stopped"),
        ("setup_again: true", "timeout_s: 0.1", "timeout_s is 0.1; allowed: 0.5 to 60"),
    ],
)
def test_what_is_wrong_is_told(tmp_path: Path, old: str, new: str, told: str) -> None:
    for file in EXAMPLE.glob("*.py"):
        (tmp_path / file.name).write_text(file.read_text("utf-8"), "utf-8")
    text = (EXAMPLE / "bench.yaml").read_text("utf-8")
    assert old in text
    changed = text.replace(old, new).replace("cancels: true", "cancels: false")
    (tmp_path / "bench.yaml").write_text(changed, "utf-8")
    with pytest.raises(ConfigError) as error:
        load(tmp_path / "bench.yaml")
    assert told in str(error.value)
