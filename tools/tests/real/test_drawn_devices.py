"""Drawn plants with cells of devices: everything is drawn, the reader takes it, and recipes are right."""

from __future__ import annotations

import os
import subprocess
import sys


def test_a_seed_draws_the_same_in_every_process() -> None:
    """Python orders sets of words otherwise in each process, unless PYTHONHASHSEED says how."""
    code = "from arboleda_drawn import devices\nfor seed in range(60): print(devices.draw(seed))"
    once, again = (
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONHASHSEED": order, "PYTHONPATH": os.pathsep.join(sys.path)},
            capture_output=True,
            check=True,
        ).stdout
        for order in "12"
    )
    assert once == again and len(once.splitlines()) == 60
