"""What stands in `container/` fits the plant: its command line, and the files that `arboleda certs` makes."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import typer
import yaml

from arboleda.cli.main import cli
from arboleda.cli.mosquitto_files import CONFIGURATION

FOLDER = Path(__file__).parents[3] / "container"


@pytest.fixture(scope="module")
def services() -> dict[str, Any]:
    return dict(yaml.safe_load((FOLDER / "compose.yaml").read_text())["services"])


def mounted(service: dict[str, Any]) -> dict[str, str]:
    """What is mounted from beside the file, by where."""
    pairs = [each.split(":")[:2] for each in service["volumes"]]
    return {inside: outside for outside, inside in pairs if outside.startswith("./")}


def test_the_plants_command_line_is_one(services: dict[str, Any]) -> None:
    verb, *options = services["plant"]["command"]
    command = typer.main.get_command(cli).commands[verb]  # type: ignore[attr-defined]
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("ARBOLEDA_MQTT_CA", raising=False)
        assert command.make_context(verb, options).params["broker"] == "mqtts://broker:8883"


@pytest.mark.requires("cryptography")
def test_the_files_that_are_mounted_are_those_that_its_first_lines_make(
    services: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    line = next(
        line for line in (FOLDER / "compose.yaml").read_text().splitlines() if "arboleda certs" in line
    )
    words = line.removeprefix("# arboleda ").replace("NAME", "mill.lab").split()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("arboleda.cli.certs.own_addresses", lambda: ["192.0.2.7"])
    with pytest.raises(SystemExit) as ended:
        cli(words, standalone_mode=True)
    assert ended.value.code == 0
    broker, plant = mounted(services["broker"]), mounted(services["plant"])
    assert all((tmp_path / outside).exists() for outside in (*broker.values(), *plant.values()))
    named = [
        value for name, value in services["plant"]["environment"].items() if name.startswith("ARBOLEDA_MQTT")
    ]
    assert len(named) == 3 and set(named) <= set(plant)
    (inside,) = broker
    said = (tmp_path / broker[inside] / CONFIGURATION).read_text().split()
    files = [word for word in said if word.startswith("/")]
    assert len(files) == 4
    assert all((tmp_path / broker[inside] / Path(each).relative_to(inside)).is_file() for each in files)


def test_the_plant_keeps_its_memory_in_the_database_beside_it(services: dict[str, Any]) -> None:
    environ, database = services["plant"]["environment"], services["database"]["environment"]
    command = typer.main.get_command(cli).commands["up"]  # type: ignore[attr-defined]
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ARBOLEDA_STORE", environ["ARBOLEDA_STORE"])
        store = command.make_context("up", []).params["store"]
    assert store == f"postgresql://{database['POSTGRES_USER']}@database/{database['POSTGRES_DB']}"
    assert environ["PGPASSWORD"] == database["POSTGRES_PASSWORD"]  # of the file .env: none stands in this one
    assert "ports" not in services["database"]
    asked = re.search(r"^ARG EXTRAS=\[(.*)\]$", (FOLDER / "Containerfile").read_text(), re.MULTILINE)
    assert asked and "postgres" in asked[1].split(",")
