"""A plant is loaded without what it does not use: modules by name and number, whatever the time it takes."""

from __future__ import annotations

import subprocess
import sys

import pytest

from arboleda.cli.main import cli
from arboleda.cli.session import Session

LOADED = f"""
import sys
from {Session.__module__} import Session

def told(_: object) -> int:
    print(*sys.modules)
    return 0

Session.run = told
sys.argv = ["arboleda", *sys.argv[1:]]
from arboleda.cli.entry import main
main()
"""
AT_FIRST = """
import os, sys

class First:
    def __init__(self, real):
        self.real = real

    def __getattr__(self, name):
        return getattr(self.real, name)

    def write(self, text):
        if not text:  # its kind is tried
            return self.real.write(text)
        self.real.write(" ".join([text.strip(), *sys.modules]))
        self.real.flush()
        os._exit(0)

sys.stdout = First(sys.stdout)
sys.argv = ["arboleda", *sys.argv[1:]]
from arboleda.cli.entry import main
main()
"""
SLOW = {"arboleda.engine", "arboleda.plant_file.loader", "arboleda.runtime.build", "fastapi", "paho.mqtt"}
OF_THE_PAGE = {
    "nicegui",
    "engineio",
    "socketio",
    "jinja2",
    "arboleda.dashboard.page",
    "arboleda.dashboard.feed",
}
OF_CLIENTS = {"httpx", "arboleda.client.plant", "arboleda.client.http"}
OF_TRIALS = {
    "arboleda.rig.world",
    "arboleda.testing",
    "arboleda_proofs.simulator.faults",
    "arboleda_make.assistant",
    "pytest",
}
OF_OTHERS = {"rclpy", "asyncua", "pymodbus", "snap7", "serial", "psycopg", "cryptography", "mcp", "numpy"}
MOST = 1450  # modules, of which half are those of FastAPI, typer and rich


@pytest.fixture(scope="module")
def loaded(tmp_path_factory: pytest.TempPathFactory) -> set[str]:
    """The modules of a plant as `arboleda new` writes it, once it is made and before it starts."""
    folder = tmp_path_factory.mktemp("plant")
    cli(["new", str(folder / "cell")], standalone_mode=False)
    options = ["--no-ros", "--plant", str(folder / "cell/plant.yaml"), "--state", str(folder / "state")]
    command = [sys.executable, "-c", LOADED, "up", *options]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    return set(run.stdout.splitlines()[-1].split())


def test_it_is_the_plant_that_was_loaded(loaded: set[str]) -> None:
    assert {"arboleda.runtime.parts.web", "arboleda.runtime.parts.orchestrator", "paho.mqtt.client"} <= loaded


@pytest.mark.parametrize(
    "unused", [OF_THE_PAGE, OF_CLIENTS, OF_TRIALS, OF_OTHERS], ids=["page", "clients", "trials", "others"]
)
def test_what_it_does_not_use_is_not_loaded(loaded: set[str], unused: set[str]) -> None:
    assert unused & loaded == set()


def test_it_is_not_loaded_from_more_modules_than_it_was(loaded: set[str]) -> None:
    assert len(loaded) <= MOST


def test_the_first_line_comes_before_what_is_slow_to_load() -> None:
    command = [sys.executable, "-c", AT_FIRST, "up", "--demo"]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    line, _, modules = said.partition(" ... ")
    assert line == "Loading the plant"
    assert "arboleda.cli.up" in modules.split()
    assert SLOW.isdisjoint(modules.split())


PAGE = "import sys, arboleda.dashboard.page; print(*sys.modules)"


def test_a_page_loads_no_clients_of_its_toolkit() -> None:
    loaded = subprocess.run([sys.executable, "-c", PAGE], capture_output=True, text=True, check=True).stdout
    assert {"nicegui", "engineio"} <= set(loaded.split())
    assert {"aiohttp", "requests", "tornado"}.isdisjoint(loaded.split())
