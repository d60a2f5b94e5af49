"""`arboleda new`: the folder that it writes is a plant that runs."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from arboleda.cli.entry import main
from arboleda.cli.main import cli
from arboleda.plant_file import loader

from ..kinds.lab import Bench

ROOT = Path(__file__).parents[3]
PAIR = ROOT / "examples/scara_pair"


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


@pytest.mark.parametrize("words", [["new", "{}", "--like", "scara_pair"], ["examples", "scara_pair", "{}"]])
def test_an_example_is_written_with_the_names_that_it_has(tmp_path: Path, words: list[str]) -> None:
    folder = tmp_path / "my_plant"
    result = CliRunner().invoke(cli, [word.format(folder) for word in words])
    assert result.exit_code == 0 and f"up --plant {folder / 'plant.yaml'}" in " ".join(result.output.split())
    assert {each.name: each.read_bytes() for each in folder.iterdir()} == {
        each.name: each.read_bytes() for each in PAIR.iterdir() if each.is_file()
    }
    assert loader.load(folder / "plant.yaml").name == "scara_pair"


def test_an_example_that_is_not_there_is_refused_with_those_that_are(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _status("new", str(tmp_path / "my_plant"), "--like", "scara_pear") == 2
    said = " ".join(capsys.readouterr().err.split())
    assert "there is no example 'scara_pear'" in said and "did you mean scara_pair?" in said
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("page", "file"),
    [
        (f"{page}{ending}", file)
        for page, file in (("README", "recipes.py"), ("docs/how-to/two-arms", "plant.yaml"))
        for ending in (".md", ".es.md")
    ],
)
def test_a_page_shows_the_pair_as_it_is_written(page: str, file: str) -> None:
    assert f"\n{(PAIR / file).read_text('utf-8')}```\n" in (ROOT / page).read_text("utf-8")


@pytest.mark.parametrize("page", ["README.md", "README.es.md"])
def test_what_the_first_page_has_one_type_makes_a_plant_that_takes_its_task(
    tmp_path: Path, page: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    lines = (ROOT / page).read_text("utf-8").splitlines()
    made, started = (shlex.split(line, comments=True) for line in lines if line.startswith("arboleda "))
    assert CliRunner().invoke(cli, made[1:]).exit_code == 0
    up, task, option, plant = started[1:]
    assert (up, option) == ("up", "--plant")
    here = Bench(loader.load(Path(plant)))
    here.submit(task)
    assert here.outcome().state.value == "done"


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
        patch.setattr("arboleda.cli.entry.leave", lambda _status: None)  # this process goes on
        with pytest.raises(SystemExit) as ended:
            main()
    return int(ended.value.code or 0)


def comments(folder: Path) -> list[str]:
    """The comments and docstrings of the files of a plant."""
    text = "\n".join(file.read_text("utf-8") for file in sorted(folder.iterdir()))
    return re.findall(r'# .*|""".*?"""', text)


def test_a_new_plant_has_its_comments_in_the_language_of_the_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    new(tmp_path / "english")
    monkeypatch.setenv("ARBOLEDA_LANG", "es")
    new(tmp_path / "spanish")
    english, spanish = comments(tmp_path / "english"), comments(tmp_path / "spanish")
    assert len(english) == len(spanish) == 5 and not {*english} & {*spanish}
    loader.load(tmp_path / "spanish" / "plant.yaml")
