"""Recipes in files beside a plant file: found, built for every task they could have, or refused by line."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError, TextError
from arboleda.model.plant_model import PlantModel
from arboleda.model.text import parse
from arboleda.plant_file import loader, recipe_trial
from arboleda.plant_file.python_uses import SourceSpot
from arboleda.plant_file.recipe_check import trial

from ...plants import plant_text, problems_of

PLANT = plant_text(__file__, "own_recipes")
SECOND = """\
  shelf:
    devices:
      lamp: {kind: eye}
"""
HEAD = "from arboleda.recipes import Choice, parallel, recipe, work\n\n"
GOOD = HEAD + (
    '@recipe("heat")\ndef heat(cell, celsius: Choice[40, 60]):\n'
    '    return cell.device("oven").heat(celsius=celsius)\n'
)

MISTAKES = {  # id: (what the function `heat` is, the line of the problem, what is told)
    "role": ('    return cell.device("ovne").close()', 5, "there are oven, eye; did you mean oven?"),
    "verb": (
        '    return cell.device("oven").clse()',
        5,
        "no verb 'clse'; there are close, heat; did you mean close?",
    ),
    "value": (
        '    oven = cell.device("oven")\n    return oven.heat(celsius=50)',
        6,
        "celsius of heat is 50; a oven takes 40, 60",
    ),
    "fact": ('    return cell.device("oven").says(lit=1)', 5, "a oven has no fact 'lit'"),
    "no step": ("    return None", 3, "heat returns None; a recipe returns a step"),
    "not all answers": (
        '    seen = cell.device("eye").look()\n    return work(seen, cell.choose(seen, {"good": []}))',
        6,
        "choose has no way for 'bad', which eye look may answer",
    ),
    "no such answer": (
        '    seen = cell.device("eye").look()\n    return cell.choose(seen, {"red": []})',
        6,
        "eye look never answers 'red'; its answers: good, bad",
    ),
    "misspelled kit": (
        "    return cell.fallbck(cell.wait(1), cell.wait(2))",
        5,
        "has no step 'fallbck'; there are ",
    ),
    "raises": ("    return 1 / 0", 5, "cannot be built: ZeroDivisionError: division by zero"),
    "ends": ("    raise SystemExit(3)", 5, "it ends the program (SystemExit: 3)"),
    "a clock": (
        "    import py_trees\n    step = cell.device('oven').close()\n"
        "    return py_trees.decorators.Retry(name='again', child=step, num_failures=2)",
        3,
        "heat has a py_trees Retry (again), which nothing wakes; take ",
    ),
    "two at once": (
        '    oven = cell.device("oven")\n    return parallel(work(oven.close()), oven.heat(celsius=40))',
        3,
        "heat has oven do two things at once, in a parallel; it does one after the other: work(...)",
    ),
    "lost": (
        '    oven, eye = cell.devices("oven", "eye")\n    work(oven.close(), eye.look())\n'
        "    return oven.heat(celsius=40)",
        6,
        "heat makes the step work and does it nowhere; let it stand in what the recipe returns",
    ),
    "a timer": (
        "    import py_trees\n    return py_trees.timers.Timer('rest', 3.0)",
        3,
        "take cell.wait(seconds)",
    ),
}
FILES = {  # id: (the whole file, the line of the problem, what is told)
    "class": (HEAD + "@recipe('x')\nclass F: ...\n", 0, 'the recipe "x" is no function'),
    "no recipe": ("import os\n", 0, "has neither a recipe nor a kind; one is a function with @recipe"),
    "syntax": (HEAD + "def f(:\n", 3, "cannot be imported: SyntaxError: "),
    "name": (HEAD + "@recipee('x')\ndef f(cell): ...\n", 3, "NameError: name 'recipee' is not defined"),
    "module": ("import nowhere_at_all\n", 1, "No module named 'nowhere_at_all'"),
    "exit": (HEAD + "\nraise SystemExit\n", 4, "it ends the program (SystemExit: )"),
    "annotation": (HEAD + "@recipe('x')\ndef f(cell, dose): ...\n", 3, "dose needs what it can be"),
    "name of a recipe": (
        HEAD + "@recipe('two words')\ndef f(cell): ...\n",
        3,
        "cannot be the name of a recipe",
    ),
    "number as name": (HEAD + "@recipe(5)\ndef f(cell): ...\n", 3, "cannot be the name of a recipe"),
    "shipped name": (HEAD + "@recipe('storage')\ndef f(cell): ...\n", 3, "comes with Arboleda"),
    "twice": (
        HEAD + "@recipe('x')\ndef f(cell): ...\n@recipe('x')\ndef g(cell): ...\n",
        5,
        'the recipe "x" is there twice; the other is on line 3 of',
    ),
    "function twice": (
        HEAD + "@recipe('x')\ndef f(cell): ...\n@recipe('y')\ndef f(cell): ...\n",
        6,
        "the function f is there twice, so Python forgets that on line 4",
    ),
    "two words": (
        HEAD + "@recipe('x')\ndef f(cell, a: Choice['two words']): ...\n",
        3,
        'a of x can be "two words"',
    ),
}


def write(folder: Path, recipes: str, plant: str = PLANT) -> Path:
    (folder / "recipes.py").write_text(recipes, "utf-8")
    file = folder / "plant.yaml"
    file.write_text(plant, "utf-8")
    return file


def problems(folder: Path, recipes: str, plant: str = PLANT) -> list[str]:
    """What this process finds wrong with the recipes, without the folder's name."""
    content = write(folder, recipes, plant).read_bytes()
    found = trial("plant.yaml", content, folder, lambda spot, doing: None)
    told = [f"plant.yaml:{line}:{column}: {sentence}" for line, column, sentence in found.here]
    return [*told, *(each.removeprefix(f"{folder}/") for each in found.elsewhere)]


def load(folder: Path, recipes: str, plant: str = PLANT) -> PlantModel:
    return loader.load(write(folder, recipes, plant))


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_recipe_that_cannot_be_built_is_named_with_its_line(
    tmp_path: Path, mistake: tuple[str, int, str]
) -> None:
    body, line, words = mistake
    (found,) = problems(
        tmp_path, f'{HEAD}@recipe("heat")\ndef heat(cell):\n{body}\n', PLANT + "    recipes: [heat]\n"
    )
    assert found.startswith(f"recipes.py:{line}:1: heat ") or found.startswith(f"recipes.py:{line}:1: heat: ")
    assert words in found


@pytest.mark.parametrize("mistake", FILES.values(), ids=FILES)
def test_a_file_that_brings_no_recipes_is_named_with_its_line(
    tmp_path: Path, mistake: tuple[str, int, str]
) -> None:
    content, line, words = mistake
    found = problems(tmp_path, content, PLANT)
    start = f"recipes.py:{line}:" if line else "plant.yaml:2:8: uses[0]: "
    assert [each for each in found if each.startswith(start) and words in each], found


def test_everything_is_told_at_once(tmp_path: Path) -> None:
    recipes = HEAD + (
        '@recipe("one")\ndef one(cell):\n    return cell.device("oven").clse()\n\n'
        '@recipe("two")\ndef two(cell):\n    return cell.device("oven").heat(celsius=1)\n'
    )
    plant = PLANT.replace("{kind: eye}", "{kind: ey}").replace("[recipes.py]", "[recipes.py, more.py]")
    file = write(
        tmp_path,
        recipes,
        plant + SECOND.replace("kind: eye", "kind: oven, name: lamp").replace("lamp:", "oven:"),
    )
    (tmp_path / "more.py").write_text("def f(:\n", "utf-8")
    assert [each.split(": ")[0] for each in problems_of(file)] == [
        "plant.yaml:16:19",
        "more.py:1:1",
        "recipes.py:5:1",
        "recipes.py:9:1",
    ]


def test_a_cell_offers_what_fits_it(tmp_path: Path) -> None:
    lamp = '\n@recipe("look")\ndef look(cell):\n    return cell.device("lamp").look()\n'
    plant = load(tmp_path, GOOD + lamp, PLANT + SECOND)
    assert [[each.name for each in cell.recipes] for cell in plant.cells] == [["heat"], ["look"]]


def test_what_a_recipe_ends_with_is_no_matter_of_a_cell_that_lacks_its_devices(tmp_path: Path) -> None:
    ends = GOOD.replace('@recipe("heat")', '@recipe("heat", ends_with={"oven.lid": "open"})')
    second = '\n@recipe("look")\ndef look(cell):\n    return cell.device("lamp").look()\n'
    plant = load(tmp_path, ends + second, PLANT + SECOND)
    assert {cell.name: [each.name for each in cell.recipes] for cell in plant.cells} == {
        "bench": ["heat"],
        "shelf": ["look"],
    }


def test_a_cell_that_nothing_fits_says_so(tmp_path: Path) -> None:
    (found,) = problems(tmp_path, GOOD, PLANT + SECOND)
    assert found.startswith("plant.yaml:17:3: cells.shelf: offers no recipe: none ")


def test_a_cell_names_its_recipes(tmp_path: Path) -> None:
    more = '\n@recipe("shut")\ndef shut(cell):\n    return cell.device("oven").close()\n'
    plant = load(tmp_path, GOOD + more, PLANT + "    recipes: [shut]\n")
    assert [each.name for each in plant.cells[0].recipes] == ["shut"]
    plant = load(tmp_path, GOOD + more, PLANT + "    default_recipe: shut\n")
    assert [(each.name, each.is_default) for each in plant.cells[0].recipes] == [
        ("heat", False),
        ("shut", True),
    ]
    (found,) = problems(tmp_path, GOOD, PLANT + "    recipes: [heet]\n")
    assert found.startswith("plant.yaml:17:15: ") and 'must be heat, is "heet"; did you mean "heat"?' in found
    (found,) = problems(tmp_path, GOOD, PLANT + "    default_recipe: heet\n")
    assert found.startswith("plant.yaml:17:21: ") and "must be one that the cell offers: heat" in found
    (found,) = problems(tmp_path, GOOD, PLANT + "    recipes: [heat, heat]\n")
    assert '"heat" is there twice' in found


@pytest.mark.parametrize(
    ("uses", "words"),
    [
        ("recipe.py", 'there is no such file; did you mean "recipes.py"?'),
        (
            "recipes",
            'no module "recipes" is installed; a file beside this one is written with its ending, '
            '"recipes.py"',
        ),
        ("./recipes.txt", 'must be a file that ends in .py, or a module; is "./recipes.txt"'),
    ],
)
def test_what_is_not_there_is_named(tmp_path: Path, uses: str, words: str) -> None:
    found = problems(tmp_path, GOOD, PLANT.replace("recipes.py", uses))
    assert [
        each for each in found if each.startswith("plant.yaml:2:8: uses[0]: ") and each.endswith(words)
    ], found


def test_an_installed_module_brings_recipes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "site").mkdir()
    (tmp_path / "site/lab_recipes_of_a_package.py").write_text(GOOD, "utf-8")
    monkeypatch.syspath_prepend(tmp_path / "site")
    plant = load(tmp_path, GOOD, PLANT.replace("recipes.py", "lab_recipes_of_a_package"))
    assert [each.name for each in plant.cells[0].recipes] == ["heat"]


def test_only_installed_modules_serve_a_plant_that_lies_nowhere() -> None:
    with pytest.raises(ConfigError) as refusal:
        loader.parse("plant.yaml", PLANT.encode())
    assert "lies in no folder" in str(refusal.value)


def test_nothing_is_left_beside_the_files_nor_of_them(tmp_path: Path) -> None:
    (tmp_path / "doses.py").write_text("HOT = 60\n", "utf-8")
    path, writes = list(sys.path), sys.dont_write_bytecode
    for hot in (60, 40):
        (tmp_path / "doses.py").write_text(f"HOT = {hot}\n", "utf-8")
        plant = load(
            tmp_path,
            GOOD.replace("Choice[40, 60]", "Choice[HOT]").replace("from", "from doses import HOT\nfrom", 1),
        )
        assert plant.cells[0].recipes[0].parameters[0].words(plant.cells[0]) == [str(hot)]
    assert {each.name for each in tmp_path.iterdir()} == {"doses.py", "recipes.py", "plant.yaml"}
    assert sys.path == path and "doses" not in sys.modules and sys.dont_write_bytecode is writes


def test_an_error_in_a_file_of_its_own_is_named_there(tmp_path: Path) -> None:
    (tmp_path / "doses.py").write_text("HOT = 60\nCOLD = 1 / 0\n", "utf-8")
    found = problems(tmp_path, "from doses import HOT\n" + GOOD)
    assert found == ["doses.py:2:1: cannot be imported: ZeroDivisionError: division by zero"]


def test_a_statement_may_call_what_keeps_its_step(tmp_path: Path) -> None:
    kept = (
        '    steps, oven = {}, cell.device("oven")\n    steps.setdefault("close", oven.close())\n'
        '    steps.update(heat=oven.heat(celsius=celsius))\n    return work(steps["close"], steps["heat"])\n'
    )
    body = GOOD.partition("    return")[0]
    assert problems(tmp_path, body + kept) == []


def test_who_is_ended_while_it_writes_what_it_begins_is_told_by_what_it_began_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def ended(path: Path, *_: object) -> int:
        path.write_bytes(b"")
        raise KeyboardInterrupt

    with recipe_trial.watching(tmp_path, 1000.0, 4000.0) as watch:
        watch(SourceSpot(file="recipes.py", line=3), "importing this")
        monkeypatch.setattr(Path, "write_text", ended)
        with pytest.raises(KeyboardInterrupt):
            watch(SourceSpot(file="recipes.py", line=9), "building heat")
    assert (
        recipe_trial.broken_off(tmp_path, -9) == "recipes.py:3:1: importing this ends Python, with status -9"
    )


def test_recipes_that_were_given_up_did_not_end_python(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recipe_trial, "STUCK_S", 60.0)
    told = recipe_trial.broken_off(tmp_path, None)
    assert told.startswith("the recipes could not be tried: nothing came of it for 60 s; try again")
    with recipe_trial.watching(tmp_path, 1000.0, 4000.0) as watch:
        watch(SourceSpot(file="recipes.py", line=9), "building heat")
    assert recipe_trial.broken_off(tmp_path, None) == "recipes.py:9:1: building heat takes more than 60 s"


def test_of_many_tasks_a_sample_is_tried_and_said(tmp_path: Path) -> None:
    many = ", ".join(map(str, range(1, 31)))
    recipes = HEAD + (
        f'@recipe("heat")\ndef heat(cell, a: Choice[{many}], b: Choice[{many}]):\n'
        '    if a == 30 or b == 30:\n        raise ValueError("thirty")\n'
        '    return cell.device("oven").close()\n'
    )
    found = problems(tmp_path, recipes)
    assert found == ["recipes.py:6:1: heat cannot be built: ValueError: thirty"]
    plant = load(tmp_path, recipes.replace("== 30", "== 31"))
    assert loader.notes(plant) == ("bench: heat has 900 combinations of parameters; 200 of them were tried",)


def test_check_and_tree_take_the_same_way_in(tmp_path: Path) -> None:
    file = write(tmp_path, GOOD)
    said = CliRunner().invoke(cli, ["check", str(file)])
    assert said.exit_code == 0 and said.output == f"{file}: good: plant lab; cells bench\n  bench: heat\n"
    for drawn, celsius in (("heat", 60), ("bench heat 40", 40)):
        outcome = CliRunner().invoke(cli, ["tree", drawn, "--plant", str(file)])
        assert outcome.exit_code == 0 and f"oven heat {celsius}" in outcome.output
    file = write(tmp_path, GOOD.replace('"oven"', '"ovne"'))
    for command in (
        ["check", str(file)],
        ["tree", "heat", "--plant", str(file)],
        ["up", "--once", "--plant", str(file), "bench heat 40"],
    ):
        outcome = CliRunner().invoke(cli, command)
        assert isinstance(outcome.exception, ConfigError) and "recipes.py:5:1: " in str(outcome.exception)


def test_a_task_of_the_only_recipe_may_name_it(tmp_path: Path) -> None:
    plant = load(tmp_path, GOOD)
    for text in ("bench 60", "bench heat 60", "bench celsius=60", "BENCH Heat celsius=60"):
        order = parse(text, plant)
        assert (order.recipe, order.values, order.text) == ("heat", {"celsius": 60}, "bench 60")
    with pytest.raises(TextError, match="the task has 2 words; write <cell> <celsius>, e"):
        parse("bench heat", plant)
    with pytest.raises(TextError, match="celsius of bench cannot be '50'; there are 40, 60"):
        parse("bench heat 50", plant)


def test_a_value_that_is_the_name_of_the_only_recipe_stays_a_value(tmp_path: Path) -> None:
    recipes = HEAD + '@recipe("heat")\ndef heat(cell, what: Choice["heat", "cool"]):\n    return work()\n'
    assert parse("bench heat", load(tmp_path, recipes)).values == {"what": "heat"}


def test_a_file_that_is_good_only_once_is_a_problem_too(tmp_path: Path) -> None:
    once = f"from pathlib import Path\nPath({str(tmp_path / 'been')!r}).touch(exist_ok=False)\n"
    (found,) = problems_of(write(tmp_path, once + GOOD))
    assert found.startswith("recipes.py:2:1: cannot be imported: FileExistsError: ")


def test_who_only_looks_for_a_running_plant_runs_no_recipes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    told = CliRunner().invoke(cli, ["status", "--plant", str(write(tmp_path, "raise SystemExit\n"))])
    assert f"No plant is running on {tmp_path}/arboleda/lab" in str(told.exception)


LAMP = HEAD + '@recipe("shine")\ndef shine(cell):\n    return cell.device("lamp").look()\n'
PALLET = HEAD.replace("Choice", "Choice, Target") + (
    '@recipe("lay")\ndef lay(cell, slot=Target("slots")):\n    return cell.device("oven").close()\n'
)


def test_check_says_which_cell_offers_what_and_why_not_the_rest(tmp_path: Path) -> None:
    recipes = GOOD + LAMP.removeprefix(HEAD)
    file = write(tmp_path, recipes, PLANT + SECOND)
    said = CliRunner().invoke(cli, ["check", str(file)])
    assert said.output.splitlines() == [
        f"{file}: good: plant lab; cells bench, shelf",
        "  bench: heat; not shine: bench has no device in the role 'lamp'; there are oven, eye",
        "  shelf: shine; not heat: shelf has no device in the role 'oven'; there are lamp",
    ]


def test_a_recipe_without_targets_to_choose_from_is_told_which_group_its_cell_lacks(tmp_path: Path) -> None:
    (found,) = problems(tmp_path, PALLET)
    assert 'slot of lay has no value to choose; bench has no targets "slots"' in found


@pytest.mark.parametrize(
    ("plant", "recipes"),
    [
        (PLANT.replace("eye: {kind: eye}", "eye: {kind: eya}"), PALLET),
        (PLANT.replace("eye: {kind: eye}", "eye: {kind: eya}") + SECOND, GOOD + LAMP.removeprefix(HEAD)),
        (PLANT.replace("lid: [open, closed]", "lid: [open, open]"), GOOD),
    ],
    ids=["a recipe without a value", "a cell without a recipe", "a kind"],
)
def test_one_mistake_in_a_cell_brings_no_others(tmp_path: Path, plant: str, recipes: str) -> None:
    (found,) = problems(tmp_path, recipes, plant)
    assert "must be" in found or "there twice" in found


BROKEN = "is no Python\n"
ARM = "  press:\n    devices:\n      arm: {kind: arm, model: arm.yaml}\n"
TWO_FILES = PLANT.replace("[recipes.py]", "[recipes.py, more.py]")


@pytest.mark.parametrize(
    ("plant", "recipes"),
    [
        (PLANT + ARM, PALLET),
        (TWO_FILES, PALLET),
        (TWO_FILES + "    recipes: [heat, warm]\n", GOOD),
        (TWO_FILES + "    recipes: [heat]\n    default_recipe: warm\n", GOOD),
        (TWO_FILES + "    recipes: [lay]\n", PALLET),
    ],
    ids=[
        "targets of a cell whose model is wrong",
        "targets of a kind of a file that is wrong",
        "a recipe of a file that is wrong",
        "a default recipe of a file that is wrong",
        "targets of a cell that names the recipe",
    ],
)
def test_a_mistake_in_another_file_brings_no_others(tmp_path: Path, plant: str, recipes: str) -> None:
    (tmp_path / "more.py").write_text(BROKEN, "utf-8")
    (tmp_path / "arm.yaml").write_text("joints: 5\n", "utf-8")
    found = problems(tmp_path, recipes, plant)
    assert found
    assert all(each.startswith("arm.yaml") or "cannot be imported" in each for each in found)


def test_a_cell_without_a_recipe_is_told_why(tmp_path: Path) -> None:
    (found,) = problems(tmp_path, GOOD, PLANT + SECOND)
    assert found.endswith(
        'cells.shelf: offers no recipe: none that "uses" brings fits its devices (shelf has no device in the'
        " role 'oven'; there are lamp)"
    )
