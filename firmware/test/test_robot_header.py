"""The robot's numbers in the firmware are those of arboleda_description."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_header_is_what_the_script_writes() -> None:
    made = subprocess.run(
        [sys.executable, ROOT / "scripts/firmware-robot"], capture_output=True, text=True, check=True
    )
    assert made.stdout == (ROOT / "firmware/core/robot_scara.h").read_text()
