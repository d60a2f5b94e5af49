"""Drivers at bad lines in virtual time, of which `make lines` tries all cases; and bugs that are found."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import pytest

from arboleda.model.messages import Verb
from arboleda_drivers.connections.stream import Received
from arboleda_drivers.gcode import marlin_queue
from arboleda_drivers.gcode.grbl_stop import GrblStop, Step
from arboleda_lines.drivers import TRIED
from arboleda_lines.line import CUT, Form, Line
from arboleda_lines.matrix import Case, cases_of, tried

EACH = 97  # so manieth case of a driver is tried in each run of the tests


@pytest.mark.parametrize("driver", TRIED)
def test_a_sample_of_bad_lines(driver: str) -> None:
    cases = [*cases_of(driver, TRIED[driver])][EACH // 2 :: EACH]
    assert [f"{case}: {each}" for case in cases for each in tried(case).breaches] == []


def a_line(word: str, delay_s: float = 0.0) -> Line:
    line = Line(Random(1))
    line.begin(Form(word=word, delay_s=delay_s))
    return line


def heard(line: Line, now: float) -> list[object]:
    return [each if each is CUT else each.data for each in line.arrived(now)]


@pytest.mark.parametrize(
    ("word", "arrives"),
    [
        ("slow", [[], [], [b"ab"]]),
        ("late_once", [[], [], [b"ab", b"cd", b"ef"]]),
        ("doubled", [[b"ab"] * 2, [b"cd"] * 2, [b"ef"] * 2]),
        ("cut", [[b"a"], [], [b"b", b"c"]]),
        ("joined", [[], [b"abcd"], []]),
        ("lost", [[b"ab"], [b"cd"], []]),
        ("garbage", [[b"\x00\xff~\x13", b"ab"], [b"\x00\xff~\x13", b"cd"], [b"\x00\xff~\x13", b"ef"]]),
        ("half_open", [[], [], []]),
        ("reset", [[b"a", CUT], [b"cd"], [b"ef"]]),
        ("echo", [[b"ab"], [b"cd"], [b"ef"]]),
    ],
)
def test_what_a_line_makes_of_three_answers(word: str, arrives: list[list[object]]) -> None:
    """They are said at 0, 1 and 2 s; the delay is 2 s."""
    line, found = a_line(word, 2.0), []
    for at, data in enumerate((b"ab", b"cd", b"ef")):
        line.answers(float(at), Received(data=data))
        found.append(heard(line, float(at)))
    assert found == arrives


def test_what_is_left_over_comes_with_the_next_connection() -> None:
    line = a_line("left_over")
    line.answers(0.0, Received(data=b"abcd"))
    assert heard(line, 0.0) == [b"ab", CUT]
    line.opened(1.0)
    assert heard(line, 1.0) == [b"cd"]


def test_a_slow_line_takes_its_time_for_each_byte_both_ways() -> None:
    line = a_line("baud_9600")
    line.asks(0.0, b"x" * 96)
    line.answers(0.0, Received(data=b"y" * 960))
    assert [*line.sent(0.09)] == [] and [*line.sent(0.1)] == [b"x" * 96]
    assert heard(line, 0.9) == [] and heard(line, 1.0) == [b"y" * 960]


def test_a_line_that_is_good_again_keeps_the_order() -> None:
    line = a_line("slow", 2.0)
    line.answers(0.0, Received(data=b"late"))
    line.end()
    line.answers(1.0, Received(data=b"now"))
    assert heard(line, 1.9) == [] and heard(line, 2.0) == [b"late", b"now"]


Patch = pytest.MonkeyPatch


def waits_for_a_lost_answer(patch: Patch) -> None:
    patch.setattr(marlin_queue, "UNENDED_S", 1e9)


def holds_late(patch: Patch) -> None:
    """The first hold is not written; it is said again after a while."""
    hold, said = GrblStop.hold, list[float]()

    def late(self: GrblStop, now: float) -> None:
        if said:
            hold(self, now)
        else:
            self.begin(now, Step.HOLDING)
        said.append(now)

    patch.setattr(GrblStop, "hold", late)


@pytest.mark.parametrize(
    ("plants", "case", "found"),
    [
        (
            waits_for_a_lost_answer,
            Case(driver="gcode-marlin", form=Form(word="garbage"), moment="sent", act=None),
            "no advice led out",
        ),
        (
            holds_late,
            Case(driver="gcode-grbl", form=Form(word="baud_9600"), moment="at_work", act=Verb.STOP),
            "the stop was on the line after",
        ),
    ],
)
def test_what_is_wrong_in_a_driver_is_found(
    plants: Callable[[Patch], None], case: Case, found: str, monkeypatch: Patch
) -> None:
    plants(monkeypatch)
    assert any(found in each for each in tried(case).breaches)
