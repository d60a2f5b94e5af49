"""A command that is at work for a while says so on a terminal, and leaves nothing of that there."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace

import pytest

from arboleda.cli import working as module
from arboleda.cli.working import CLEARED, working


class Terminal:
    """Standard error on a terminal, which is a file."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file = path.open("wb")

    def isatty(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._file.fileno()

    @property
    def shown(self) -> str:
        return self._path.read_bytes().decode()


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Terminal:
    terminal = Terminal(tmp_path / "terminal")
    monkeypatch.setattr(module, "sys", SimpleNamespace(stderr=terminal))
    return terminal


@pytest.fixture
def slow(monkeypatch: pytest.MonkeyPatch) -> None:
    """All that is at work is so for a while."""

    @contextmanager
    def at_once(_: float, act: Callable[[], None]) -> Iterator[None]:
        act()
        yield

    monkeypatch.setattr(module, "called_after", at_once)


def test_it_says_that_it_works_and_how_far_it_is(terminal: Terminal, slow: None) -> None:
    with working() as tell:
        tell("reads: 40 %")
        with working():
            pass
        assert terminal.shown == f"{CLEARED}arboleda ...{CLEARED}arboleda reads: 40 % ..."
    assert terminal.shown.endswith(f"...{CLEARED}")


def test_what_is_over_at_once_says_nothing(terminal: Terminal) -> None:
    with working() as tell:
        tell("reads: 40 %")
    assert terminal.shown == ""


def test_a_file_gets_nothing_of_it(slow: None, capfd: pytest.CaptureFixture[str]) -> None:
    with working() as tell:
        tell("reads: 40 %")
    assert capfd.readouterr() == ("", "")
