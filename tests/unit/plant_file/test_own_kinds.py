"""Kinds in Python: from files beside a plant file and from installed packages; refused by file and line."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.kinds.declared import Device
from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader
from arboleda.plant_file.recipe_check import trial

from ...plants import plant_text, problems_of, rows

SAW = """\
from dataclasses import dataclass

from arboleda.kinds import Kind, KindError, Number, kind, motion, process


@dataclass(frozen=True, kw_only=True)
class Saw:
    mm_s: float = 20.0
    blades: tuple[str, ...] = ("wood", "steel")

    def __post_init__(self):
        if self.mm_s <= 0:
            raise KindError(f"mm_s must be more than 0, is {self.mm_s:g}")


@kind("saw")
def saw(settings: Saw) -> Kind:
    verbs = {
        "close": motion(sets={"guard": "closed"}, takes_s=1),
        "cut": process(
            parameters={"mm": Number(10, 300), "blade": settings.blades},
            needs={"guard": "closed"},
            takes_s=lambda mm, blade: mm / settings.mm_s,
            at_most_s=60,
        ),
    }
    return Kind(facts={"guard": ["open", "closed"]}, verbs=verbs)
"""
RECIPES = """\
from arboleda.recipes import Number, recipe, work

@recipe("bar")
def bar(cell, mm: Number[10, 300]):
    saw = cell.device("saw")
    return work(saw.close(), saw.cut(mm=mm, blade="wood"))
"""
PLANT = plant_text(__file__, "own_kinds")
FILES = rows(__file__, "files_of_kinds")


def write(folder: Path, kind: str = SAW, plant: str = PLANT, recipes: str = RECIPES) -> Path:
    (folder / "kinds").mkdir(exist_ok=True)
    (folder / "kinds/saw.py").write_text(kind, "utf-8")
    (folder / "recipes.py").write_text(recipes, "utf-8")
    file = folder / "plant.yaml"
    file.write_text(plant, "utf-8")
    return file


def problems(file: Path) -> list[str]:
    """What this process finds wrong, without the folder's name."""
    found = trial(file.name, file.read_bytes(), file.parent, lambda spot, doing: None)
    told = [f"plant.yaml:{line}:{column}: {sentence}" for line, column, sentence in found.here]
    return [*told, *(each.removeprefix(f"{file.parent}/") for each in found.elsewhere)]


def install(folder: Path, package: str, entry: str, content: str = SAW) -> None:
    """A package in a folder of `sys.path`, as a package installer leaves it."""
    (folder / f"{package}.py").write_text(content, "utf-8")
    about = folder / f"{package}-1.2.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.2\n", "utf-8")
    (about / "entry_points.txt").write_text(f"[arboleda.kinds]\n{entry}\n", "utf-8")


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder for installed packages, which are forgotten after the test."""
    folder, before = tmp_path / "site", set(sys.modules)
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    yield folder
    for name in set(sys.modules) - before:
        if str(getattr(sys.modules[name], "__file__", "")).startswith(str(folder)):
            del sys.modules[name]


def test_a_file_beside_the_plant_file_brings_a_kind_with_its_settings(tmp_path: Path) -> None:
    plant = loader.load(write(tmp_path))
    saw, eye = plant.robots["saw"], plant.robots["eye"]
    assert isinstance(saw, Device) and isinstance(eye, Device)
    assert (saw.kind_name, saw.kind.verbs["cut"].takes_s, saw.timeout_s) == ("saw", 30.0, 60.0)
    assert eye.kind.verbs["look"].answers == ("good", "bad")
    assert [each.name for each in plant.cells[0].recipes] == ["bar"]


def test_devices_of_one_kind_have_settings_of_their_own(tmp_path: Path) -> None:
    second = "      fast: {kind: saw, mm_s: 100, blades: [bone], evidence: facts, mqtt: saw_2}\n"
    plant = loader.load(write(tmp_path, plant=PLANT + second))
    verbs = [plant.robots[name].kind.verbs["cut"] for name in ("saw", "fast")]  # type: ignore[attr-defined]
    assert [dict(verb.parameters)["blade"].words for verb in verbs] == [("wood", "steel"), ("bone",)]
    assert [verb.takes_s for verb in verbs] == [30.0, 3.0]


def test_a_sensor_may_answer_numbers(tmp_path: Path) -> None:
    numbers = PLANT.replace("{kind: camera}", "{kind: sensor, answers: [1, 2.5]}")
    eye = loader.load(write(tmp_path, plant=numbers)).robots["eye"]
    assert isinstance(eye, Device) and eye.kind.verbs["read"].answers == (1.0, 2.5)
    (found,) = problems(write(tmp_path, plant=numbers.replace("[1,", "[one,")))
    assert "plant.yaml:7:12: " in found and "read.answers must be all words or all numbers" in found


def test_a_shared_device_may_be_of_a_kind_in_python(tmp_path: Path) -> None:
    common = PLANT.replace("saw: {kind: saw, mm_s: 10}", "saw: {shared: big_saw}")
    shared = "shared: {big_saw: {kind: saw, mm_s: 10}}\n"
    plant = loader.load(write(tmp_path, plant=common.replace("cells:", f"{shared}cells:")))
    assert plant.robots["big_saw"].kind.verbs["cut"].takes_s == 30.0  # type: ignore[attr-defined]


def test_the_plant_file_declares_before_anybody(tmp_path: Path) -> None:
    declared = "kinds: {camera: {verbs: {look: {effect: query, answers: [yes, no]}}}}\n"
    plant = loader.load(write(tmp_path, plant=PLANT.replace("cells:", f"{declared}cells:")))
    assert plant.robots["eye"].kind.verbs["look"].answers == ("yes", "no")  # type: ignore[attr-defined]


def test_a_kind_of_a_file_stands_for_the_one_that_comes_with_it(tmp_path: Path) -> None:
    plant = loader.load(
        write(
            tmp_path,
            SAW.replace('@kind("saw")', '@kind("gripper")'),
            PLANT.replace("kind: saw", "kind: gripper"),
        )
    )
    assert "cut" in plant.robots["saw"].kind.verbs  # type: ignore[attr-defined]


@pytest.mark.parametrize("mistake", FILES.values(), ids=FILES)
def test_a_file_that_brings_no_right_kind_is_named_with_its_line(
    tmp_path: Path, mistake: tuple[str, str, str, str]
) -> None:
    old, new, start, words = mistake
    assert old in SAW
    (found,) = problems(write(tmp_path, SAW.replace(old, new, 1)))
    assert found.startswith(f"kinds/saw.py:{start}") and words in found


def test_check_names_a_bad_kind_and_says_no_more_of_its_devices(tmp_path: Path) -> None:
    file = write(tmp_path, SAW.replace('closed"}, takes', 'shut"}, takes'))
    told = CliRunner().invoke(cli, ["check", str(file)])
    assert isinstance(told.exception, ConfigError)
    (found,) = told.exception.problems
    assert found.startswith(f"{tmp_path}/kinds/saw.py:27:1: saw: close.sets.guard must be open, closed")


def test_who_only_looks_for_a_running_plant_runs_no_kinds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    told = CliRunner().invoke(cli, ["status", "--plant", str(write(tmp_path, "raise SystemExit\n"))])
    assert f"No plant is running on {tmp_path}/arboleda/shop" in str(told.exception)


def test_a_file_may_bring_recipes_and_no_kind_but_some_file_must(tmp_path: Path) -> None:
    found = problems(write(tmp_path, plant=PLANT.replace(", recipes.py", "")))
    assert found == [
        'plant.yaml:4:3: cells.bench: offers no recipe: none that "uses" brings fits its devices'
    ]


def test_an_installed_package_brings_a_kind(tmp_path: Path, site: Path) -> None:
    install(site, "acme_saws", "saw = acme_saws:saw")
    file = write(tmp_path, plant=PLANT.replace("kinds/saw.py, ", ""))
    assert loader.load(file).robots["saw"].kind_name == "saw"
    unknown = write(tmp_path, plant=PLANT.replace("kinds/saw.py, ", "").replace("kind: saw", "kind: xyz"))
    assert ", sensor or saw, is" in problems_of(unknown)[0], "what packages register is named"


def test_a_package_is_not_imported_for_plants_without_its_kind(tmp_path: Path, site: Path) -> None:
    install(site, "acme_saws", "other = acme_saws:saw", "raise SystemExit\n")
    assert loader.load(write(tmp_path)).robots["saw"].kind_name == "saw"


PACKAGES = {  # id: (entry point, what the package is, words of the only problem)
    "does not import": (
        "saw = acme_saws:saw",
        "1 / 0\n",
        'the kind "saw" of acme_saws 1.2 cannot be imported: Zero',
    ),
    "has no such": (
        "saw = acme_saws:sow",
        SAW,
        'the kind "saw" of acme_saws 1.2 cannot be imported: Attribute',
    ),
    "is none": (
        "saw = acme_saws:Saw",
        SAW,
        'acme_saws 1.2 registers acme_saws:Saw as a kind "saw", and that is none',
    ),
    "of another name": ("saw = acme_saws:saw", SAW.replace('"saw"', '"sow"'), 'with @kind("saw") before it'),
}


@pytest.mark.sampled(2)
@pytest.mark.parametrize("case", PACKAGES.values(), ids=PACKAGES)
def test_a_package_that_brings_no_right_kind_is_one_sentence(
    tmp_path: Path, site: Path, case: tuple[str, str, str]
) -> None:
    entry, content, words = case
    install(site, "acme_saws", entry, content)
    (found,) = problems_of(write(tmp_path, plant=PLANT.replace("kinds/saw.py, ", "")))
    assert found.startswith("plant.yaml:6:19: cells.bench.devices.saw.kind: ") and words in found


def test_a_name_that_two_packages_register_is_one_sentence(tmp_path: Path, site: Path) -> None:
    install(site, "acme_saws", "saw = acme_saws:saw")
    install(site, "more_saws", "saw = more_saws:saw")
    (found,) = problems_of(write(tmp_path, plant=PLANT.replace("kinds/saw.py, ", "")))
    assert (
        "acme_saws 1.2 and more_saws 1.2 both register a kind" in found or "more_saws 1.2 and acme" in found
    )
    assert loader.load(write(tmp_path)).robots["saw"].kind_name == "saw", "a file of the plant's own decides"


def test_a_package_that_registers_the_name_of_a_shipped_kind_is_one_sentence(
    tmp_path: Path, site: Path
) -> None:
    install(site, "acme_saws", "camera = acme_saws:saw")
    (found,) = problems_of(write(tmp_path))
    said = 'the kind "camera" comes with Arboleda, and acme_saws 1.2 registers another one'
    assert found.startswith("plant.yaml:7:19: ") and said in found
