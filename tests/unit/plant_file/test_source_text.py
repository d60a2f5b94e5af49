"""The source of a plant's recipes as one hash: what changes it, and what does not."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.plant_file.source_text import source_of

RECIPE = b"def work(cell, count=3):\n    return cell.retry(cell.arm.pick('rack'), times=count)\n"
FOLDER = Path("/plant")


def source(content: bytes, name: str = "recipes.py", folder: Path = FOLDER) -> str:
    return source_of({folder / name: content}, folder)


def test_layout_and_comments_do_not_count() -> None:
    head = b"# what it does\ndef work(cell, count = 3):\n\n"
    same = head + b'    return cell.retry(\n        cell.arm.pick("rack"), times=count)\n'
    assert source(same) == source(RECIPE)


def test_the_folder_of_the_plant_does_not_count() -> None:
    assert source(RECIPE, folder=Path("/elsewhere")) == source(RECIPE)


@pytest.mark.parametrize(
    "other",
    [
        RECIPE.replace(b"3", b"4"),
        RECIPE.replace(b"count)", b"-count)"),
        RECIPE.replace(b"'rack'", b"b'rack'"),
        RECIPE + b"# no Python any more\n(",
    ],
)
def test_each_other_change_counts(other: bytes) -> None:
    assert source(other) != source(RECIPE)


def test_which_end_of_a_slice_is_left_out_counts() -> None:
    assert source(b"x[1:]") != source(b"x[:1]")


def test_the_name_of_a_file_counts_and_what_is_no_source_does_not() -> None:
    assert source(RECIPE, name="other.py") != source(RECIPE)
    files = {FOLDER / "recipes.py": RECIPE}
    assert source_of({**files, FOLDER / "arm.urdf": b"<robot/>"}, FOLDER) == source_of(files, FOLDER)
    assert source_of({**files, FOLDER / "tree.xml": b"<root/>"}, FOLDER) != source_of(files, FOLDER)
