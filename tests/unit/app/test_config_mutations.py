"""Whatever a person changes in the shipped file: a plant or a ConfigError, never another exception."""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.app import config
from arboleda.core.errors import ConfigError
from arboleda.core.model import PlantModel

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
    return files("arboleda").joinpath("plants", "plant.yaml").read_text("utf-8")


def read(folder: Path, text: str) -> None:
    file = folder / "plant.yaml"
    file.write_bytes(text.encode("utf-8"))
    try:
        plant: PlantModel | None = config.load(file)
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
