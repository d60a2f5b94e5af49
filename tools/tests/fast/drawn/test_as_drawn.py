"""Meaning of a drawn recipe, and the deeds of its tasks, judged by the data that it is written from."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from arboleda.recipes.decorators import Times
from arboleda_drawn.as_drawn import NAME
from arboleda_drawn.devices.meaning import Meaning, Unsure, plain
from arboleda_drawn.devices.steps import (
    Ask,
    Choose,
    Fail,
    Fallback,
    Invert,
    Parallel,
    Param,
    Recipe,
    Recover,
    Repeat,
    Retry,
    Run,
    Says,
    Step,
    Tell,
    Timeout,
    Value,
    Wait,
    Work,
)
from arboleda_drawn.plants import of_devices
from arboleda_proofs.campaigns.setting import Setting
from arboleda_trees.bt_xml.running.device_steps import DeviceStep

from ...mutants.mutant import edit

OPEN, CLOSE = Tell(role="oven", verb="open"), Tell(role="oven", verb="close")
REFUSED = Tell(role="oven", verb="open", refused=True)
ASKED = Ask(role="ana", question="Again?", answers=("yes", "no"), at_most_s=9.0, answer="a1")
BY_ANSWER = Choose(answer="a1", ways=(("yes", OPEN), ("no", Fail(sentence="no"))))
FAILING = Work(steps=(OPEN, Fail(sentence="so")))
TOO_LATE = Work(steps=(OPEN, Timeout(step=Wait(seconds=2), seconds=1)))
FOUR_S = {("open", ()): 4.0}


def told(step: Step, **answers: Sequence[Value]) -> tuple[bool, list[str]]:
    """True if a recipe of this step succeeds, and the verbs that it tells the oven."""
    meaning = Meaning([Recipe(name="it", parameters=(), step=step)], answers, lambda role, told: FOUR_S[told])
    return meaning.run("it", {}), [verb for verb, _ in meaning.orders.get("oven", [])]


@pytest.mark.parametrize(
    ("step", "succeeds", "verbs"),
    [
        (Work(steps=(OPEN, Wait(seconds=1), CLOSE)), True, ["open", "close"]),
        (Work(steps=(OPEN, Fail(sentence="so"), CLOSE)), False, ["open"]),
        (Repeat(step=OPEN, times=3), True, ["open"] * 3),
        (Retry(step=FAILING, times=2, pause_s=0), False, ["open"] * 3),
        (Retry(step=OPEN, times=2, pause_s=0), True, ["open"]),
        (Retry(step=FAILING, times=2, pause_s=0, causes=("deadline",)), False, ["open"]),
        (Retry(step=FAILING, times=2, pause_s=0, causes=("deadline", "rejected")), False, ["open"] * 3),
        (Retry(step=TOO_LATE, times=1, pause_s=0, causes=("deadline",)), False, ["open"] * 2),
        (Fallback(steps=(Timeout(step=OPEN, seconds=2), CLOSE)), True, ["open", "close"]),
        (Fallback(steps=(OPEN, REFUSED)), True, ["open"]),
        (Fallback(steps=(Says(role="oven", fact="lit", value=True), CLOSE)), True, ["close"]),
        (Timeout(step=OPEN, seconds=2), False, ["open"]),
        (Timeout(step=OPEN, seconds=9), True, ["open"]),
        (Recover(work=Fail(sentence="so"), rescue=CLOSE), False, ["close"]),
        (Recover(work=OPEN, rescue=CLOSE), True, ["open"]),
        (Parallel(branches=(OPEN, Wait(seconds=1))), True, ["open"]),
        (Parallel(branches=(Work(steps=(Wait(seconds=1), Fail(sentence="so"))), OPEN)), False, ["open"]),
        (Work(steps=(Invert(step=REFUSED), CLOSE)), True, ["close"]),
        (Work(steps=(REFUSED, CLOSE)), False, []),
    ],
)
def test_what_a_step_means(step: Step, succeeds: bool, verbs: list[str]) -> None:
    assert told(step) == (succeeds, verbs)


@pytest.mark.parametrize(
    ("step", "cause"),
    [
        (Work(steps=(Fallback(steps=(Fail(sentence="a"), OPEN)), Fail(sentence="b"))), "b"),
        (Recover(work=Fail(sentence="a"), rescue=Fallback(steps=(Fail(sentence="b"), CLOSE))), "a"),
        (Work(steps=(Invert(step=Fail(sentence="a")), Timeout(step=OPEN, seconds=2))), None),
        (Work(steps=(Invert(step=Fail(sentence="a")), REFUSED)), None),
    ],
)
def test_the_words_of_the_step_that_failed_last(step: Step, cause: str | None) -> None:
    meaning = Meaning([Recipe(name="it", parameters=(), step=step)], {}, lambda role, told: FOUR_S[told])
    assert not meaning.run("it", {})
    assert meaning.cause == cause


def test_each_turn_goes_by_its_own_answer() -> None:
    again = Retry(step=Work(steps=(CLOSE, ASKED, BY_ANSWER)), times=5, pause_s=0)
    assert told(again, ana=["no", "no", "yes"]) == (True, ["close", "close", "close", "open"])


@pytest.mark.parametrize(
    "step",
    [ASKED, Parallel(branches=(OPEN, Fail(sentence="so"))), Timeout(step=OPEN, seconds=FOUR_S["open", ()])],
)
def test_what_nobody_can_say_is_not_judged(step: Step) -> None:
    with pytest.raises(Unsure):
        told(step)


def test_a_recipe_within_another_has_values_of_its_own() -> None:
    inner = Recipe(
        name="inner", parameters=(), step=Tell(role="oven", verb="heat", values=(("to", Param(name="p1")),))
    )
    outer = Recipe(name="outer", parameters=(), step=Run(recipe="inner", values=(("p1", Param(name="p2")),)))
    meaning = Meaning([inner, outer], {}, lambda role, told: 0.0)
    assert meaning.run("outer", {"p2": "7"})
    assert meaning.orders == {"oven": [("heat", (7.0,))]}


@pytest.mark.parametrize(
    ("value", "read"), [(True, 1.0), ("false", 0.0), (3, 3.0), ("-1.25", -1.25), ("ñandú", "ñandú")]
)
def test_values_are_read_alike_in_both_forms(value: object, read: object) -> None:
    assert plain(value) == read


class _Devices:
    of = staticmethod(of_devices)


@pytest.mark.long
def test_a_recipe_that_does_other_than_was_drawn_is_found() -> None:
    setting = Setting(plants=_Devices(), cycles=2, level="none")
    with pytest.MonkeyPatch.context() as patch:
        edit(Times.update, "self.done >= self.times", "self.done >= self.times - 1").make(patch)
        broken = setting.run(8).broken
    assert broken is not None and broken.invariant == NAME
    assert setting.run(8).broken is None


@pytest.mark.long
def test_a_verb_with_values_that_no_recipe_has_is_found_whatever_goes_wrong() -> None:
    setting = Setting(plants=_Devices(), cycles=4, level="many")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(DeviceStep, "prepare", lambda self: None)  # it keeps the values it was built with
        broken = setting.run(112).broken
    assert broken is not None and "no recipe has" in broken.sentence
