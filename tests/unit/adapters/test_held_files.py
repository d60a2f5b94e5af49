"""Files that a process has open: what becomes of them, and how many each of its servers may have."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.adapters import descriptors
from arboleda.adapters.descriptors import divided
from arboleda.host import limits
from arboleda.model.errors import StartError
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


@given(limit=st.integers(0, 5000), boards=st.integers(2, 300))
def test_both_servers_at_their_limit_leave_the_plant_what_it_needs(limit: int, boards: int) -> None:
    try:
        shares = divided(limit, boards)
    except StartError as error:
        assert str(limit) in str(error) and "ulimit -n" in str(error)
        return
    strangers = shares.mqtt - (boards + 1)
    used = descriptors.PER_HTTP * shares.http + strangers
    assert used + descriptors.OWN + descriptors.PER_BOARD * (boards + 1) + descriptors.ON_THE_WAY <= limit
    assert shares.http >= descriptors.LEAST_HTTP and strangers >= descriptors.LEAST_MQTT


@pytest.mark.parametrize("limit", [128, 1024])
def test_the_shipped_plant_of_six_boards_starts_under_usual_limits(limit: int) -> None:
    assert divided(limit, 6).http >= descriptors.LEAST_HTTP


def test_no_descriptor_gets_a_number_that_select_cannot_see() -> None:
    assert divided(1_000_000, 6) == divided(descriptors.SELECT_SEES, 6)


def test_a_plant_of_very_many_boards_has_its_least_share_and_still_starts() -> None:
    assert divided(20_000, 600).http == descriptors.LEAST_HTTP


@pytest.mark.parametrize(("soft", "hard", "raised"), [(128, 128, None), (256, 1024, 1024), (1024, -1, 4096)])
def test_a_soft_limit_is_raised_as_far_as_it_serves_anybody(
    monkeypatch: pytest.MonkeyPatch, soft: int, hard: int, raised: int | None
) -> None:
    asked: list[tuple[int, int]] = []
    monkeypatch.setattr(limits.resource, "getrlimit", lambda _what: (soft, hard))
    monkeypatch.setattr(limits.resource, "setrlimit", lambda _what, pair: asked.append(pair))
    descriptors.raise_limit()
    assert asked == ([] if raised is None else [(raised, hard)])
