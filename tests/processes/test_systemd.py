"""The watchdog that a plant feeds which systemd started, and a unit of `arboleda service` as it is read."""

from __future__ import annotations

import itertools
import os
import shutil
import socket
import subprocess
import threading
from pathlib import Path

import pytest

from arboleda.adapters import clock
from arboleda.cli.service_unit import unit
from arboleda.runtime.parts.systemd import SystemdPart, systemd_part

from ..patience import PATIENCE_S
from ..unit.runtime.notified import asked
from ..unit.runtime.notified import heard as heard

LONG_S = 60.0


def test_it_is_told_that_the_plant_is_ready_lives_and_ends(heard: socket.socket) -> None:
    part = systemd_part(asked(heard, WATCHDOG_USEC="30000", WATCHDOG_PID=str(os.getpid())), clock.seconds)
    assert part
    part.start()
    told = [heard.recv(100) for _ in range(3)]
    part.stop()
    while told[-1] == b"WATCHDOG=1" and len(told) < 1000:
        told.append(heard.recv(100))
    assert told[:3] == [b"READY=1", b"WATCHDOG=1", b"WATCHDOG=1"] and told[-1] == b"STOPPING=1"


def test_a_plant_that_makes_no_steps_any_more_is_not_said_to_live(heard: socket.socket) -> None:
    last, looks, thrice = clock.seconds() - LONG_S, itertools.count(1), threading.Event()

    def stepped_at() -> float:
        if next(looks) == 3:
            thrice.set()
        return last

    part = SystemdPart(heard.getsockname(), 0.03, stepped_at)
    part.start()
    assert thrice.wait(PATIENCE_S)
    part.stop()
    assert [heard.recv(100), heard.recv(100)] == [b"READY=1", b"STOPPING=1"]


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
