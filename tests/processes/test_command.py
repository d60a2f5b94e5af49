"""The first instants of the `arboleda` command."""

from __future__ import annotations

import os
import shlex
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import arboleda

INTERRUPTED = """
import os, signal, sys

class CtrlC:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, CtrlC())
sys.argv[1:] = ["up", "--help"]
from arboleda.cli.entry import main
main()
"""


def test_ctrl_c_while_the_command_loads_is_no_error() -> None:
    code = INTERRUPTED.format(module="arboleda.cli.up")
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
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


LOADED = """
import contextlib, io, sys
from arboleda.cli.main import main
sys.argv[1:] = {words}
with contextlib.suppress(SystemExit), contextlib.redirect_stdout(io.StringIO()):
    main()
print(*sys.modules)
"""
OF_A_PLANT = {"asyncio", "fastapi", "httpx", "nicegui", "paho", "rclpy", "ssl", "uvicorn"}
OF_OTHER_COMMANDS = {
    "arboleda_trees.bt_xml",
    "arboleda_proofs.campaigns",
    "arboleda.plant_file.loader",
    "arboleda.plant_check.checks",
    "arboleda_proofs.playback",
    "arboleda.sim",
    "arboleda_proofs.simulator",
    "arboleda_class.exercises",
    "arboleda_class.playground",
    "arboleda_drivers.virtual",
}
OF_ANY_PLANT = {
    "arboleda.client",
    "arboleda.core",
    "arboleda.plant_file",
    "arboleda.runtime",
    "py_trees",
    "rich",
}


def loaded(tmp_path: Path, *words: str) -> set[str]:
    """The modules that a command has loaded at its end; no plant runs."""
    ended = subprocess.run(
        [sys.executable, "-c", LOADED.format(words=list(words))],
        capture_output=True,
        text=True,
        check=True,
        cwd=tmp_path,
        env={**os.environ, "XDG_STATE_HOME": str(tmp_path)},
    )
    return set(ended.stdout.split())


def test_the_overview_loads_no_command(tmp_path: Path) -> None:
    found = loaded(tmp_path, "--help")
    assert "arboleda.cli.overview" in found
    assert found & (OF_A_PLANT | OF_OTHER_COMMANDS | OF_ANY_PLANT) == set()


@pytest.mark.parametrize("words", ["submit 'sis_a 0B 7'"])
def test_an_everyday_command_loads_neither_the_check_of_plant_files_nor_what_plays_plants(
    words: str, tmp_path: Path
) -> None:
    found = loaded(tmp_path, *shlex.split(words))
    assert "arboleda.cli.plant_options" in found
    assert found & (OF_A_PLANT | OF_OTHER_COMMANDS) == set()


def test_the_check_of_a_plant_file_loads_nothing_of_other_commands(tmp_path: Path) -> None:
    found = loaded(tmp_path, "check", str(Path(arboleda.__file__).with_name("plants") / "plant.yaml"))
    assert "arboleda.plant_check.checks" in found
    beside = {"arboleda.client", "arboleda.drawing", "arboleda_proofs.campaigns", "rich"}
    assert found & (OF_A_PLANT | beside) == set()
