"""What is looked at again and again, and ends the plant."""

from __future__ import annotations

import pytest
from tests.threads import AtOnce, stand_in

from arboleda.model.errors import ArboledaError
from arboleda.runtime.parts import periodic
from arboleda.runtime.parts.periodic import Periodic


def test_all_are_looked_at_until_one_says_that_the_plant_must_end() -> None:
    seen: list[str] = []
    crashes: list[tuple[str, BaseException]] = []
    error = ArboledaError("gone")

    def fails() -> None:
        seen.append("fails")
        if len(seen) > 2:
            raise error

    part = Periodic("place", [lambda: seen.append("first"), fails], lambda *what: crashes.append(what))
    part.turn()
    assert seen == ["first", "fails"] and not crashes
    part.turn()
    assert crashes == [("place", error)]


def test_one_that_is_stopped_before_its_start_looks_at_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(periodic, AtOnce, monkeypatch)
    looks: list[int] = []
    part = Periodic("place", [lambda: looks.append(1)], lambda *_: None)
    part.stop()
    part.start()
    assert not looks


def test_its_thread_looks_and_after_a_crash_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    stand_in(periodic, AtOnce, monkeypatch)
    monkeypatch.setattr(periodic, "LOOK_S", 0.0)
    crashes: list[str] = []
    looks: list[int] = []

    def fails() -> None:
        looks.append(1)
        if len(looks) == 3:
            raise ArboledaError("gone")

    part = Periodic("place", [fails], lambda name, _: crashes.append(name))
    part.start()
    part.stop()
    part.stop()
    assert len(looks) == 3 and crashes == ["place"]
