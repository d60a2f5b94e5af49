"""What a task was made of: the same in every start, another one after any change that matters."""

from __future__ import annotations

import subprocess
import sys

SHOWN = """
from arboleda.resume import fingerprint
from arboleda.testing import shipped

print(fingerprint.of_cell(shipped().cells[0], "storage", {}))
"""


def test_it_is_the_same_in_another_process() -> None:
    said = [
        subprocess.run([sys.executable, "-c", SHOWN], capture_output=True, text=True, check=True).stdout
        for _ in range(2)
    ]
    assert said[0] == said[1] and len(said[0].strip()) == 32
