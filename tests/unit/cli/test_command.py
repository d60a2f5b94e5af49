"""The first instants of the `arboleda` command."""

from __future__ import annotations

import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

import arboleda.cli.commands as command_table
from arboleda.cli.commands import OF_PACKAGES, Command, LoadedCommands, commands
from arboleda.cli.main import main
from arboleda.model.packages import PackageMissing
from arboleda.plant_file.loader import load
from arboleda.plant_file.shipped import shipped_name


@pytest.mark.parametrize("name", list(commands()))
def test_the_overview_has_the_sentence_of_each_command(name: str) -> None:
    command = LoadedCommands()[name]
    said = command.get_short_help_str(1000)
    assert commands()[name].brief == said


@pytest.mark.parametrize(("name", "package"), OF_PACKAGES.items())
def test_a_command_of_a_package_that_is_not_installed_is_named_with_the_line_that_installs_it(
    name: str, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command_table, "commands", lambda: command_table.OURS)
    with pytest.raises(PackageMissing, match=rf"{name} needs .* pip install 'arboleda\[{package}\]'"):
        LoadedCommands()[name]


def test_of_two_commands_with_one_name_ours_is_taken_and_the_other_one_named(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    other = {"up": Command("acme.up", "Up."), "lift": Command("acme.lift", "Lift.", "Lifts")}
    point = SimpleNamespace(name="acme", load=lambda: other)
    monkeypatch.setattr(command_table, "registered", lambda _group: [point, point])
    found = command_table.commands.__wrapped__()
    assert (found["up"].module, found["lift"].section) == ("up", "Lifts")
    said = [
        f"Arboleda goes on without the command {each} of acme: {whose} has this name already"
        for each, whose in (("up", "Arboleda"), ("lift", "acme"))
    ]
    assert capsys.readouterr().err.splitlines() == said


@pytest.mark.parametrize(("name", "loads"), [("lift", True), ("drop", False)])
def test_a_command_of_a_package_that_breaks_is_named_with_the_line(
    name: str,
    loads: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    code = f"def {name}():\n    1 / 0\n\ndef add_to(cli):\n    cli.command()({name})\n"
    file = tmp_path / f"acme_{name}/act.py"
    file.parent.mkdir()
    file.write_text(code if loads else f"\n1 / 0\n{code}")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(command_table, "commands", lambda: {name: Command(f"acme_{name}.act", "Acts.")})
    monkeypatch.setattr(sys, "argv", ["arboleda", name])
    with pytest.raises(SystemExit) as ended:
        main()
    why = f"ZeroDivisionError: division by zero ({file}, line 2)"
    said = f"arboleda: the command {name} of acme_{name} broke: {why}"
    assert (ended.value.code, capsys.readouterr().err.split()) == (1, said.split())


def test_a_package_that_does_not_load_is_named_and_the_other_commands_are_there(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def load() -> None:
        raise ImportError("no module acme")

    broken = SimpleNamespace(name="acme", load=load)
    monkeypatch.setattr(command_table, "registered", lambda _group: [broken])
    assert command_table.commands.__wrapped__() == command_table.OURS
    assert "acme" in capsys.readouterr().err


def test_the_name_of_the_shipped_plant_is_that_of_its_model_which_has_no_database() -> None:
    plant = load(recipes=False)
    assert (shipped_name(), "") == (plant.name, plant.store)
