"""A verb is not told to a device while another device of the cell does not report what the verb needs."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.messages import Reason

from ...plants import changed, plant_text, read, refused, rows
from .lab import Bench

PLANT = plant_text(__file__, "needs_of_others")
RECIPES = """
from arboleda.recipes import parallel, recipe, work

@recipe("grip")
def grip(cell):
    return cell.device("jaw").close(width_mm=30, force_n=40)

@recipe("slow")
def slow(cell):
    return work(cell.wait(5.0), cell.device("jaw").close(width_mm=30, force_n=40))

@recipe("light")
def light(cell):
    reader, lamp = cell.devices("reader", "lamp")
    return work(reader.close(), lamp.light(on=True), reader.read())

@recipe("dark")
def dark(cell):
    return cell.device("reader").read()

@recipe("hasty")
def hasty(cell):
    reader, jaw = cell.devices("reader", "jaw")
    return parallel(reader.close(), work(cell.wait(1.0), jaw.close(width_mm=30, force_n=40)))
"""


@pytest.fixture
def bench(tmp_path: Path) -> Bench:
    here = Bench(read(tmp_path, PLANT, RECIPES))
    here.wait(1.0)
    return here


def test_a_verb_leaves_while_its_need_is_met(bench: Bench) -> None:
    bench.submit("bench grip")
    assert bench.wait(5.0, lambda: "jaw close" in bench.told)


def test_a_verb_is_refused_while_another_device_says_the_contrary(bench: Bench) -> None:
    bench.machines["reader"].facts["lid"] = "closed"
    bench.wait(1.0)
    bench.submit("bench grip")
    end = bench.outcome()
    assert end.reason is Reason.PRECONDITION
    assert "jaw needs lid of reader to be open, and reader said closed" in str(end.sentence)
    assert "jaw close" not in bench.told


def test_a_query_is_refused_too(bench: Bench) -> None:
    bench.submit("bench dark")
    assert "reader needs lit of lamp to be true, and lamp said false" in str(bench.outcome().sentence)
    assert "reader read" not in bench.told


def test_a_need_of_a_kind_is_met_by_the_device_in_that_role(bench: Bench) -> None:
    bench.submit("bench light")
    assert bench.outcome().state.value == "done"
    assert bench.told.index("reader close") < bench.told.index("lamp light") < bench.told.index("reader read")


def test_a_verb_is_refused_while_the_other_device_is_told_to_change_that(bench: Bench) -> None:
    bench.submit("bench hasty")
    end = bench.outcome()
    assert "jaw needs lid of reader to be open, and reader" in str(end.sentence)
    assert "jaw close" not in bench.told


def test_a_verb_is_refused_while_the_other_device_is_not_heard(bench: Bench) -> None:
    bench.submit("bench slow")
    bench.power_off("reader")
    assert "jaw needs lid of reader to be open, and reader was not heard" in str(bench.outcome().sentence)
    assert "jaw close" not in bench.told


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("old", "new", "problem"),
    rows(__file__, "wrong_needs"),
)
def test_a_wrong_need_is_named_with_what_is_allowed(tmp_path: Path, old: str, new: str, problem: str) -> None:
    found = refused(tmp_path, changed(PLANT, (old, new)), RECIPES)
    assert any(problem in each for each in found), found
