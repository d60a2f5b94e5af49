"""What stands in `container/` fits the plant: its command line, and the files of the page on TLS."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
import typer
import yaml

from arboleda.cli.main import cli

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


def test_the_files_that_are_mounted_are_those_of_the_page_on_tls(services: dict[str, Any]) -> None:
    page = (FOLDER.parent / "docs/how-to/tls.md").read_text()
    broker, plant = mounted(services["broker"]), mounted(services["plant"])
    assert broker == {"/etc/mosquitto/arboleda": "./certs/mosquitto"}
    assert services["broker"]["command"] == ["mosquitto", "-c", "/etc/mosquitto/arboleda/mosquitto.conf"]
    assert f"`{' '.join(services['broker']['command'])}`" in page
    named = {
        name: value
        for name, value in services["plant"]["environment"].items()
        if name.startswith("ARBOLEDA_MQTT")
    }
    assert len(named) == 3
    exported = [f"{name}={plant[inside].removeprefix('./')}" for name, inside in named.items()]
    assert f"export {' '.join(exported)}\n" in page


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
