"""`arboleda urdf`: a robot of the plant on standard output, or one sentence."""

from __future__ import annotations

import subprocess
import sys


def test_the_command_starts_without_the_xacro_library() -> None:
    commands = "arboleda.cli.up, arboleda.cli.check, arboleda.cli.urdf"
    code = f"import sys; sys.modules['xacro'] = None; import {commands}"
    subprocess.run([sys.executable, "-c", code], env={"PYTHONPATH": ":".join(sys.path)}, check=True)
