"""What is wrong with a recipe is told in sentences of Arboleda, not of Python or py_trees."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.plant_file.recipe_check import trial

from ...plants import plant_text

PLANT = plant_text(__file__, "sentences_of_recipes")
RECIPE = """
from arboleda.recipes import parallel, recipe, work

@recipe("assay")
def assay(cell):
    reader = cell.device("reader")
    again = lambda: again()
    {body}
"""
TWICE = "stands at two places; a step has one place: call what makes it again for the other, or repeat it"
NOT_ASKED = "choose looks at the answer of reader look, which is not asked by then"
MADE_TWICE = f"{NOT_ASKED}; each call makes a step of its own, and another one stands in the recipe"
WAYS = '{"a": [], "b": []}'
WRONG = {
    's = reader.close(); return work(s, reader.open(), s)': f"reader close {TWICE}",
    's = reader.close(); return work(work(s), s)': f"reader close {TWICE}",
    's = reader.close(); return parallel(work(s), cell.retry(s))': f"reader close {TWICE}",
    's = work(reader.close(), reader.open()); return work(s, reader.open(), s)': f"work {TWICE}",
    's = work(reader.close(), reader.open()); return work(cell.retry(s), cell.repeat(s, 2))': f"work {TWICE}",
    "s = cell.retry(reader.close()); return work(cell.timeout(s, 3), s)": f"retry reader close {TWICE}",
    "s = reader.close(); return cell.fallback(s, s)": "fallback has one step twice",
    "return work(reader.close, reader.open())": "work is given reader.close without its parentheses:",
    "return reader.close": "assay returns reader.close without its parentheses: write reader.close()",
    "return cell.retry(reader.close)": "retry is given reader.close without its parentheses",
    "return parallel(reader.close)": "parallel is given reader.close without its parentheses",
    "return work(None)": "work is given None; it takes steps, e.g. mill.open()",
    "return None": "assay returns None; a recipe returns a step, e.g. work(...)",
    "return cell.run(assay)": "assay runs itself without an end: assay > assay",
    "return cell.run(reader)": "it takes a recipe, a function with @recipe before it",
    "return again()": "it calls itself without an end",
    f"return cell.choose(reader.look(), {WAYS})": NOT_ASKED,
    f"s = reader.look(); return work(cell.choose(s, {WAYS}), s)": f"{NOT_ASKED}; let it stand before",
    f"s = reader.look(); return work(cell.retry(reader.look()), cell.choose(s, {WAYS}))": MADE_TWICE,
    's = reader.look(); return cell.choose(s, {"a": [s], "b": []})': NOT_ASKED,
    "return cell.repeat(reader.close(), -1)": "times of repeat takes a whole number from 1 to 100,000; is -1",
    "return cell.repeat(reader.close(), 10**9)": "from 1 to 100,000; is 1000000000",
    "return cell.repeat(reader.close(), 1.5)": "from 1 to 100,000; is 1.5",
    "return cell.retry(reader.close(), times=-1)": "times of retry takes a whole number from 0 to",
    "return cell.retry(reader.close(), times=10**9)": "from 0 to 100,000; is 1000000000",
    "return cell.retry(reader.close(), pause_s=-1)": "pause_s of retry is a number of seconds from 0; is -1",
    'return cell.wait("2")': "wait is a number of seconds from 0; is '2'",
    'return cell.timeout(reader.close(), float("inf"))': "timeout is a number of seconds from 0; is inf",
    "return cell.fallback()": "fallback has no step",
    "return parallel()": "parallel has no step",
    "return cell.fail(3)": "fail is given 3; it takes the words that people are told",
    'return cell.fail(" ")': "it takes the words that people are told",
}  # fmt: skip
RIGHT = (
    f"s = reader.look(); return work(s, cell.choose(s, {WAYS}), cell.choose(s, {WAYS}))",
    f"s = reader.look(); return work(cell.retry(s), cell.choose(s, {WAYS}))",
    "return cell.retry([reader.close(), reader.open()], times=0)",
    "return work([reader.close(), reader.open()], (each for each in [reader.close()]), [])",
    "return cell.repeat(work(reader.close(), reader.open()), 100_000)",
)


def problems(folder: Path, body: str) -> list[str]:
    (folder / "recipes.py").write_text(RECIPE.replace("{body}", body))
    (folder / "plant.yaml").write_text(PLANT)
    found = trial("plant.yaml", PLANT.encode(), folder, lambda spot, doing: None)
    assert not found.here
    return found.elsewhere


@pytest.mark.parametrize(("body", "sentence"), WRONG.items(), ids=WRONG)
def test_what_is_wrong_is_told_in_a_sentence(tmp_path: Path, body: str, sentence: str) -> None:
    (found,) = problems(tmp_path, body)
    assert sentence in found and "Error" not in found


@pytest.mark.parametrize("body", RIGHT, ids=RIGHT)
def test_what_is_right_is_taken(tmp_path: Path, body: str) -> None:
    assert problems(tmp_path, body) == []


def test_a_recipe_that_runs_itself_is_one_mistake_whatever_its_parameters(tmp_path: Path) -> None:
    same = """
@recipe("same")
def same(cell, number: Number[0, 3]):
    return cell.run(same, number=2)
"""
    code = RECIPE.replace("{body}", "return reader.close()").replace(
        "import parallel", "import Number, parallel"
    )
    (tmp_path / "recipes.py").write_text(code + same)
    found = trial("plant.yaml", PLANT.encode(), tmp_path, lambda spot, doing: None)
    (sentence,) = found.elsewhere
    assert sentence.endswith("same runs itself without an end: same > same")


def test_a_recipe_may_run_itself_with_less(tmp_path: Path) -> None:
    body = "return reader.close() if cell is None else cell.run(less, number=3)"
    less = """
@recipe("less")
def less(cell, number: Number[0, 3]):
    reader = cell.device("reader")
    return work(reader.close(), *([cell.run(less, number=number - 1)] if number else []))
"""
    (tmp_path / "recipes.py").write_text(
        RECIPE.replace("{body}", body).replace("import parallel", "import Number, parallel") + less
    )
    found = trial("plant.yaml", PLANT.encode(), tmp_path, lambda spot, doing: None)
    assert not found.here and not found.elsewhere
