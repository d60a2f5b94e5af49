"""A record as `rerun` reads it, a program of others for MCAP files of robots: closed, and made whole."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from arboleda.recorder import copying, reader

from ..unit.recorder.recorded import Site, with_everything

pytestmark = pytest.mark.requires("rerun_cli")


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Site:
    made = with_everything(tmp_path, monkeypatch)
    made.work("sis_a 0B 7", "sis_b 1C 3", s=40.0)
    made.end()
    return made


def rerun(folder: Path, *words: str) -> str:
    """What it prints; it succeeds, and tells nobody that it was used."""
    here = {**os.environ, "HOME": str(folder), "XDG_CONFIG_HOME": str(folder), "NO_COLOR": "1"}
    for command in (("analytics", "disable"), words):
        outcome = subprocess.run(
            [sys.executable, "-m", "rerun_cli", *command],
            env=here,
            capture_output=True,
            text=True,
            timeout=60,
        )
        assert outcome.returncode == 0, outcome.stdout + outcome.stderr
    return outcome.stdout + outcome.stderr


def all_ok(said: str) -> bool:
    """Whether each channel that is listed is well."""
    topics = [line.split() for line in said.splitlines() if " /" in line]
    return len(topics) > 10 and all(words[0] == "ok" for words in topics)


def test_a_record_is_well_closed_and_recovered(site: Site, tmp_path: Path) -> None:
    assert all_ok(rerun(tmp_path, "mcap", "check", "--full", str(site.files[0])))
    said = rerun(tmp_path, "mcap", "info", str(site.files[0]))
    assert "sensor_msgs/msg/JointState" in said and "ros2msg / cdr" in said and "arboleda.Step" in said
    killed, whole = tmp_path / "killed.mcap", tmp_path / "whole.mcap"
    killed.write_bytes(site.files[0].read_bytes()[:-3000])
    copying.as_mcap(reader.alone(killed), whole, (1,))
    assert all_ok(rerun(tmp_path, "mcap", "check", "--full", str(whole)))
