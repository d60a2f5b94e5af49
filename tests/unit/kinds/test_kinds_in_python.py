"""Kinds that are written in Python: what they may say, what is computed, and what a virtual device does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import pytest

import arboleda.kinds as public
from arboleda.kinds import Kind, KindError, Number, WrittenKind, kind, motion, process, query, switch
from arboleda.kinds.declared import DeviceKind, UseError, VerbCall
from arboleda.kinds.shipped import SHIPPED
from arboleda.model.facts import Value
from arboleda.sim.machine import MachineBody
from arboleda.wire import mqtt_limits
from arboleda.wire.payloads import VerbGoal

from ...plants import device_of, kind_of


@dataclass(frozen=True, kw_only=True)
class Saw:
    mm_s: float = 20.0


class Cooked(str, Enum):
    DONE = "done"


@kind("saw")
def saw(settings: Saw) -> Kind:
    """A band saw.

    More of it.
    """
    return Kind(
        facts={"guard": ["open", "closed"], "cuts": int, "blade": ["wood", "steel"], "width": float},
        verbs={
            "close": motion(sets={"guard": "closed"}, takes_s=1),
            "cut": process(
                parameters={"mm": Number(10, 300), "blade": ["wood", "steel"]},
                needs={"guard": "closed"},
                sets=lambda mm, blade: {"blade": blade},
                takes_s=lambda mm, blade: mm / settings.mm_s,
                at_most_s=60,
                virtual=lambda facts, mm, blade: {"cuts": facts["cuts"] + 1},
            ),
            "measure": query(answers=["thin", "thick"], virtual=lambda facts: "thick"),
        },
    )


SAW = saw.of(Saw())


def told(made: DeviceKind, verb: str, **values: Value) -> VerbCall:
    command = made.command(id="", robot="x", verb=verb, values=values)
    assert isinstance(command, VerbCall)
    return command


def done(body: MachineBody, verb: str, **values: Value) -> float:
    """Has a body do something; after how many s it ends."""
    goal = VerbGoal(verb=verb, values=tuple(values.items()), seq=1, epoch=1)
    assert body.objection(goal, latched=False, faulted=False) is None
    body.start(0, goal)
    assert body.next_change_us is not None
    ends_us = body.next_change_us
    body.advance(ends_us)
    return ends_us / 1e6


def test_what_is_public_is_named() -> None:
    assert set(public.__all__) == {
        *("Axes", "Axis", "GridDrive", "Kind", "KindError", "MovingKind", "Number", "Verb", "WrittenKind"),
        *("kind", "motion", "moving_kind", "process", "query", "switch"),
    }
    assert all(hasattr(public, name) for name in public.__all__)


def test_a_kind_is_a_function_of_its_settings() -> None:
    assert (saw.name, saw.settings, saw.about, SAW.name) == ("saw", Saw, "A band saw.", "saw")
    assert SAW.facts["guard"].words == ("open", "closed") and SAW.facts["width"].type is float
    assert SAW.verbs["close"].sets == (("guard", "closed"),)
    assert (SAW.verbs["close"].takes_s, SAW.verbs["close"].at_most_s) == (1.0, 3.0)
    assert saw.of(Saw(mm_s=100.0)).verbs["cut"].takes_s == 3.0


def test_what_a_verb_sets_and_how_long_it_takes_is_computed_of_its_parameters() -> None:
    command = told(SAW, "cut", mm=50, blade="steel")
    assert command.sets == (("blade", "steel"),) and command.takes_s == 2.5
    assert command.needs == (("guard", "closed"),)
    assert SAW.verbs["cut"].takes_s == 15.0, (
        "the longest that there is, for who asks before the values are known"
    )


def test_a_faster_device_takes_less_and_is_waited_for_as_long() -> None:
    fast = SAW.verbs["cut"].at_rate(5.0)
    assert fast.takes_s_with({"mm": 50, "blade": "wood"}) == 0.5
    assert (fast.takes_s, fast.at_most_s) == (3.0, 60.0)


def test_a_virtual_device_does_what_its_kind_says() -> None:
    body = MachineBody(SAW)
    assert done(body, "close") == 1.0
    assert done(body, "cut", mm=100, blade="steel") == 5.0
    assert body.facts == {"guard": "closed", "cuts": 1, "blade": "steel", "width": 0.0}
    body.take_ends()
    done(body, "measure")
    (end,) = body.take_ends()
    assert end.answer == "thick"


@pytest.mark.parametrize(
    ("answers", "found"), [([1, 2], 2.0), ([0, 1], True), (["raw", "done"], Cooked.DONE)]
)
def test_a_virtual_answer_that_is_equal_to_a_listed_one_is_that_one(
    answers: list[Value], found: Value
) -> None:
    body = MachineBody(Kind(verbs={"look": query(answers=answers, virtual=lambda facts: found)}).declared)
    done(body, "look")
    (end,) = body.take_ends()
    assert end.answer == answers[1] and type(end.answer) is type(answers[1])


def test_a_virtual_device_whose_function_fails_gives_up() -> None:
    once = process(virtual=lambda facts: {"cuts": {0: 1}[facts["cuts"]]})
    counts = Kind(facts={"cuts": int}, verbs={"cut": once})
    body = MachineBody(counts.declared)
    done(body, "cut")
    done(body, "cut")
    assert [end.failure for end in body.take_ends()] == ["virtual"]
    assert body.facts == {"cuts": 1}


def test_what_a_verb_sets_counts_before_what_a_virtual_device_shows_besides() -> None:
    lid = Kind(
        facts={"lid": ["up", "down"]},
        verbs={"close": motion(sets={"lid": "down"}, virtual=lambda facts: {"lid": "up"})},
    )
    body = MachineBody(lid.declared)
    done(body, "close")
    assert body.facts == {"lid": "down"}


@pytest.mark.parametrize(
    ("value", "fits"), [(10, True), (300, True), (9, False), (301, False), (10.5, False), (True, False)]
)
def test_a_number_has_limits(value: Value, fits: bool) -> None:
    if fits:
        assert told(SAW, "cut", mm=value, blade="wood").values[0] == ("mm", value)
        return
    with pytest.raises(UseError, match="a saw takes a whole number from 10 to 300"):
        told(SAW, "cut", mm=value, blade="wood")


MISTAKES: dict[str, tuple[Callable[[], object], str]] = {
    "no function": (lambda: kind("x")(Saw), "x: a kind is a function, and <class"),  # type: ignore[arg-type]
    "number as fact": (lambda: one(facts={1: bool}), "facts has names, and 1 is none"),
    "number as verb": (lambda: Kind(verbs={1: motion()}), "verbs has names, and 1 is none"),  # type: ignore[dict-item]
    "number as parameter": (lambda: one(parameters={1: int}), "go.parameters has names, and 1 is none"),
    "no verbs": (lambda: Kind(verbs={}), "verbs must have at least 1 verb"),
    "no verb": (lambda: Kind(verbs={"go": 7}), "go is 7; a verb is motion"),  # type: ignore[dict-item]
    "type": (lambda: one(facts={"a": complex}), "facts.a must be bool, int, float, str"),
    "word": (lambda: one(facts={"a": []}), "facts.a must have at least 1 value"),
    "no fact": (lambda: one(sets={"lit": "up"}), "go.sets: no fact 'lit'; there are lid; did you mean lid"),
    "value": (lambda: one(sets={"lid": "shut"}), "go.sets.lid must be up, down, is 'shut'"),
    "slot": (lambda: one(sets={"lid": "$way"}), "go.sets.lid: no parameter 'way'; there are none"),
    "slot beyond": (
        lambda: one(sets={"lid": "$way"}, parameters={"way": ["up", "on"]}),
        "go.sets.lid: way may be up, on, and lid is up, down",
    ),
    "need": (lambda: one(needs={"lid": 1}), "go.needs.lid must be up, down, is 1"),
    "time": (lambda: one(takes_s=-1), "go.takes_s must be 0 to 86400 s, is -1"),
    "too short": (lambda: one(takes_s=5, at_most_s=4), "go.at_most_s: must be at least takes_s, which is 5"),
    "computed without end": (
        lambda: one(takes_s=lambda: 1.0),
        "go: takes_s is computed, so it needs at_most_s",
    ),
    "computed too long": (
        lambda: one(takes_s=lambda: 9.0, at_most_s=5.0),
        "go.at_most_s: must be at least takes_s, which is 9; is 5",
    ),
    "computed time": (lambda: one(takes_s=lambda: "x", at_most_s=5.0), "takes_s of go must be a time in s"),
    "computed raises": (
        lambda: one(takes_s=lambda mm: 1 / mm, at_most_s=5.0, parameters={"mm": int}),
        "takes_s of go: ZeroDivisionError: division by zero, with mm=0",
    ),
    "computed sets": (lambda: one(sets=lambda: {"lid": "shut"}), "go sets: lid is never 'shut'"),
    "computed no facts": (lambda: one(sets=lambda: "up"), "sets of go must be facts by name, is 'up'"),
    "virtual": (lambda: one(virtual=lambda facts: {"lit": 1}), "virtual of go: a device has no fact 'lit'"),
    "virtual parameters": (lambda: one(virtual=lambda: {}), "virtual of go: TypeError"),
    "virtual answer": (
        lambda: Kind(verbs={"look": query(answers=["a"], virtual=lambda facts: "b")}),
        "virtual of look answers 'b'; its answers are a",
    ),
    "answers": (lambda: Kind(verbs={"look": query(answers="ab")}), "look.answers must be a list of words"),
    "holds nothing": (
        lambda: Kind(facts={"n": int}, verbs={"grip": switch(sets={"n": 1}, holds_part=True)}),
        "grip: a verb that holds a part must set exactly one fact that is a bool",
    ),
    "keeps": (
        lambda: Kind(facts={"on": bool}, verbs={"grip": switch(sets={"on": True}, holds_part=True)}),
        "verbs: nothing lets go of the part",
    ),
    "holds computed": (
        lambda: Kind(facts={"on": bool}, verbs={"grip": switch(sets=lambda: {}, holds_part=True)}),
        "grip: what a verb that holds a part sets is written down",
    ),
    "limits": (lambda: Number(3, 3), "a Number has two limits"),
    "settings": (lambda: kind("x")(lambda settings: 7), "x: its settings are a frozen dataclass"),  # type: ignore
    "two settings": (lambda: kind("x")(lambda a, b: 7), "x: a kind is a function of its settings alone"),  # type: ignore
    "no kind": (lambda: WrittenKind(name="x", function=lambda: 7).of(None), "x returns 7"),  # type: ignore
}


def one(**more: object) -> Kind:
    """A kind of one motion."""
    facts = more.pop("facts", {"lid": ["up", "down"]})
    return Kind(facts=facts, verbs={"go": motion(**more)})  # type: ignore[arg-type]


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES)
def test_a_kind_that_cannot_be_says_why(mistake: tuple[Callable[[], object], str]) -> None:
    make, words = mistake
    with pytest.raises(KindError) as refusal:
        make()
    assert words in str(refusal.value)


@pytest.mark.parametrize("shipped", SHIPPED, ids=lambda each: each.name)
def test_a_kind_that_comes_with_it_is_one_like_others(shipped: WrittenKind) -> None:
    made = shipped.of(None if shipped.settings is None else shipped.settings())
    assert made.name == shipped.name and shipped.about
    assert mqtt_limits.objections(made) == [], "a board can be told and can say all that it has"


def test_a_gripper_closes_with_a_width_and_a_force_and_lets_go() -> None:
    made = shipped("gripper")
    close = told(made, "close", width_mm=30.0, force_n=40.0)
    assert close.sets == (("gripped", True),) and close.grips is True  # type: ignore[attr-defined]
    body = MachineBody(made)
    done(body, "close", width_mm=30.0, force_n=40.0)
    assert body.facts == {"gripped": True, "width_mm": 30.0, "force_n": 40.0}
    device = device_of(made, "jaw")
    off = device.let_go(id="1")
    assert isinstance(off, VerbCall) and off.verb == "open" and device.held_fact == "gripped"
    with pytest.raises(
        UseError, match=r"jaw is told more to take hold of a part: close\(width_mm=..., force_n="
    ):
        device.grip(id="2")
    with pytest.raises(UseError, match="a gripper takes a number from 0 to 85"):
        told(made, "close", width_mm=90.0, force_n=40.0)


def test_an_effector_grips_and_lets_go_without_being_told_more() -> None:
    cup = device_of(shipped("effector"), "cup")
    on, off = cup.grip(id="1"), cup.let_go(id="2")
    assert (on.sets, off.sets) == ((("on", True),), (("on", False),))


def test_a_part_can_be_let_go_by_a_verb_that_has_other_parameters() -> None:
    grip = switch(parameters={"shut": bool, "force": Number(5, 40)}, sets={"shut": "$shut"}, holds_part=True)
    off = device_of(kind_of("vise", {"shut": bool}, set=grip)).let_go(id="1")
    assert isinstance(off, VerbCall) and off.values == (("shut", False), ("force", 5)) and off.grips is False  # type: ignore[attr-defined]


def test_a_conveyor_advances_to_a_sensor_and_has_left_those_before_it() -> None:
    made = next(each for each in SHIPPED if each.name == "conveyor")
    assert made.settings is not None
    belt = made.of(made.settings(sensors=("entry", "middle", "exit")))
    body = MachineBody(belt)
    body.facts["entry"] = "taken"
    done(body, "advance", to="middle")
    assert body.facts == {"entry": "clear", "middle": "taken", "exit": "clear"}
    done(body, "clear", at="middle")
    assert body.facts == {"entry": "clear", "middle": "clear", "exit": "clear"}


def test_a_camera_answers_what_its_settings_say() -> None:
    made = next(each for each in SHIPPED if each.name == "camera")
    assert made.settings is not None
    assert made.of(made.settings(answers=("red", "green"))).verbs["look"].answers == ("red", "green")


def shipped(name: str) -> DeviceKind:
    """A kind that comes with Arboleda, with the settings that it has when nothing is said."""
    found = next(each for each in SHIPPED if each.name == name)
    return found.of(None if found.settings is None else found.settings())
