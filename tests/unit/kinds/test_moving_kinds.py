"""Kinds of robots that move: their axes and drives, in the units of a plant file, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from arboleda.kinds import Axes, Axis, GridDrive, KindError, MovingKind, moving_kind
from arboleda.model.messages import Report
from arboleda.model.plant_model import Evidence, Link, Robot
from arboleda.wire.forms import form_of
from arboleda.wire.topics import Channel

NAMED: dict[str, Any] = {
    "name": "it",
    "mqtt": "it",
    "link": Link.MQTT,
    "evidence": Evidence.IDS,
    "timeout_s": 10.0,
}


@moving_kind("gantry")
def gantry() -> Axes:
    """Brings plates.

    In two directions.
    """
    return Axes(
        Axis("x", unit="mm", upper=2000, speed=500, acceleration=1000),
        Axis("turn", lower=-90, upper=90, speed=45),
    )


@moving_kind("cart")
def cart() -> GridDrive:
    return GridDrive(rows=2, columns=5, pitch_mm=400, mm_s=200)


def robot(kind: MovingKind) -> Robot:
    return kind.robot(None, NAMED)


def test_axes_are_joints_in_si_units() -> None:
    x, turn = robot(gantry).joints
    assert (x.unit, x.upper, x.speed, x.acceleration) == ("m", 2.0, 0.5, 1.0)
    assert (turn.unit, turn.lower, turn.speed) == ("rad", math.radians(-90), math.radians(45))
    assert turn.acceleration == 4 * turn.speed
    assert (gantry.name, gantry.about, robot(gantry).kind_name) == ("gantry", "Brings plates.", "gantry")


def test_a_drive_is_a_mobile_robot_without_a_drawing() -> None:
    driven = robot(cart)
    assert (driven.kind_name, driven.floor_grid.size, driven.drawn()) == ("cart", 10, None)
    assert driven.motion.route(0, 9) == (0, 1, 2, 3, 4, 9)
    assert driven.motion.travel_s(None, (0, 1, 2)) == pytest.approx(6.0)


def test_it_has_no_effector_and_says_nothing_of_one() -> None:
    moved = robot(gantry)
    said = Report(at=0.0, robot="it", q=(0.0, 0.0))
    assert moved.objection(said) is None and not moved.has_effector
    for more in ({"effector": True}, {"piece": False}, {"node": 1}, {"q": (0.0,)}):
        assert moved.objection(replace(said, **more)) is not None
    assert Channel.EFFECTOR not in {way.channel for way in form_of(moved).command_forms.values()}


@pytest.mark.parametrize(
    ("made", "sentence"),
    [
        (lambda: Axes(), "a robot has 1 to 9 axes, not 0"),
        (
            lambda: Axes(Axis("a", upper=1, speed=1), Axis("a", upper=1, speed=1)),
            "two axes have one name: a, a",
        ),
        (
            lambda: Axis("a", speed=1),
            "axis a must go from below to above, with 0 inside; it goes from 0 to 0",
        ),
        (lambda: Axis("a", lower=5, upper=9, speed=1), "it goes from 5 to 9"),
        (lambda: Axis("a", upper=9), "speed of axis a must be more than 0, is 0"),
        (
            lambda: Axis("a b", upper=9, speed=1),
            "an axis must have a name of letters, digits and _, has 'a b'",
        ),
        (lambda: Axis("a", unit="cm", upper=9, speed=1), "the unit of axis a must be deg or mm, is 'cm'"),
        (
            lambda: GridDrive(rows=1, columns=1, pitch_mm=1, mm_s=1),
            "a grid has at least 2 nodes, not 1 rows of 1",
        ),
        (lambda: GridDrive(rows=2, columns=1, pitch_mm=0, mm_s=1), "pitch_mm must be more than 0, is 0"),
        (lambda: moving_kind("x")(3), "x: a kind is a function, and 3 is none"),  # type: ignore[arg-type]
    ],
)
def test_what_cannot_be_is_refused_with_a_sentence(made: Any, sentence: str) -> None:
    with pytest.raises(KindError) as refusal:
        made()
    assert sentence in str(refusal.value)
