"""Requests of a workbook to its worker: plants of edited files, programs, verdicts, zips."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.scripts import load

from arboleda.web.languages import LANGUAGES, contents
from arboleda_class.exercises.exercise import catalog, exercise
from arboleda_class.playground import plants
from arboleda_class.playground.tab import Tab

from ..exercises.works import samples

EXAMPLES = Path(__file__).parents[4] / "examples"
LESSONS = {f"{each.stem}.py": each.read_text("utf-8") for each in EXAMPLES.glob("0*.py")}
OPENED = {"languages": ["en"], "seed": 0, "level": "none"}
Ask = Callable[..., Any]


@pytest.fixture
def ask() -> Ask:
    tab = Tab()

    def hear(what: str, progress: Callable[[float], object] = lambda _: None, **request: Any) -> Any:
        return json.loads(tab.hear(json.dumps({"do": what, **request}), progress))

    return hear


def test_a_plant_is_built_from_texts_and_stays_where_others_are_none(ask: Ask) -> None:
    plant, files = plants.texts("lab_bench")
    assert ask("build", plant=plant, files=files) == {"problems": []}
    broken = {**files, "recipes.py": "\n\ndef f(:\n"}
    [problem] = ask("build", plant=plant, files=broken)["problems"]
    assert (problem["file"], problem["line"]) == ("recipes.py", 3) and "SyntaxError" in problem["text"]
    problems = ask("build", plant=plant, files={**files, plant: "nome: x\n"})["problems"]
    assert {each["file"] for each in problems} == {plant}
    assert "lab_bench" in ask("open", plant="work", **OPENED)["html"]


def test_what_is_wrong_is_said_in_the_language_of_the_page(ask: Ask) -> None:
    plant, files = plants.texts("lab_bench")
    wrong = {"plant": plant, "files": {**files, plant: f"{files[plant]}\nnome: x\n"}}
    [english] = ask("build", **wrong)["problems"]
    [spanish] = ask("build", **wrong, language="es")["problems"]
    assert english["text"].startswith('the key "nome" is not known; did you mean "name"?')
    assert spanish["text"].startswith('la clave "nome" no se conoce')
    assert {**spanish, "text": ""} == {**english, "text": ""}
    printed = {"files": {"mine.py": "while True:\n    print('x' * 999)\n"}, "program": "mine.py"}
    found = ask("program", **printed, arguments="", typed="", language="es")
    assert found["problem"]["text"] == "el programa escribió más de 200000 caracteres"


@pytest.mark.sampled(17)
@pytest.mark.parametrize("name", plants.FILES)
def test_the_texts_of_every_plant_build_it(ask: Ask, name: str) -> None:
    plant, files = plants.texts(name)
    assert ask("build", plant=plant, files=files) == {"problems": []}


def test_a_program_prints_draws_and_is_given_what_is_typed(ask: Ask) -> None:
    request = {"files": LESSONS, "program": "02_first_tree.py"}
    found = ask("program", **request, arguments="--grid malla_A --code 0B --picture tree", typed="")
    assert "walk path: node 7" in found["output"] and found["problem"] is None
    assert found["pictures"]["tree.svg"].startswith("<svg")
    spanish = ask("program", **request, arguments="--grid malla_A --code 0B", typed="", language="es")
    assert "recorrer el camino: nodo 7" in spanish["output"]
    asked = ask("program", **request, arguments="", typed="malla_A\n 0b \n")
    assert "walk path: node 7" in asked["output"]


@pytest.mark.parametrize(
    ("text", "line", "says"),
    [
        ("x = 1\nraise ValueError('no')\n", 2, "ValueError: no"),
        ("x = 1\ndef f(:\n", 2, "SyntaxError: invalid syntax"),
        ("import sys\nsys.exit('enough')\n", None, "enough"),
        ("while True:\n    print('x' * 999)\n", 0, "printed more than"),
        ("import other\n", 3, "ZeroDivisionError"),
    ],
)
def test_a_program_that_breaks_says_its_line(ask: Ask, text: str, line: int | None, says: str) -> None:
    files = {"mine.py": text, "other.py": "x = 0\n\ny = 1 / x\n"}
    before = (sys.argv, list(sys.path), set(sys.modules))
    found = ask("program", files=files, program="mine.py", arguments="", typed="")
    problem = found["problem"]
    assert (problem and problem["line"]) == line
    assert says in (problem["text"] if problem else found["output"])
    assert (sys.argv, list(sys.path)) == before[:2] and "other" not in sys.modules


def test_a_work_is_judged_and_what_is_not_so_can_be_gone_through(ask: Ask) -> None:
    shares: list[float] = []
    wrong = next(each for each in samples("query_first") if not each.right)
    files = {name: content.decode() for name, content in wrong.files.items()}
    verdict = ask("judge", shares.append, exercise="query_first", files=files, language="es")
    assert verdict["findings"][0]["seen"] == "'pump dispense' no debe hacerse; se hace una vez"
    assert any("bench top_up está en cola" in line for line in verdict["findings"][0]["story"])
    assert not verdict["passes"] and verdict["film"] and shares == sorted(shares)
    assert "play-mishaps" not in ask("open", plant="story", **OPENED)["html"]
    clock = ask("step")["frame"]["clock"]
    assert 0 < clock["tick"] < clock["latest"]
    [[_, good]] = ask("act", act="submit", of="anything", more=None)["frame"]["said"]
    assert not good
    end = ask("go", tick=10**6)["frame"]["clock"]
    assert end["ends"] and end["tick"] == end["latest"] == clock["latest"]
    assert ask("back")["frame"]["clock"]["tick"] < end["tick"]


@pytest.mark.long
def test_a_work_that_passes_has_nothing_to_play_and_a_record_is_there_where_it_belongs(ask: Ask) -> None:
    right = next(each for each in samples("query_first") if each.right)
    files = {name: content.decode() for name, content in right.files.items()}
    verdict = ask("judge", exercise="query_first", files=files)
    assert verdict["passes"] and not verdict["film"] and verdict["runs"] >= exercise("query_first").runs // 2
    assert {each.name: ask("record", exercise=each.name)["film"] for each in catalog().values()} == {
        name: name == "night" for name in catalog()
    }


def test_zips_come_back_as_they_were_and_others_are_refused(ask: Ask) -> None:
    files = {"a/recipes.py": "x = 1\n", "plant.yaml": "ñ\r\n"}
    packed = ask("pack", exercise="", student="", name="mine", files=files)
    assert packed["name"] == "mine.zip"
    assert ask("unpack", data=packed["data"], known=list(files)) == {"files": files}
    assert "none of the files" in ask("unpack", data=packed["data"], known=["b.py"])["sentence"]
    assert "cannot be read" in ask("unpack", data="bm8=", known=["b.py"])["sentence"]
    assert "--student" in ask("pack", exercise="retry", student=" ", name="", files={})["sentence"]


def test_words_are_there_in_every_language_and_for_every_reason() -> None:
    known = [set(contents(language, "workbook")) for language in LANGUAGES]
    assert all(keys == known[0] for keys in known)
    workbooks = load("workbooks.py")
    assert {*workbooks.NOT_HERE.values(), *workbooks.BY_HAND.values()} <= known[0]


@pytest.mark.long
def test_every_lesson_and_exercise_is_a_workbook_with_all_its_texts() -> None:
    workbooks = load("workbooks.py")
    lessons, exercises = list(workbooks.lessons()), list(workbooks.exercises())
    pages = sorted(each.stem for each in workbooks.PAGES.glob("[0-9]*.md") if each.suffixes == [".md"])
    assert [each["name"] for each in lessons] == pages
    assert [each["name"] for each in exercises] == list(catalog())
    for book in (*lessons, *exercises):
        assert all(book["text"][language] for language in LANGUAGES)
        assert set(book["yours"]) <= set(book["files"]) and book["yours"]
        assert "](" not in book["text"]["en"]
    for book in (
        each for each in lessons if each["name"] > "11"
    ):  # a plant to change, and a program or buttons
        assert book["plant"] in book["files"]
        assert ("program" in book) is not bool(book.get("note"))
    [second] = [each for each in lessons if each["name"] == "02_first_tree"]
    assert second["arguments"] == "--grid malla_A --code 0B"
    assert set(second["files"]) == {
        "02_first_tree.py",
        "01_paths.py",
    }
