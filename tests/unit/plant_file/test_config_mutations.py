"""Whatever a person changes in the shipped file: a plant or a ConfigError, never another exception."""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.model.errors import ConfigError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_check import layout_check
from arboleda.plant_file import loader

EXAMPLES = Path(__file__).parents[3] / "examples"
WORD = re.compile(r"[^\s<>=\"/]+")
PLACE = re.compile(r":(\d+):(\d+): .+")
TOKEN = re.compile(r"[^\s:,{}\[\]]+")
VALUES = st.sampled_from(
    [
        "",
        "~",
        "0",
        "-1",
        "7",
        "1e309",
        ".nan",
        "true",
        "on",
        "012",
        "[]",
        "{}",
        "[[]]",
        "x: y",
        "*a",
        "&a 1",
        "'",
    ]
) | st.text(max_size=8)


@cache
def shipped() -> str:
    return files("arboleda").joinpath("plants/plant.yaml").read_text("utf-8")


@cache
def own_arm() -> str:
    return (EXAMPLES / "plants/own_arm.yaml").read_text("utf-8").replace("../machine_tending/models/", "")


@cache
def urdf() -> str:
    return (EXAMPLES / "machine_tending/models/tender.urdf").read_text("utf-8")


def read_model(folder: Path, text: str) -> None:
    """The plant with an arm of its own, and this in place of its URDF."""
    (folder / "plant.yaml").write_text(own_arm(), "utf-8")
    (folder / "tender.urdf").write_bytes(text.encode("utf-8"))
    try:
        plant: PlantModel | None = loader.load(folder / "plant.yaml")
        problems: tuple[str, ...] = ()
    except ConfigError as error:
        plant, problems = None, error.problems
    assert bool(plant) != bool(problems)
    names = tuple(str(folder / name) for name in ("tender.urdf", "plant.yaml"))
    assert all(problem.startswith(names) and re.search(PLACE, problem) for problem in problems)
    warned = layout_check.warnings(plant) if plant is not None else ()
    assert not any("nobody has looked" in warning for warning in warned), "what is taken can be drawn"


@cache
def bench() -> str:
    return (EXAMPLES / "lab_bench/plant.yaml").read_text("utf-8")


def read(folder: Path, text: str, *, recipes: bool = True) -> None:
    file = folder / "plant.yaml"
    file.write_bytes(text.encode("utf-8"))
    try:
        plant: PlantModel | None = loader.load(file, recipes=recipes)
        problems: tuple[str, ...] = ()
    except ConfigError as error:
        plant, problems = None, error.problems
    assert bool(plant) != bool(problems)
    assert all(PLACE.fullmatch(problem.removeprefix(str(file))) for problem in problems)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("plants")


@given(data=st.data(), value=VALUES)
def test_a_replaced_word(folder: Path, data: st.DataObject, value: str) -> None:
    found = data.draw(st.sampled_from(list(TOKEN.finditer(shipped()))))
    read(folder, shipped()[: found.start()] + value + shipped()[found.end() :])


@given(data=st.data())
def test_lost_lines(folder: Path, data: st.DataObject) -> None:
    lines = shipped().splitlines(keepends=True)
    start = data.draw(st.integers(0, len(lines) - 1))
    del lines[start : start + data.draw(st.integers(1, 4))]
    read(folder, "".join(lines))


@given(data=st.data(), value=st.text(max_size=3))
def test_text_put_anywhere(folder: Path, data: st.DataObject, value: str) -> None:
    place = data.draw(st.integers(0, len(shipped())))
    read(folder, shipped()[:place] + value + shipped()[place:])


@given(
    data=st.data(),
    value=VALUES
    | st.sampled_from(["motion", "query", "bool", "part", "$on", "[1, 2.5]", "[a, a]", "{a: $b}"]),
)
def test_a_replaced_word_of_a_plant_of_devices(folder: Path, data: st.DataObject, value: str) -> None:
    found = data.draw(st.sampled_from(list(TOKEN.finditer(bench()))))
    read(folder, bench()[: found.start()] + value + bench()[found.end() :], recipes=False)


@given(data=st.data())
def test_lost_lines_of_a_plant_of_devices(folder: Path, data: st.DataObject) -> None:
    lines = bench().splitlines(keepends=True)
    start = data.draw(st.integers(0, len(lines) - 1))
    del lines[start : start + data.draw(st.integers(1, 4))]
    read(folder, "".join(lines), recipes=False)


@given(
    data=st.data(),
    value=VALUES | st.sampled_from(["tool0", "base_link", "1e-300", "prismatic", "fixed", "mesh"]),
)
def test_a_replaced_word_of_a_urdf(folder: Path, data: st.DataObject, value: str) -> None:
    found = data.draw(st.sampled_from(list(WORD.finditer(urdf()))))
    read_model(folder, urdf()[: found.start()] + value + urdf()[found.end() :])


@given(data=st.data())
def test_missing_lines_of_a_urdf(folder: Path, data: st.DataObject) -> None:
    lines = urdf().splitlines(keepends=True)
    first = data.draw(st.integers(0, len(lines) - 1))
    last = data.draw(st.integers(first, len(lines)))
    read_model(folder, "".join(lines[:first] + lines[last:]))


@pytest.mark.parametrize("name", [":", "a:b", "b:"])
def test_names_of_other_namespaces_are_passed_over(folder: Path, name: str) -> None:
    text = urdf()
    for word in ('<origin xyz="0 0 0.12"', 'xyz="0 0 0.12"', 'type="revolute"'):
        assert word in text
        read_model(folder, text.replace(word, f"{name}{word}".replace(f"{name}<", f"<{name}"), 1))


def test_a_foot_that_is_too_thin_to_be_drawn(folder: Path) -> None:
    assert 'radius="0.11"' in urdf()
    read_model(folder, urdf().replace('radius="0.11"', 'radius="1E-10"', 1))
