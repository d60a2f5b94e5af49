"""Cells of devices in a plant file: the kinds that it declares, and what is wrong with them."""

from __future__ import annotations

import textwrap
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.kinds.declared import Device, Slot
from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Cell, Evidence, PlantModel
from arboleda.plant_file import loader
from arboleda.plant_file.recipe_check import trial
from arboleda.runtime.rate import at_rate

from ...plants import plant_text
from ..kinds import lab

KINDS = plant_text(__file__, "device_cells")

MISTAKES = {  # id: (text, put in its place, the sentence starts with, and has in it)
    "no name of a kind": (
        "  eye:\n    verbs",
        "  Eye:\n    verbs",
        "18:3: kinds.Eye",
        "must be a name of at most 64",
    ),
    "reserved kind": ("  eye:\n    verbs", "  arm:\n    verbs", "18:3: kinds.arm", 'the name "arm" is taken'),
    "kind twice": ("  eye:\n    verbs", "  oven:\n    verbs", "18:3: ", 'the key "oven" is there twice'),
    "unknown key": ("    facts:", "    fact:", "5:5: kinds.oven: the key", 'did you mean "facts"?'),
    "kind without verbs": (
        "    verbs:\n      look",
        "    facts:\n      look",
        "19:5: ",
        'the key "verbs" is missing',
    ),
    "unknown type": ("clamped: bool", "clamped: boll", "5:43: ", 'is "boll"; did you mean "bool"?'),
    "no type": (
        "clamped: bool",
        "clamped: 7",
        "5:43: ",
        "int, number, text, bool or a list of words or numbers, is 7",
    ),
    "limits": (
        "clamped: bool",
        "clamped: {min: 0, max: 1}",
        "5:43: ",
        "is a mapping; a number with limits is of a kind in Python: Number(1, 60)",
    ),
    "no words": ("[open, closed]", "[]", "5:18: kinds.oven.facts.lid", "must have at least 1 value, has 0"),
    "words twice": ("[open, closed]", "[open, open]", "5:25: ", '"open" is there twice'),
    "words and numbers": ("[open, closed]", "[open, 1]", "5:18: ", "all words or all numbers"),
    "yes and no": ("[open, closed]", "[true, false]", "5:18: ", "for true and false, write bool"),
    "a list in a list": ("[open, closed]", "[[open], [closed]]", "5:19: ", "must be a number, or a word"),
    "fact of Python": ("lid: [open", "class: [open", "5:13: ", 'the name "class" is a word of Python'),
    "fact of a step": ("lid: [open", "at_most_s: [open", "5:13: ", 'the name "at_most_s" is taken'),
    "verb of a step": ("      look:", "      says:", "20:7: ", 'the name "says" is taken'),
    "unknown effect": (
        "effect: motion, sets: {lid: open}",
        "effect: move, sets: {lid: open}",
        "7:23: ",
        "motion, process, switch or query",
    ),
    "near effect": ("effect: switch", "effect: swich", "9:23: ", 'did you mean "switch"?'),
    "no effect": ("{effect: query, ", "{", "20:13: ", 'the key "effect" is missing'),
    "unknown verb key": ("takes_s: 0.5", "take_s: 0.5", "20:51: ", 'did you mean "takes_s"?'),
    "unknown fact": (
        "sets: {lid: closed}",
        "sets: {lit: closed}",
        "8:38: ",
        'no fact "lit"; did you mean "lid"?; facts: lid',
    ),
    "value of a fact": (
        "sets: {lid: closed}",
        "sets: {lid: close}",
        "8:43: ",
        'must be open, closed, is "close"; did you mean "closed"?',
    ),
    "no parameter": ("$on}", "$off}", "9:65: ", 'there is no parameter "off"; "with" has on'),
    "no parameters": ("with: {on: bool}, ", "", "9:47: ", 'the verb has no "with"'),
    "parameter beyond": (
        "with: {dose: [5, 10, 20]}",
        "with: {dose: [5, 7]}",
        "13:22: ",
        "dose may be 5, 7, and dose is 5, 10, 20",
    ),
    "any number": (
        "with: {dose: [5, 10, 20]}",
        "with: {dose: int}",
        "13:22: ",
        "dose may be a whole number, and",
    ),
    "unknown need": (
        "needs: {lid:",
        "needs: {lod:",
        "14:17: ",
        'there is no fact "lod"; did you mean "lid"?',
    ),
    "value of a need": ("clamped: true", "clamped: yes", "14:39: ", 'must be true or false, is "yes"'),
    "parameter as need": (
        "{lid: closed, cl",
        "{lid: $dose, cl",
        "14:22: ",
        "$ stands for a parameter in sets only",
    ),
    "holds no motion": (
        "closed}, takes_s: 1, at_most_s: 3}",
        "closed}, holds: part}",
        "8:59: ",
        "only a switch holds a part",
    ),
    "holds no bool": ("{clamped: $on}", "{lid: open}", "9:75: ", "must set exactly one fact that is a bool"),
    "never lets go": ("{clamped: $on}", "{clamped: true}", "5:5: ", "nothing lets go of the part"),
    "keeps what it holds": (
        "with: {on: bool}, sets: {clamped: $on}",
        "sets: {clamped: true}",
        "5:5: ",
        "nothing lets go of the part",
    ),
    "holds what": ("holds: part", "holds: yes", "9:78: ", 'must be part, is "yes"'),
    "no answers": (
        ", answers: [good, bad]",
        "",
        "20:13: ",
        'a query needs "answers", a list of what it may answer',
    ),
    "answers of a switch": (
        "holds: part",
        "answers: [a]",
        "9:80: ",
        "only a query has answers, and this is a switch",
    ),
    "answers are a list": ("[good, bad]", "good", "20:38: ", "must be a list of words or numbers"),
    "query sets": ("answers: [good", "sets: {}, answers: [good", "20:35: ", "must have at least 1 value"),
    "less time than it takes": (
        "at_most_s: 30",
        "at_most_s: 10",
        "16:20: ",
        "must be at least takes_s, which is 20; is 10",
    ),
    "no time to show": (
        "takes_s: 1, at_most_s: 3}\n      clamp",
        "takes_s: 1, at_most_s: 1}\n      clamp",
        "24:13: ",
        "close of oven takes 1 s",
    ),
    "stop of a motion": (
        "closed}, takes_s: 1",
        "closed}, on_stop: halt, takes_s: 1",
        "8:61: ",
        "only a process has it; a motion is always halted",
    ),
    "unknown kind": (
        "kind: oven",
        "kind: ovn",
        "24:20: ",
        'conveyor, camera or sensor, is "ovn"; did you mean "oven"?',
    ),
    "an arm": ("kind: oven", "kind: arm", "24:13: ", 'the key "model" is missing'),
    "empty kind": ("kind: oven", "kind: ", "24:20: ", "must be text, is empty"),
    "no kind": ("{kind: oven}", "{mqtt: oven_1}", "24:13: ", 'the key "kind" is missing'),
    "role": ("      oven: {k", "      Oven: {k", "24:7: ", "a role must be a name of at most 64"),
    "evidence": ("evidence: ids", "evidence: id", "25:35: ", 'must be ids, facts, joints or state, is "id"'),
    "query by facts": (
        "evidence: ids",
        "evidence: facts",
        "25:35: ",
        "look of eye is a query, and its answer has to name",
    ),
    "more facts than a message holds": (
        "facts: {lid:",
        "facts: {a: text, b: text, c: text, d: text, e: text, f: text, lid:",
        "5:5: kinds.oven: ",
        "all that a oven can say at once: the message would have 572 bytes; at most 512 are allowed",
    ),
    "a word that is too long for its board": (
        "answers: [good, bad]",
        f"answers: [good, {'b' * 33}]",
        "20:45: kinds.eye.verbs.look.answers[1]: ",
        "an answer to look of eye: it is 'bbb",
    ),
    "a switch that nothing confirms": (
        "      look: {",
        "      blink: {effect: switch}\n      look: {",
        "20:14: kinds.eye.verbs.blink: ",
        "blink of eye is a switch that sets no fact: nothing would say that it is done",
    ),
    "same name": (
        "{kind: eye,",
        "{kind: eye, name: oven,",
        "25:31: ",
        '"oven" is already that of cells.bench.devices.oven',
    ),
    "name of the cell": (
        "  bench:",
        "  oven:",
        "24:7: ",
        'is already that of cells.oven; give it another, as in "name: oven_oven"',
    ),
    "same mqtt": ("{kind: eye,", "{kind: eye, mqtt: oven,", "25:31: ", 'MQTT name "oven" is already that of'),
    "plant": ("      eye:  {", "      plant: {", "25:7: ", "taken by topics of the plant itself"),
    "queue": ("queue_limit: 5", "queue_limit: 0", "26:18: ", "must be at least 1, is 0"),
    "key of another cell": (
        "    queue_limit: 5",
        "    home: {deg: [0]}",
        "26:5: ",
        'the key "home" is not known',
    ),
    "device": ("    devices:", "    device:", "23:5: ", 'did you mean "devices"?'),
    "no devices": (
        "      oven: {kind: oven}\n      eye:  {kind: eye, evidence: ids}\n",
        "",
        "23:",
        "must be a mapping",
    ),
    "arm and devices": (
        "    queue_limit: 5",
        "    arm: {name: ra1}",
        "26:5: ",
        'either "arm" and "mobile" or "devices"',
    ),
    "paths": (
        "cells:\n",
        "paths: {0B: [0, 3]}\ncells:\n",
        "21:8: paths",
        "no cell has an arm and a mobile robot",
    ),
    "zone": ("cells:\n", "zones: {z: {poses: [bench home]}}\ncells:\n", "21:21: ", "bench has no targets"),
    "no recipes": (
        "uses: [bake.py]\n",
        "",
        "21:3: cells.bench",
        "offers no recipe; name a file that has one at the top",
    ),
    "uses nothing": ("[bake.py]", "[]", "2:7: uses", "must have at least 1 value"),
    "uses a word": ("[bake.py]", "bake.py", "2:7: uses", "must be a list [a, b, ...]"),
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """With the recipes of these plants in it."""
    text = """\
        from arboleda.recipes import Choice, recipe, work

        @recipe("bake")
        def bake(cell, dose: Choice[5, 10]):
            return work(cell.device("eye").look())

        @recipe("careless")
        def careless(cell):
            return work(cell.device("oven").bake(dose=5))
        """
    (tmp_path / "bake.py").write_text(textwrap.dedent(text), "utf-8")
    return tmp_path


def load(folder: Path, text: str) -> PlantModel:
    file = folder / "plant.yaml"
    file.write_text(text, "utf-8")
    return loader.load(file)


def problems(folder: Path, text: str) -> list[str]:
    """The problems, those of the plant file without its name."""
    found = trial("plant.yaml", text.encode(), folder, lambda spot, doing: None)
    if found.here or found.elsewhere:
        return [*(f"{line}:{column}: {sentence}" for line, column, sentence in found.here), *found.elsewhere]
    with pytest.raises(ConfigError) as refusal:
        loader.parse("plant.yaml", text.encode(), folder)
    return [each.removeprefix("plant.yaml:") for each in refusal.value.problems]


def bare(plant: PlantModel) -> PlantModel:
    return replace(plant, cells=tuple(replace(cell, recipes=()) for cell in plant.cells))


def test_the_file_is_the_plant_that_is_built_in_python(folder: Path) -> None:
    loaded, built = load(folder, KINDS), lab.model()
    assert bare(loaded) == bare(built)
    ours, theirs = loaded.cells[0].recipes, built.cells[0].recipes
    assert [(each.name, each.form()) for each in ours] == [(each.name, each.form()) for each in theirs]
    assert [each.parameters[0].words(loaded.cells[0]) for each in ours[:1]] == [["5", "10"]]


def test_what_is_left_out_has_a_default(folder: Path) -> None:
    text = KINDS.replace("    queue_limit: 5\n", "").replace(
        ", takes_s: 1, at_most_s: 3}\n      close", "}\n      close"
    )
    text = text.replace("        at_most_s: 30\n", "")
    oven = load(folder, text).robots["oven"]
    assert isinstance(oven, Device)
    verbs = oven.kind.verbs
    assert [(verbs[name].takes_s, verbs[name].at_most_s) for name in ("open", "bake")] == [(0, 2), (20, 60)]
    assert (oven.name, oven.mqtt, oven.evidence, oven.has_stop) == ("oven", "oven", Evidence.IDS, True)
    assert load(folder, text).cells[0].queue_limit == 100


def test_a_device_has_names_and_evidence_of_its_own(folder: Path) -> None:
    own = "{kind: oven, name: oven_1, mqtt: horno_1, evidence: facts, stop: none}"
    plant = load(folder, KINDS.replace("{kind: oven}", own))
    oven = plant.cells[0].roles["oven"]
    assert (oven.name, oven.mqtt, oven.evidence, oven.has_stop) == (
        "oven_1",
        "horno_1",
        Evidence.JOINTS,
        False,
    )
    assert "oven_1" in loader.warnings(plant)[0]


def test_facts_prove_no_motion_that_sets_none(folder: Path) -> None:
    text = KINDS.replace("motion, sets: {lid: open},", "motion,").replace("oven}", "oven, evidence: facts}")
    (found,) = problems(folder, text)
    assert found.startswith("24:36: ") and "facts cannot prove open of oven: it sets none" in found


def test_numbers_are_of_one_type(folder: Path) -> None:
    text = KINDS.replace("dose: [5, 10, 20]", "dose: [5, 10.5]").replace(
        "      look", "      bake: {effect: query, answers: [1]}\n      look"
    )
    kind = load(folder, text).robots["oven"].kind  # type: ignore[attr-defined]
    assert kind.facts["dose"].words == (5.0, 10.5) and kind.facts["dose"].type is float
    assert kind.verbs["bake"].sets == (("dose", Slot(name="dose")),)


def test_a_plant_may_have_cells_of_both_forms(folder: Path) -> None:
    shipped = loader.load().cells[0]
    storage = Path(__file__).parents[3] / "src/arboleda/arboleda/plants/plant.yaml"
    head, _, rest = storage.read_text("utf-8").partition("cells:\n")
    ours = KINDS.partition("name: lab\n")[2]
    text = ours.replace("cells:\n", f"{head}cells:\n{rest}\n")
    plant = load(folder, text)
    assert [cell.name for cell in plant.cells] == [*(cell.name for cell in loader.load().cells), "bench"]
    assert plant.cells[0] == shipped and type(plant.cells[-1]) is Cell


def test_a_faster_rate_shortens_what_verbs_take_and_not_how_long_they_may(folder: Path) -> None:
    plant = load(folder, KINDS)

    def bake(rate: float) -> tuple[float, float]:
        verb = at_rate(plant, rate).robots["oven"].kind.verbs["bake"]  # type: ignore[attr-defined]
        return verb.takes_s, verb.at_most_s

    assert (bake(10), bake(1), bake(0.5)) == ((2, 30), (20, 30), (40, 60))


@pytest.mark.sampled(2)
@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_mistake_is_named_with_its_line(folder: Path, mistake: tuple[str, str, str, str]) -> None:
    old, new, start, words = mistake
    assert old in KINDS
    found = problems(folder, KINDS.replace(old, new, 1))
    assert [each for each in found if each.startswith(start) and words in each], found


def test_all_mistakes_are_told_at_once(folder: Path) -> None:
    text = KINDS.replace("bool}", "boll}", 1).replace("[good, bad]", "[]").replace("kind: oven", "kind: oev")
    text = text.replace("lid: [open, closed]", "lid: 7")
    with pytest.raises(ConfigError) as refusal:
        load(folder, text)
    lines = [int(each.removeprefix(f"{folder}/plant.yaml:").split(":")[0]) for each in refusal.value.problems]
    assert lines == [5, 9, 20, 24]


@pytest.mark.parametrize(
    ("command", "words"),
    [
        (["urdf", "oven", "--plant"], '"oven" has no model, so there is no drawing of it'),
        (["urdf", "ovn", "--plant"], 'there are oven, eye; did you mean "oven"?'),
    ],
    ids=["urdf", "urdf of nobody"],
)
def test_what_is_not_for_devices_says_so(folder: Path, command: list[str], words: str) -> None:
    load(folder, KINDS)
    outcome = CliRunner().invoke(cli, [*command, str(folder / "plant.yaml")])
    assert isinstance(outcome.exception, ConfigError) and words in str(outcome.exception)
