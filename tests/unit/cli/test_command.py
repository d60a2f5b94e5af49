"""The first instants of the `arboleda` command."""

from __future__ import annotations

import pytest

from arboleda.cli.commands import COMMANDS, LoadedCommands
from arboleda.plant_file.loader import load
from arboleda.plant_file.shipped import shipped_name


@pytest.mark.parametrize("name", list(COMMANDS))
def test_the_overview_has_the_sentence_of_each_command(name: str) -> None:
    command = LoadedCommands()[name]
    said = command.get_short_help_str(1000)
    assert COMMANDS[name].brief == said


def test_the_name_of_the_shipped_plant_is_that_of_its_model_which_has_no_database() -> None:
    plant = load(recipes=False)
    assert (shipped_name(), "") == (plant.name, plant.store)
