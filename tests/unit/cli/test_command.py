"""The first instants of the `arboleda` command."""

from __future__ import annotations

import signal
import subprocess
import sys

INTERRUPTED = """
import os, signal, sys

class CtrlC:
    def find_spec(self, name, path=None, target=None):
        if name == "arboleda.cli.main":
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, CtrlC())
from arboleda.cli.entry import main
main()
"""


def test_ctrl_c_while_the_command_loads_is_no_error() -> None:
    ended = subprocess.run([sys.executable, "-c", INTERRUPTED], capture_output=True, text=True)
    assert (ended.returncode, ended.stdout, ended.stderr) == (-signal.SIGINT, "", "")


ENDED = """
import atexit, os, signal, sys
from arboleda.cli.entry import main
atexit.register(os.kill, os.getpid(), signal.SIGINT)
sys.argv[1:] = ["--version"]
main()
"""


def test_ctrl_c_while_python_ends_is_no_error() -> None:
    ended = subprocess.run([sys.executable, "-c", ENDED], capture_output=True, text=True)
    assert (ended.returncode, ended.stderr) == (-signal.SIGINT, "")


def test_a_command_that_runs_no_plant_loads_nothing_that_only_a_plant_needs() -> None:
    loaded = "import sys, arboleda.cli.main; print(*sys.modules)"
    said = subprocess.run([sys.executable, "-c", loaded], capture_output=True, text=True, check=True).stdout
    heavy = {
        "asyncio",
        "fastapi",
        "httpx",
        "paho",
        "rclpy",
        "ssl",
        "arboleda.sim",
        "arboleda.simulator.world",
    }
    assert "arboleda.plant_file.loader" in said.split()
    assert heavy & set(said.split()) == set()
