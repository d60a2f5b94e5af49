"""Python of a plant that never ends, or ends the process: the trial in another process makes it a problem."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.host import abilities, forks
from arboleda.plant_file import recipe_trial

from ..plants import problems_of
from ..unit.plant_file import test_own_kinds as kinds
from ..unit.plant_file.test_own_recipes import GOOD, HEAD, MISTAKES, PLANT, load, write


@pytest.fixture(params=[True, False], ids=["in a fork", "in another Python"], autouse=True)
def _process(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """The two kinds of process in which a trial is made."""
    if request.param and not abilities.FORKS:
        pytest.skip("this system has no forks")
    monkeypatch.setattr(forks, "can_fork", lambda: request.param)


@pytest.mark.parametrize(
    ("recipes", "told"),
    [
        ("x = sum(range(10**12))\n" + GOOD, "recipes.py:1:1: importing this takes more than "),
        (
            GOOD.replace("    return", "    while True: celsius += 1\n    return"),
            "recipes.py:5:1: building heat for bench takes",
        ),
        ("import os\nos._exit(7)\n", "recipes.py:1:1: importing this ends Python, with status 7"),
    ],
    ids=["in C", "builds for ever", "exits"],
)
def test_a_file_that_never_ends_is_a_problem_like_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, recipes: str, told: str
) -> None:
    monkeypatch.setattr(recipe_trial, "LONGEST_S", 0.5)
    (found,) = problems_of(write(tmp_path, recipes))
    assert found.startswith(told)


def test_a_file_that_waits_for_ever_is_ended_by_the_clock(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recipe_trial, "LONGEST_S", 0.5)
    monkeypatch.setattr(recipe_trial, "WAITS", 4.0)
    (found,) = problems_of(write(tmp_path, "import threading\nthreading.Event().wait()\n" + GOOD))
    assert found.startswith("recipes.py:2:1: importing this takes more than 2 s")


def test_a_thread_that_a_file_leaves_behind_keeps_no_verdict_from_coming(tmp_path: Path) -> None:
    thread = "import threading\nthreading.Thread(target=threading.Event().wait).start()\n"
    write(tmp_path, thread + GOOD)
    assert recipe_trial.verdict("plant.yaml", tmp_path, PLANT.encode()).offers == {"bench": ["heat"]}


def test_where_there_are_no_processes_recipes_are_tried_in_this_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    known = load(tmp_path, GOOD)
    body, _, words = MISTAKES["value"]
    monkeypatch.setattr(recipe_trial, "HAS_PROCESSES", False)
    monkeypatch.setattr(recipe_trial, "subprocess", None)
    (cell,) = load(tmp_path, GOOD).cells
    assert [each.name for each in cell.recipes] == [each.name for each in known.cells[0].recipes] == ["heat"]
    assert words in problems_of(write(tmp_path, f'{HEAD}@recipe("heat")\ndef heat(cell):\n{body}\n'))[0]


def test_a_kind_that_ends_python_is_a_problem_like_others(tmp_path: Path) -> None:
    ends = kinds.SAW.replace("mm / settings.mm_s", "__import__('os')._exit(7)", 1)
    plant = kinds.PLANT.replace("{kind: camera}", "{kind: camera, answer: [a]}")
    missing, found = problems_of(kinds.write(tmp_path, ends, plant))
    assert found.startswith("kinds/saw.py:16:1: making saw for saw ends Python")
    assert "plant.yaml:7:" in missing, "what else is wrong with the plant file is told besides"


def test_a_package_that_ends_python_is_a_problem_and_is_not_imported_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "site"
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    kinds.install(folder, "acme_saws", "saw = acme_saws:saw", "__import__('os')._exit(7)\n")
    (found,) = problems_of(kinds.write(tmp_path, plant=kinds.PLANT.replace("kinds/saw.py, ", "")))
    assert found.startswith("acme_saws:1:1: importing the kind saw ends Python")
