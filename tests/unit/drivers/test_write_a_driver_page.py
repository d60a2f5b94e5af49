"""docs/how-to/write-a-driver.md: its driver of a device without ids says what the device truly did."""

from __future__ import annotations

from pathlib import Path
from textwrap import indent
from types import SimpleNamespace
from typing import Any

import pytest

from arboleda import drivers
from arboleda.drivers import MotionState, Report, Stop, StopMode

PAGES = Path(__file__).parents[3] / "docs" / "how-to"
BEFORE = """
class Page:
    work = accepted = done = None
    begun = finishes = False

    def __init__(self):
        self.said, self.written = [], []
        self.hear, self.write = self.said.append, self.written.append
        self.clock = lambda: 1.0
        self.device = SimpleNamespace(name="press")

"""


def page(name: str) -> Any:
    """The driver of the page, in which the plant hears nothing and nothing leaves."""
    text = (PAGES / name).read_text("utf-8")
    code = next(part for part in text.split("```python\n") if part.startswith("def send"))
    known: dict[str, Any] = {name: getattr(drivers, name) for name in drivers.__all__}
    known |= {
        "SimpleNamespace": SimpleNamespace,
        "WORDS": {"press": "P"},
        "STOPS": dict.fromkeys(StopMode, "S"),
    }
    exec(BEFORE + indent(code.partition("```")[0], "    "), known)
    return known["Page"]()


def press(id: str, on_stop: str = "halt") -> Any:
    return SimpleNamespace(id=id, verb="press", on_stop=SimpleNamespace(value=on_stop))


def said(driver: Any, busy: bool) -> tuple[MotionState, str | None, str | None]:
    driver.heard(busy, ())
    report: Report = driver.said[-1]
    return report.state, report.accepted, report.done


STOPPED, MOVING = MotionState.STOPPED, MotionState.MOVING


@pytest.fixture
def driver() -> Any:
    return page("write-a-driver.md")


def test_what_stands_still_since_before_is_not_done(driver: Any) -> None:
    driver.send(press("1-1"))
    assert driver.written == ["P"]
    assert said(driver, busy=False) == (STOPPED, None, None)
    assert said(driver, busy=True) == (MOVING, "1-1", None)
    assert said(driver, busy=False) == (STOPPED, "1-1", "1-1")
    driver.send(press("1-2"))
    assert said(driver, busy=False) == (STOPPED, "1-1", "1-1")


def test_what_was_halted_is_never_done(driver: Any) -> None:
    driver.send(press("1-1"))
    said(driver, busy=True)
    driver.send(Stop(id="1-2", robot="press", mode=StopMode.HALT))
    assert said(driver, busy=False) == (STOPPED, "1-2", None)


def test_what_finishes_is_done_in_spite_of_a_stop(driver: Any) -> None:
    driver.send(press("1-1", "finish"))
    said(driver, busy=True)
    driver.send(Stop(id="1-2", robot="press", mode=StopMode.LATCH))
    assert said(driver, busy=True) == (MOVING, "1-2", None)
    assert said(driver, busy=False) == (STOPPED, "1-2", "1-1")
