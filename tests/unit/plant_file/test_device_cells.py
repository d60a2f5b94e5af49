"""Cells of devices in a plant file: the kinds that it declares, and what is wrong with them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.kinds.declared import Device, Slot
from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import Cell, Evidence, PlantModel
from arboleda.plant_file import loader
from arboleda.runtime.rate import at_rate

from ...plants import plant_text, read, refused
from ..kinds import lab

KINDS = plant_text(__file__, "device_cells")
RECIPES = """\
from arboleda.recipes import Choice, recipe, work

@recipe("bake")
def bake(cell, dose: Choice[5, 10]):
    return work(cell.device("eye").look())

@recipe("careless")
def careless(cell):
    return work(cell.device("oven").bake(dose=5))
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """With the recipes of these plants in it."""
    (tmp_path / "bake.py").write_text(RECIPES, "utf-8")
    return tmp_path


def bare(plant: PlantModel) -> PlantModel:
    return replace(plant, cells=tuple(replace(cell, recipes=()) for cell in plant.cells))


def test_the_file_is_the_plant_that_is_built_in_python(folder: Path) -> None:
    loaded, built = read(folder, KINDS), lab.model()
    assert bare(loaded) == bare(built)
    ours, theirs = loaded.cells[0].recipes, built.cells[0].recipes
    assert [(each.name, each.form()) for each in ours] == [(each.name, each.form()) for each in theirs]
    assert [each.parameters[0].words(loaded.cells[0]) for each in ours[:1]] == [["5", "10"]]


def test_what_is_left_out_has_a_default(folder: Path) -> None:
    text = KINDS.replace("    queue_limit: 5\n", "").replace(
        ", takes_s: 1, at_most_s: 3}\n      close", "}\n      close"
    )
    text = text.replace("        at_most_s: 30\n", "")
    oven = read(folder, text).robots["oven"]
    assert isinstance(oven, Device)
    verbs = oven.kind.verbs
    assert [(verbs[name].takes_s, verbs[name].at_most_s) for name in ("open", "bake")] == [(0, 2), (20, 60)]
    assert (oven.name, oven.mqtt, oven.evidence, oven.has_stop) == ("oven", "oven", Evidence.IDS, True)
    assert read(folder, text).cells[0].queue_limit == 100


def test_a_device_has_names_and_evidence_of_its_own(folder: Path) -> None:
    own = "{kind: oven, name: oven_1, mqtt: horno_1, evidence: facts, stop: none}"
    plant = read(folder, KINDS.replace("{kind: oven}", own))
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
    (found,) = refused(folder, text)
    assert found.startswith("24:36: ") and "facts cannot prove open of oven: it sets none" in found


def test_numbers_are_of_one_type(folder: Path) -> None:
    text = KINDS.replace("dose: [5, 10, 20]", "dose: [5, 10.5]").replace(
        "      look", "      bake: {effect: query, answers: [1]}\n      look"
    )
    kind = read(folder, text).robots["oven"].kind  # type: ignore[attr-defined]
    assert kind.facts["dose"].words == (5.0, 10.5) and kind.facts["dose"].type is float
    assert kind.verbs["bake"].sets == (("dose", Slot(name="dose")),)


def test_a_plant_may_have_cells_of_both_forms(folder: Path) -> None:
    shipped = loader.load().cells[0]
    storage = Path(__file__).parents[3] / "src/arboleda/arboleda/plants/plant.yaml"
    head, _, rest = storage.read_text("utf-8").partition("cells:\n")
    ours = KINDS.partition("name: lab\n")[2]
    text = ours.replace("cells:\n", f"{head}cells:\n{rest}\n")
    plant = read(folder, text)
    assert [cell.name for cell in plant.cells] == [*(cell.name for cell in loader.load().cells), "bench"]
    assert plant.cells[0] == shipped and type(plant.cells[-1]) is Cell


def test_a_faster_rate_shortens_what_verbs_take_and_not_how_long_they_may(folder: Path) -> None:
    plant = read(folder, KINDS)

    def bake(rate: float) -> tuple[float, float]:
        verb = at_rate(plant, rate).robots["oven"].kind.verbs["bake"]  # type: ignore[attr-defined]
        return verb.takes_s, verb.at_most_s

    assert (bake(10), bake(1), bake(0.5)) == ((2, 30), (20, 30), (40, 60))


def test_all_mistakes_are_told_at_once(folder: Path) -> None:
    text = KINDS.replace("bool}", "boll}", 1).replace("[good, bad]", "[]").replace("kind: oven", "kind: oev")
    text = text.replace("lid: [open, closed]", "lid: 7")
    with pytest.raises(ConfigError) as refusal:
        read(folder, text)
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
    read(folder, KINDS)
    outcome = CliRunner().invoke(cli, [*command, str(folder / "plant.yaml")])
    assert isinstance(outcome.exception, ConfigError) and words in str(outcome.exception)
