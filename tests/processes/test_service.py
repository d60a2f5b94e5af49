"""A unit of `arboleda service` as systemd reads it."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from arboleda.cli.service_unit import unit


@pytest.mark.requires("systemd-analyze")
def test_systemd_reads_the_unit_as_it_is_meant(tmp_path: Path) -> None:
    strange = tmp_path / "a plant, 100 % $mine"
    strange.mkdir()
    command = ["/bin/true", "up", "--state", str(strange), 'say "no"']
    file = tmp_path / "arboleda-lab.service"
    file.write_text(unit(plant="lab", command=command, state=strange, user=None))
    verified = subprocess.run(
        [str(shutil.which("systemd-analyze")), "verify", "--man=no", str(file)],
        capture_output=True,
        text=True,
        check=False,
    )
    assert verified.returncode == 0 and str(file.name) not in verified.stderr, verified.stderr
