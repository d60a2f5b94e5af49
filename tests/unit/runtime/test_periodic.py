"""What is looked at again and again, and ends the plant."""

from __future__ import annotations

import threading

from arboleda.model.errors import ArboledaError
from arboleda.runtime.parts import periodic
from arboleda.runtime.parts.periodic import Periodic

from ...patience import PATIENCE_S


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


def test_its_thread_looks_and_after_a_crash_no_more(monkeypatch) -> None:
    monkeypatch.setattr(periodic, "LOOK_S", 0.0)
    crashed, looks = threading.Event(), []

    def fails() -> None:
        looks.append(1)
        raise ArboledaError("gone")

    part = Periodic("place", [fails], lambda *_: crashed.set())
    part.start()
    assert crashed.wait(PATIENCE_S)
    part.stop()
    part.stop()
    assert looks == [1]


def test_one_that_was_not_started_can_be_stopped() -> None:
    Periodic("place", [], lambda *_: None).stop()
