"""Files in `uses` that are no Python: found by their suffix, and told of where nobody here reads them."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from tests.packages import PACKAGES, leave_out
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError
from arboleda.model.packages import PackageMissing
from arboleda.plant_file.loader import load

PLANT = """name: lab
uses: [USED]
kinds:
  oven: {facts: {lid: [open, closed]}, verbs: {close: {effect: motion, sets: {lid: closed}}}}
cells:
  bench: {devices: {oven: {kind: oven}}}
"""
PYTHON = """
from arboleda.recipes import recipe

@recipe("shut")
def shut(cell):
    return cell.device("oven").close()
"""
MISSING = "needs the package trees, which is not installed here: type pip install 'arboleda[trees]'"


@pytest.fixture
def alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No package beside the runner is installed."""
    leave_out(monkeypatch, tmp_path / "site", *PACKAGES)


def problems(folder: Path, used: str, more: str = "") -> tuple[str, ...]:
    (folder / "plant.yaml").write_text(PLANT.replace("USED", used) + more, "utf-8")
    with pytest.raises(ConfigError) as refused:
        load(folder / "plant.yaml")
    return refused.value.problems


@pytest.mark.usefixtures("alone")
def test_a_file_of_trees_names_the_package_that_reads_it_with_line_and_column(tmp_path: Path) -> None:
    (tmp_path / "tend.xml").write_text("<root/>", "utf-8")
    (found,) = problems(tmp_path, "tend.xml")
    assert found == f"{tmp_path}/plant.yaml:2:8: uses[0]: 'tend.xml' {MISSING}"


@pytest.mark.usefixtures("alone")
def test_recipes_in_python_need_no_package(tmp_path: Path) -> None:
    (tmp_path / "recipes.py").write_text(PYTHON, "utf-8")
    (tmp_path / "plant.yaml").write_text(PLANT.replace("USED", "recipes.py"), "utf-8")
    before = {*sys.modules}
    assert [each.name for each in load(tmp_path / "plant.yaml").recipes] == ["shut"]
    assert not [each for each in {*sys.modules} - before if each.partition(".")[0] in PACKAGES]


@pytest.mark.usefixtures("alone")
@pytest.mark.parametrize("command", [["check", "tend.xml"], ["tree", "tend.xml"]])
def test_a_command_about_a_file_of_trees_names_the_package(command: list[str]) -> None:
    with pytest.raises(PackageMissing, match=rf"^tend\.xml {MISSING[:20]}"):
        CliRunner().invoke(cli, command, catch_exceptions=False)


@pytest.mark.usefixtures("alone")
def test_trees_for_groot2_name_the_package(tmp_path: Path) -> None:
    (tmp_path / "recipes.py").write_text(PYTHON, "utf-8")
    (found,) = problems(tmp_path, "recipes.py", "groot2: 1667\n")
    assert found == f"{tmp_path}/plant.yaml:7:9: groot2: groot2 {MISSING}"


def test_a_form_that_breaks_is_told_where_it_is_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    broken = type("Point", (), {"name": "bt", "load": lambda self: 1 / 0})()
    monkeypatch.setattr("arboleda.plant_file.recipe_forms.entry_points", lambda _group: [broken])
    (told,) = problems(tmp_path, "tend.bt")
    assert "2:8: uses[0]: what reads files that end in .bt cannot be loaded: ZeroDivisionError" in told
