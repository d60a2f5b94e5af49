"""What becomes of files that a process has open."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from arboleda.store.held_files import HeldFiles

Change = Callable[[Path], object]


def replaced(path: Path) -> None:
    other = path.with_name("other")
    other.write_text("b")
    other.replace(path)


@pytest.fixture
def files(tmp_path: Path) -> Iterator[list[Path]]:
    """Two files that stay open: what is open keeps its inode for itself."""
    made = [tmp_path / "place" / name for name in ("first", "second")]
    made[0].parent.mkdir()
    with ExitStack() as open_files:
        for each in made:
            open_files.enter_context(each.open("w"))
        yield made


def test_a_file_that_is_written_moved_and_put_back_is_in_its_place(files: list[Path]) -> None:
    held = HeldFiles(files)
    files[1].write_text("another content")
    away = files[1].rename(files[1].with_name("away"))
    assert held.loss() is not None
    away.rename(files[1])
    assert held.loss() is None


@pytest.mark.parametrize(
    ("change", "fate"),
    [
        (Path.unlink, "was deleted or moved away"),
        (lambda path: path.rename(path.with_name("away")), "was deleted or moved away"),
        (replaced, "was replaced by another file"),
    ],
)
def test_a_file_that_is_not_in_its_place_is_named_with_what_became_of_it(
    files: list[Path], change: Change, fate: str
) -> None:
    held = HeldFiles(files)
    change(files[1])
    assert str(held.loss()) == f"{files[1]} {fate} while the plant ran"


def test_a_directory_that_is_gone_or_made_anew_has_none_of_its_files(files: list[Path]) -> None:
    held = HeldFiles(files)
    shutil.rmtree(files[0].parent)
    assert "deleted" in str(held.loss())
    files[0].parent.write_text("a file where the directory was")
    assert "deleted" in str(held.loss())
    files[0].parent.unlink()
    files[0].parent.mkdir()
    files[0].write_text("a")
    assert str(files[0]) in str(held.loss())
