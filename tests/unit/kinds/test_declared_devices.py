"""A cell of declared devices, without arm or mobile robot: its recipes, proofs, refusals and stops."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import pytest

from arboleda.core import reasons
from arboleda.dispatch.ledger import State
from arboleda.kinds import process, query, switch
from arboleda.kinds.declared import FactType, UseError
from arboleda.model.cell_states import CellState
from arboleda.model.grips import Grip
from arboleda.model.messages import Reason, TaskState, Verb
from arboleda.model.plant_model import Evidence
from arboleda.model.sentence import OWN
from arboleda.recipes import Choice, Kit, RecipeError, parallel, recipe, work

from ...plants import device_of, kind_of, made
from .lab import OVEN, VERBS, Bench, bake, careless, model, oven_of


@pytest.mark.parametrize("evidence", [Evidence.IDS, Evidence.JOINTS], ids=lambda level: level.value)
def test_a_task_of_a_recipe_of_ones_own_is_done(evidence: Evidence) -> None:
    here = Bench(model(evidence=evidence))
    here.submit("bench bake 10")
    assert here.outcome().state is TaskState.DONE
    steps = ["oven clamp", "oven close", "oven bake", "oven open", "oven clamp"]
    assert here.told == ["eye look", *steps]
    assert here.machines["oven"].facts == {"lid": "open", "clamped": False, "dose": 10}
    assert here.plant.cells["bench"].state is CellState.IDLE


def test_another_answer_takes_the_other_way() -> None:
    eye = kind_of("eye", {}, look=query(answers=["bad", "good"], takes_s=0.5, at_most_s=2.0))
    here = Bench(model(eye=eye))
    here.submit("bench bake 5")
    ended = here.outcome()
    assert (ended.state, str(ended.sentence)) == (TaskState.FAILED, "the sample is bad")
    assert here.told == ["eye look"]


def test_an_answer_that_the_recipe_does_not_know_is_a_failure() -> None:
    @recipe("guess")
    def guess(cell: Kit):  # type: ignore[no-untyped-def]
        seen = cell.device("eye").look()
        return work(seen, cell.choose(seen, {"good": [], "bad": []}))

    here = Bench(model(guess))
    here.machines["eye"].answer = lambda goal: "odd"
    here.submit("bench guess")
    assert str(here.outcome().sentence) == "eye look answered odd; the recipe knows good, bad"


def test_what_a_verb_needs_is_refused_where_it_is_not_so() -> None:
    here = Bench(model())
    here.submit("bench careless")
    ended = here.outcome()
    assert (ended.state, ended.reason) == (TaskState.FAILED, Reason.PRECONDITION)
    assert str(ended.sentence) == "oven needs lid to be closed, and said open: no doing bake 5"
    assert "oven bake" not in here.told


def test_what_a_verb_needs_is_refused_while_its_device_goes_on_with_work_that_was_given_up() -> None:
    @recipe("airs")
    def airs(cell: Kit):  # type: ignore[no-untyped-def]
        oven = cell.device("oven")
        bake, air = oven.bake(dose=5), oven.air()
        return work(oven.clamp(on=True), oven.close(), cell.fallback(bake, air))

    oven = oven_of(air=process(needs={"lid": "open"}, takes_s=1.0, at_most_s=5.0))
    here = Bench(model(airs, oven=oven))
    here.machines["oven"].lasts = lambda goal: 1000.0 if goal.verb == "bake" else 0.0
    here.submit("bench airs")
    ended = here.outcome()
    assert ended.reason is Reason.PRECONDITION
    assert str(ended.sentence) == "oven needs lid to be open, and said closed: no doing air"
    assert "oven air" not in here.told


@pytest.mark.parametrize("shut", [True, False])
def test_what_a_question_needs_is_refused_where_it_is_not_so(shut: bool) -> None:
    weigh = query(needs={"lid": "closed"}, takes_s=1.0, at_most_s=5.0, answers=["light", "heavy"])

    @recipe("weigh")
    def weighs(cell: Kit):  # type: ignore[no-untyped-def]
        oven = cell.device("oven")
        seen = oven.weigh()
        asked = work(seen, cell.choose(seen, {"light": [], "heavy": []}))
        return work(oven.close(), asked) if shut else asked

    here = Bench(model(weighs, oven=oven_of(weigh=weigh)))
    here.submit("bench weigh")
    ended = here.outcome()
    if shut:
        assert (ended.state, here.told) == (TaskState.DONE, ["oven close", "oven weigh"])
    else:
        assert (ended.state, ended.reason, here.told) == (TaskState.FAILED, Reason.PRECONDITION, [])
        assert str(ended.sentence) == "oven needs lid to be closed, and said open: no doing weigh"


def test_a_process_that_finishes_goes_on_through_a_stop_and_keeps_the_cell_from_the_next_task() -> None:
    here = Bench(model())
    here.submit("bench bake 10")
    assert here.wait(30.0, lambda: here.told[-1:] == ["oven bake"])
    here.wait(2.0)
    assert here.operate(Verb.STOP) is None
    assert here.outcome().reason is Reason.STOPPED
    here.wait(2.0)
    assert here.machines["oven"].moving
    assert here.operate(Verb.CLEAR) is None
    here.wait(1.0)
    assert here.operate(Verb.RESET) is None
    here.operate(Verb.RESUME)
    here.submit("bench bake 5")
    assert str(reasons.of_waiting(here.plant.cells["bench"])) == "oven is still doing bake 10"
    assert here.wait(60.0, lambda: not here.machines["oven"].moving)
    assert here.machines["oven"].facts["dose"] == 10


@pytest.mark.parametrize("evidence", [Evidence.IDS, Evidence.JOINTS], ids=lambda level: level.value)
def test_a_step_waits_for_a_process_that_finishes_and_that_the_recipe_has_left(evidence: Evidence) -> None:
    @recipe("hurry")
    def hurry(cell: Kit):  # type: ignore[no-untyped-def]
        oven = cell.device("oven")
        baking = cell.fallback(cell.timeout(oven.bake(dose=10), 3.0), cell.wait(0.1))
        return work(oven.clamp(on=True), oven.close(), baking, oven.open(), oven.clamp(on=False))

    here = Bench(model(hurry, evidence=evidence))
    here.submit("bench hurry")
    assert here.outcome().state.value == "done"
    assert here.machines["oven"].facts == {"lid": "open", "clamped": False, "dose": 10}


@pytest.mark.parametrize("evidence", list(Evidence), ids=lambda level: level.value)
def test_a_process_that_finishes_while_its_device_is_stopped_is_seen_to_end(evidence: Evidence) -> None:
    heat = made("heat", lambda cell: work(cell.device("oven").bake(dose=10)))
    here = Bench(model(heat, evidence=evidence, oven=oven_of(bake=replace(VERBS["bake"], needs={}))))
    here.submit("bench heat")
    here.wait(2.0)
    assert here.operate(Verb.STOP) is None
    ledger = here.plant.dispatcher.ledger
    (entry,) = ledger.of_robot("oven")
    assert here.wait(60.0, lambda: not here.machines["oven"].moving)
    assert here.wait(1.0, lambda: not ledger.of_robot("oven"))
    assert entry.state is State.DONE


def test_a_motion_is_halted_by_a_stop() -> None:
    here = Bench(model())
    here.submit("bench bake 10")
    assert here.wait(30.0, lambda: here.told[-1:] == ["oven close"])
    here.wait(0.5)
    assert here.operate(Verb.STOP) is None
    here.wait(1.0)
    assert here.machines["oven"].facts["lid"] == "open"
    assert here.plant.cells["bench"].state is CellState.ABORTED


def test_a_question_that_nobody_answers_fails_in_its_time() -> None:
    here = Bench(model())
    here.lost = lambda publication: publication.topic == "eye/orden"
    here.submit("bench bake 10")
    ended = here.outcome()
    assert (ended.state, ended.reason) == (TaskState.FAILED, Reason.DEADLINE)
    assert "did not finish within 2.0 s while doing look" in str(ended.sentence)


def test_two_devices_work_at_the_same_time() -> None:
    both = made("both", lambda cell, oven, eye: parallel(oven.close(), eye.look()))
    here = Bench(model(both))
    here.submit("bench both")
    assert here.outcome().state is TaskState.DONE
    assert here.told == ["oven close", "eye look"]
    assert here.now < 1.5


def test_a_recipe_waits_for_a_fact_and_checks_one() -> None:
    @recipe("wait")
    def waits(cell: Kit):  # type: ignore[no-untyped-def]
        oven = cell.device("oven")
        return work(oven.says(lid="open"), oven.becomes(lid="closed", at_most_s=5.0))

    here = Bench(model(waits))
    here.submit("bench wait")
    here.wait(2.0)
    here.machines["oven"].facts["lid"] = "closed"
    assert here.outcome().state is TaskState.DONE
    here.submit("bench wait")
    refused = here.outcome()
    assert str(refused.sentence) == "oven says closed of lid; open is needed"
    assert refused.reason is Reason.PRECONDITION


@pytest.mark.parametrize(
    ("verb", "values", "sentence"),
    [
        ("opne", {}, "a oven has no verb 'opne'; there are open, close, clamp, bake; did you mean open?"),
        ("bake", {}, "bake of a oven needs dose: 5, 10, 20"),
        ("bake", {"dose": 7}, "dose of bake is 7; a oven takes 5, 10, 20"),
        ("clamp", {"on": "yes"}, "on of clamp is 'yes'; a oven takes true or false"),
        ("open", {"wide": True}, "open of a oven has no 'wide'; its values: none"),
    ],
)
def test_a_wrong_word_is_named_with_what_is_allowed(verb: str, values: dict[str, int], sentence: str) -> None:
    with pytest.raises(UseError) as wrong:
        OVEN.command(id="1", robot="oven", verb=verb, values=values)
    assert str(wrong.value) == sentence


def test_a_recipe_with_a_wrong_word_fails_its_task_and_nothing_else() -> None:
    wrong = made("wrong", lambda cell: cell.device("oven").opne())
    here = Bench(model(wrong, bake))
    here.submit("bench wrong")
    ended = here.outcome()
    assert (ended.reason, here.told) == (Reason.INTERNAL, [])
    assert "has no verb 'opne'" in str(ended.sentence)


def test_only_a_step_of_a_device_has_an_answer_to_choose_by() -> None:
    wrong = made("wrong", lambda cell: cell.choose(cell.wait(1.0), {"good": []}))
    here = Bench(model(wrong))
    here.submit("bench wrong")
    assert "choose looks at the answer of a device's step; wait has none" in str(here.outcome().sentence)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (
            lambda cell: cell.device("ovne"),
            "no device in the role 'ovne'; there are oven, eye; did you mean oven?",
        ),
        (lambda cell: cell.device("oven").says(lid="ajar"), "lid is never 'ajar'; a oven says open, closed"),
        (
            lambda cell: cell.device("oven").becomes(dose=7, at_most_s=1),
            "dose is never 7; a oven says 5, 10, 20",
        ),
    ],
    ids=["role", "value", "awaited"],
)
def test_what_cannot_be_is_told_before_anything_moves(make: Callable[[Kit], Any], sentence: str) -> None:
    wrong = made("wrong", make)
    here = Bench(model(wrong))
    here.submit("bench wrong")
    assert sentence in str(here.outcome().sentence)
    assert here.told == []


def test_a_whole_number_is_a_number_too() -> None:
    volume = FactType(type=float, first=0.0)
    assert volume.takes(5) and volume.takes(0.5)
    assert not volume.takes(True) and not volume.takes("5")


def test_a_part_is_let_go_by_the_verb_that_does_so() -> None:
    grip, let_go = (switch(sets={"clamped": on}, at_most_s=2.0, holds_part=True) for on in (True, False))
    kind = kind_of("vise", {"clamped": bool}, grip=grip, open=let_go)
    assert device_of(kind, "v").let_go(id="1") == kind.command(id="1", robot="v", verb="open", values={})


def test_a_wait_names_the_fact_that_never_came() -> None:
    waits = made("wait", lambda cell: cell.device("oven").becomes(lid="open", clamped=True, at_most_s=2.0))
    here = Bench(model(waits))
    here.submit("bench wait")
    assert str(here.outcome().sentence) == "oven did not say true of clamped within 2 s"


def test_a_parameter_says_what_it_can_be() -> None:
    with pytest.raises(RecipeError, match="dose needs what it can be"):

        @recipe("blank")
        def blank(cell: Kit, dose):  # type: ignore[no-untyped-def]
            return work()

    assert [each.name for each in bake.parameters] == ["dose"]
    assert careless.parameters == ()
    assert isinstance(Choice[1, 2], Choice)


def test_a_device_cannot_say_what_its_kind_does_not_have() -> None:
    here = Bench(model())
    here.machines["oven"].facts["lid"] = "ajar"
    here.wait(1.0)
    counted = here.bridge.counters["oven"]
    assert counted.refused > 0
    assert str(counted.last) == "oven/sensores: datos.lid is 'ajar'; allowed: open, closed"
    assert here.plant.dispatcher.beliefs["oven"].fact("lid") == "open"


def test_a_link_that_is_lost_tells_nothing_of_what_a_device_holds() -> None:
    here = Bench(model())
    here.machines["oven"].lasts = lambda goal: 60.0
    here.submit("bench bake 5")
    assert here.wait(5.0, lambda: here.told[-1:] == ["oven clamp"])
    here.power_off("oven")
    assert here.outcome().reason is Reason.LINK_LOST
    assert here.plant.dispatcher.effectors.grips["oven"] is Grip.SWITCHING
    here.power_on("oven")
    here.wait(2.0)
    assert here.plant.dispatcher.effectors.grips["oven"] is Grip.OFF


def test_a_second_switch_of_a_fact_is_refused_while_the_first_is_open() -> None:
    here = Bench(model())
    here.wait(1.0)
    make = partial(OVEN.command, robot="oven", verb="clamp")
    send = partial(here.plant.dispatcher.send, cell="bench", doing=OWN(text="clamping"), now=here.now)
    first = send(partial(make, values={"on": True}))
    second = send(partial(make, values={"on": False}))
    assert first.open
    assert second.failure is not None and second.failure.reason is Reason.REJECTED
    assert str(second.failure.sentence) == "oven had not ended switching clamped: no clamping"
    here.wait(2.0)
    assert not first.open
    assert send(partial(make, values={"on": False})).failure is None
