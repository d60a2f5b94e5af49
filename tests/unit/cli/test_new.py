"""`arboleda new`: the folder that it writes is a plant that runs."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from arboleda.cli.entry import main
from arboleda.cli.main import cli
from arboleda.plant_file import loader

from ..kinds.lab import Bench

ROOT = Path(__file__).parents[3]


def new(folder: Path) -> Result:
    return CliRunner().invoke(cli, ["new", str(folder)])


def test_the_folder_is_a_plant_that_does_its_task(tmp_path: Path) -> None:
    folder = tmp_path / "my_plant"
    result = new(folder)
    assert result.exit_code == 0 and f"wrote {folder / 'plant.yaml'}" in result.output
    said = " ".join(result.output.split())
    assert f'up "cell press feed 3" --plant {folder / "plant.yaml"}' in said and f"-m pytest {folder}" in said
    plant = loader.load(folder / "plant.yaml")
    assert plant.name == "my_plant"
    here = Bench(plant)
    here.submit("cell press spare 5")
    assert here.outcome().state.value == "done"


@pytest.mark.parametrize(
    ("step", "warning"),
    [
        ('loader.visit("press", loader.grip()),', "ends with 1 more at press of press than it began with"),
        ("loader.visit(blank, loader.grip()),", "has loader let go of a part at feed, which is full already"),
        ("machine.open(),", "has loader go to press where door of press is closed"),
    ],
)
def test_a_step_that_is_left_out_of_its_recipe_is_told(tmp_path: Path, step: str, warning: str) -> None:
    new(tmp_path)
    recipes = tmp_path / "recipes.py"
    recipes.write_text(recipes.read_text("utf-8").replace(step, ""), "utf-8")
    result = CliRunner().invoke(cli, ["check", str(tmp_path / "plant.yaml")])
    assert warning in " ".join(result.output.split())


@pytest.mark.parametrize("page", ["README.md", "README.es.md"])
def test_what_the_first_page_shows_of_it_is_in_it(tmp_path: Path, page: str) -> None:
    new(tmp_path / "my_plant")
    written = {
        name: (tmp_path / "my_plant" / name).read_text("utf-8") for name in ("plant.yaml", "recipes.py")
    }
    text = (ROOT / page).read_text("utf-8")
    kinds, recipe = (
        re.search(f"```\\w+\n({start}.*?)```", text, re.DOTALL) for start in ("kinds:", "@recipe")
    )
    assert kinds and kinds[1] in written["plant.yaml"]
    docstring = '    """Put a blank into the press, press it, and bring it back."""\n'
    assert recipe and recipe[1] in written["recipes.py"].replace(docstring, "")


def test_what_is_there_is_never_written_over(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "mine"
    folder.mkdir()
    (folder / "recipes.py").write_text("mine", "utf-8")
    assert _status("new", str(folder)) == 2
    assert "is there already; nothing was written" in capsys.readouterr().err
    assert [each.name for each in folder.iterdir()] == ["recipes.py"]


@pytest.mark.parametrize("name", ["My Plant", "9th", "a" * 65])
def test_a_folder_whose_name_is_no_plant_s_is_refused(
    tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _status("new", str(tmp_path / name)) == 2
    assert "cannot be the name of a plant" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_written_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("", "utf-8")
    assert _status("new", str(tmp_path / "file" / "plant")) == 1
    assert "cannot be written" in capsys.readouterr().err


def _status(*words: str) -> int:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.argv", ["arboleda", *words])
        with pytest.raises(SystemExit) as ended:
            main()
    return int(ended.value.code or 0)
