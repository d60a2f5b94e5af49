"""A cell of declared devices, without arm or mobile robot: its recipes, proofs, refusals and stops."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.core.cell_states import CellState
from arboleda.core.messages import Reason, TaskState, Verb
from arboleda.core.model import Evidence
from arboleda.kinds.declared import UseError
from arboleda.recipes import Choice, Kit, RecipeError, parallel, recipe, work
from arboleda.views import view

from .lab import EYE, OVEN, Bench, bake, careless, model


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
    kinds = model()
    (cell,) = kinds.cells
    bad = replace(EYE.verbs["look"], answers=("bad",))
    eye = replace(cell.roles["eye"], kind=replace(EYE, verbs={"look": bad}))  # type: ignore[call-arg]
    here = Bench(replace(kinds, cells=(replace(cell, members=(cell.members[0], ("eye", eye))),)))
    here.submit("bench bake 5")
    ended = here.outcome()
    assert (ended.state, str(ended.sentence)) == (TaskState.FAILED, "the sample is bad")
    assert here.told == ["eye look"]


def test_an_answer_that_the_recipe_does_not_know_is_a_failure() -> None:
    @recipe("guess")
    def guess(cell: Kit):  # type: ignore[no-untyped-def]
        seen = cell.device("eye").look()
        return work(seen, cell.choose(seen, {"red": [], "blue": []}))

    here = Bench(model(guess))
    here.submit("bench guess")
    assert str(here.outcome().sentence) == "eye look answered good; the recipe knows red, blue"


def test_what_a_verb_needs_is_refused_where_it_is_not_so() -> None:
    here = Bench(model())
    here.submit("bench careless")
    ended = here.outcome()
    assert (ended.state, ended.reason) == (TaskState.FAILED, Reason.PRECONDITION)
    assert str(ended.sentence) == "oven needs lid to be closed, and said open: no doing bake 5"
    assert "oven bake" not in here.told


def test_a_part_that_is_left_clamped_holds_the_cell_until_somebody_acts() -> None:
    here = Bench(model())
    here.submit("bench careless")
    here.outcome()
    here.wait(2.0)
    assert here.plant.cells["bench"].state is CellState.HELD
    assert "oven may hold a part" in str(here.plant.cells["bench"].held_by)
    assert here.operate(Verb.RELEASE, "oven") is None
    here.wait(2.0)
    assert here.plant.cells["bench"].state is CellState.IDLE


def test_a_process_that_finishes_goes_on_through_a_stop_and_keeps_the_cell_from_the_next_task() -> None:
    here = Bench(model())
    here.submit("bench bake 10")
    assert here.wait(30.0, lambda: here.told[-1:] == ["oven bake"])
    here.wait(2.0)
    assert here.operate(Verb.STOP) is None
    assert here.outcome().reason is Reason.STOPPED
    here.wait(2.0)
    assert here.machines["oven"].busy
    assert here.operate(Verb.CLEAR) is None
    here.wait(1.0)
    assert here.operate(Verb.RESET) is None
    here.operate(Verb.RESUME)
    here.submit("bench bake 5")
    assert str(here.plant.cells["bench"].waiting_for()) == "oven is still doing bake 10"
    assert here.wait(60.0, lambda: not here.machines["oven"].busy)
    assert here.machines["oven"].facts["dose"] == 10


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
    here.lost = lambda command: command.robot == "eye"
    here.submit("bench bake 10")
    ended = here.outcome()
    assert (ended.state, ended.reason) == (TaskState.FAILED, Reason.DEADLINE)
    assert "did not finish within 2.0 s while doing look" in str(ended.sentence)


def test_two_devices_work_at_the_same_time() -> None:
    @recipe("both")
    def both(cell: Kit):  # type: ignore[no-untyped-def]
        oven, eye = cell.devices("oven", "eye")
        return parallel(oven.close(), eye.look())

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
    assert str(here.outcome().sentence) == "oven says closed of lid; open is needed"


@pytest.mark.parametrize(
    ("verb", "values", "sentence"),
    [
        ("opne", {}, "a oven has no verb 'opne'; there are open, close, clamp, bake"),
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
    @recipe("wrong")
    def wrong(cell: Kit):  # type: ignore[no-untyped-def]
        return cell.device("oven").opne()

    here = Bench(model(wrong, bake))
    here.submit("bench wrong")
    ended = here.outcome()
    assert (ended.reason, here.told) == (Reason.INTERNAL, [])
    assert "has no verb 'opne'" in str(ended.sentence)


def test_only_a_step_of_a_device_has_an_answer_to_choose_by() -> None:
    @recipe("wrong")
    def wrong(cell: Kit):  # type: ignore[no-untyped-def]
        return cell.choose(cell.wait(1.0), {"good": []})

    here = Bench(model(wrong))
    here.submit("bench wrong")
    assert "choose looks at the answer of a device's step; wait has none" in str(here.outcome().sentence)


def test_a_wait_names_the_fact_that_never_came() -> None:
    @recipe("wait")
    def waits(cell: Kit):  # type: ignore[no-untyped-def]
        return cell.device("oven").becomes(lid="open", clamped=True, at_most_s=2.0)

    here = Bench(model(waits))
    here.submit("bench wait")
    assert str(here.outcome().sentence) == "oven did not say true of clamped within 2 s"


def test_a_parameter_says_what_it_can_be() -> None:
    with pytest.raises(RecipeError, match="dose needs an annotation"):

        @recipe("blank")
        def blank(cell: Kit, dose):  # type: ignore[no-untyped-def]
            return work()

    assert [each.name for each in bake.parameters] == ["dose"]
    assert careless.parameters == ()
    assert isinstance(Choice[1, 2], Choice)


def test_a_device_cannot_say_what_its_kind_does_not_have() -> None:
    here = Bench(model())
    here.machines["oven"].facts["lid"] = "ajar"
    before = here.plant.dispatcher.ledger.ignored["report"]
    here.wait(1.0)
    assert here.plant.dispatcher.ledger.ignored["report"] > before
    assert here.plant.dispatcher.beliefs["oven"].fact("lid") == "open"


def test_screens_show_a_cell_of_any_devices() -> None:
    here = Bench(model())
    here.submit("bench bake 10")
    here.wait(3.0)
    (cell,) = view.snapshot(here.plant)["cells"]
    assert (cell["oven"], cell["eye"], cell["state"]) == ("oven", "eye", "execute")
    assert [str(row["name"]) for row in cell["tree"]][:3] == ["bake", "main", "system start"]
