"""What becomes of an operator's act is told as it is, and what failed gives way to what is left to do."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from arboleda.core import reasons
from arboleda.model.advice import Hand, sentence
from arboleda.model.cell_states import CellState
from arboleda.model.grips import Grip
from arboleda.model.messages import Fact, Journal, Outcome, Reason, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig import faults
from arboleda.rig.rig import Rig
from arboleda.sim.arm import ArmBody
from arboleda.testing import shipped
from arboleda.views.chronicle import Chronicle
from arboleda.views.view import snapshot

from .lab import VERBS, Bench, model, oven_of
from .tending import plant
from .test_recipes_of_robots import load

NEVER_S = 1000.0
MOST = 6  # acts
LETS_GO = {"oven": "clamp", "jaw": "open"}
HOLDS = {"oven": "clamped", "jaw": "gripped"}
Break = Callable[[Any, str], None]


def machine(name: str) -> Bench:
    return Bench(model() if name == "oven" else plant(load))


def holding(name: str) -> Bench:
    """A cell that is held, as one of its devices holds a part that came from nobody knows where."""
    here = machine(name)
    here.manual.set_facts(name, ((HOLDS[name], True),))
    assert here.wait(5.0, lambda: bool(here.plant.advice(cell_of(here))))
    return here


def cell_of(here: Rig) -> str:
    return next(iter(here.plant.cells))


def refused(here: Bench, name: str) -> None:
    here.machines[name].refuses = lambda goal: "ocupado" if goal.verb == LETS_GO[name] else None


def given_up(here: Bench, name: str) -> None:
    here.machines[name].fails = lambda goal: "atasco" if goal.verb == LETS_GO[name] else None


def never_ended(here: Bench, name: str) -> None:
    here.machines[name].lasts = lambda goal: NEVER_S if goal.verb == LETS_GO[name] else 0.0


def only_said(here: Bench, name: str) -> None:
    here.machines[name].does = lambda goal: goal.verb != LETS_GO[name]


def offline(here: Rig, name: str) -> None:
    here.power_off(name)
    here.wait(5.0)


WAYS: dict[str, Break] = {
    "refused": refused,
    "given up": given_up,
    "never ended": never_ended,
    "only said": only_said,
    "offline": offline,
}


def take_up(here: Rig) -> None:
    """A task has a device hold a part."""
    here.submit(TASKS[cell_of(here)])
    grips = here.plant.dispatcher.effectors.grips
    assert here.wait(120.0, until=lambda: grips[HOLDER[cell_of(here)]] is Grip.ON)


def failed_task(here: Rig, broken: Callable[[], None]) -> None:
    """A task has failed with a part held, and so has the recovery after it, if there was one."""
    take_up(here)
    broken()
    assert here.wait(120.0, until=lambda: here.plant.cells[cell_of(here)].state is CellState.HELD)


def stopped_task(here: Rig, broken: Callable[[], None]) -> None:
    """The cell was stopped with a part held."""
    take_up(here)
    broken()
    assert here.operate(Verb.STOP) is None


def found_part(here: Rig, broken: Callable[[], None]) -> None:
    """The cell rests, and somebody puts a part into what then cannot let go."""
    name, body = held_body(here)
    if isinstance(body, ArmBody):
        body.effector = body.holding = True
        here.wake(name)
    else:
        here.manual.set_facts(name, ((HOLDS[name], True),))
    here.wait(3.0)
    broken()


HOLDER = {"bench": "oven", "tending": "jaw", "sis_a": "ra1"}
TASKS = {"bench": "bench careless", "tending": "tending load feed_2", "sis_a": "sis_a 0B 7"}
BEGINNINGS = {"held": failed_task, "aborted": stopped_task, "idle": found_part}


def held_body(here: Rig) -> tuple[str, Any]:
    board = {"bench": "oven", "tending": "jaw", "sis_a": "ra_1"}[cell_of(here)]
    return board, here.boards[board].body


def is_open(body: Any) -> bool:
    if isinstance(body, ArmBody):
        return not body.effector
    return not body.facts[body.kind.held_fact]


def follow(here: Rig) -> list[str]:
    """Do what is advised first until the cell is ready, or a person is to see to the machine itself."""
    name, acts, (_, body) = cell_of(here), [], held_body(here)
    for _ in range(MOST + 2):
        run = here.plant.cells[name]
        here.wait(120.0, until=lambda run=run: resting(here, run))
        if run.state is CellState.IDLE and run.not_ready is None:
            return acts
        first = here.plant.advice(name)[0]
        if isinstance(first.do, Hand):
            return acts
        assert first.refusal is None, (acts, str(first.refusal))
        if first.by_hand:
            here.manual.take_out(first.scope)
        assert here.operate(first.do, first.scope, by_hand=first.by_hand) is None
        acts.append(f"{first.do.value}{' by hand' if first.by_hand else ''}")
        here.wait(120.0, until=lambda: here.plant.acts[-1].outcome is not Outcome.UNDER_WAY)
        act = here.plant.acts[-1]
        assert act.outcome is not Outcome.UNDER_WAY
        if first.do is Verb.RELEASE and not first.by_hand:
            assert (act.outcome is Outcome.DONE) <= is_open(body), act
            assert (act.outcome is Outcome.FAILED) is (act.why is not None)
    raise AssertionError(f"no way out by {acts}: {reasons.of_waiting(run)}")


def resting(here: Rig, run: Any) -> bool:
    if run.context.commands.open() or run.state in (CellState.EXECUTE, CellState.ABORTING, CellState.HOLDING):
        return False
    ready = run.state is CellState.IDLE and run.not_ready is None
    ways = here.plant.advice(run.cell.name)
    return ready or bool(ways and (isinstance(ways[0].do, Hand) or ways[0].refusal is None))


@pytest.mark.sampled(3)
@pytest.mark.parametrize("beginning", BEGINNINGS)
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", HOLDS)
def test_from_whatever_a_device_cannot_do_at_most_six_acts_lead_out(
    name: str, way: str, beginning: str
) -> None:
    here = machine(name)
    BEGINNINGS[beginning](here, lambda: WAYS[way](here, name))
    assert len(follow(here)) <= MOST


def stuck(here: Rig, board: str) -> None:
    here.boards[board].body.stuck = True


def in_fault(here: Rig, board: str) -> None:
    here.carry = faults.says(board, estado=2)


ARMS = [
    *[(Evidence.IDS, way, beginning) for way in (stuck, in_fault, offline) for beginning in BEGINNINGS],
    # an arm at joints does not report its effector: what is found there, or sticks, nobody learns of
    *[(Evidence.JOINTS, way, beginning) for way in (in_fault, offline) for beginning in ("held", "aborted")],
]


@pytest.mark.parametrize(("evidence", "way", "beginning"), ARMS)
def test_and_so_they_do_from_what_an_arm_cannot_do(evidence: Evidence, way: Break, beginning: str) -> None:
    here = Rig(shipped("sis_a", evidence=evidence))
    here.wait(2.0)
    BEGINNINGS[beginning](here, lambda: way(here, "ra_1"))
    assert len(follow(here)) <= MOST


@pytest.mark.parametrize("way", ["refused", "given up", "never ended", "only said"])
def test_a_release_that_failed_says_why_and_gives_way_to_a_hand(way: str) -> None:
    here = holding("oven")
    WAYS[way](here, "oven")
    assert here.operate(Verb.RELEASE, "oven") is None
    here.wait(10.0)
    act = here.plant.acts[-1]
    assert act.outcome is Outcome.FAILED and str(act.why).startswith("oven: ")
    ends = [each for each in here.sent if isinstance(each, Journal) and each.outcome is not None]
    assert [str(each.sentence) for each in ends] == [f"release oven: failed ({act.why})"]
    told = "release oven --by-hand or release oven, then resume bench"
    assert str(sentence(here.plant.advice("bench"))) == told


def test_an_act_is_under_way_until_its_device_has_ended_it() -> None:
    here, line = holding("oven"), Chronicle()
    here.machines["oven"].lasts = lambda goal: 1.0
    assert here.operate(Verb.RELEASE, "oven") is None
    assert here.answers[-1].outcome is Outcome.UNDER_WAY
    assert here.answers[-1].act == here.plant.acts[-1].number
    line.see(snapshot(here.plant), 0.0)
    here.wait(5.0)
    assert here.plant.acts[-1].outcome is Outcome.DONE
    line.see(snapshot(here.plant), 5.0)
    told = [(each["what"], str(each["sentence"])) for each in line.events if each["kind"] == "operator"]
    assert told == [("did", "release oven"), ("done", "release oven: done")]


def test_a_verb_that_nobody_can_do_by_hand_is_told_as_what_it_is() -> None:
    here = Bench(model())
    assert here.operate(Verb.STOP, "oven", by_hand=True) is None
    assert str(here.plant.acts[-1].sentence) == "stop oven"


def test_a_stop_is_told_as_sent() -> None:
    here = Bench(model())
    assert here.operate(Verb.STOP) is None
    assert here.plant.acts[-1].outcome is Outcome.SENT


def test_what_no_report_can_prove_is_told_as_unchecked() -> None:
    here = Rig(shipped("sis_a", evidence=Evidence.STATE))
    here.wait(2.0)
    assert here.operate(Verb.RELEASE, "ra1") is None
    here.wait(10.0)
    act = here.plant.acts[-1]
    assert (act.outcome, str(act.why)) == (
        Outcome.UNCHECKED,
        "ra1 was told, and does not report whether it did it",
    )


def test_what_a_stop_cut_off_is_no_reason_to_go_to_the_machine() -> None:
    here = holding("oven")
    never_ended(here, "oven")
    assert here.operate(Verb.RELEASE, "oven") is None
    here.power_off("oven")
    here.wait(10.0)
    assert here.plant.acts[-1].outcome is Outcome.FAILED
    here.power_on("oven")
    here.wait(5.0)
    assert (Verb.RELEASE, "oven") not in here.plant.cells["bench"].in_vain


def emptied() -> Bench:
    """Somebody has taken the part out of a clamp that stays shut, and said so."""
    here = holding("oven")
    refused(here, "oven")
    assert here.operate(Verb.RELEASE, "oven", by_hand=True) is None
    here.wait(3.0)
    return here


def test_who_took_a_part_out_is_believed_against_the_word_of_the_device() -> None:
    here = emptied()
    assert here.machines["oven"].facts["clamped"] is True
    assert here.plant.cells["bench"].context.parts.holding == []
    assert "release oven by hand: the part was taken out" in [str(each.sentence) for each in here.plant.acts]
    assert here.plant.cells["bench"].state is CellState.IDLE
    here.crash()
    here.wait(3.0)
    assert here.plant.cells["bench"].context.parts.holding == [], "the next start knows it as well"


def test_the_next_word_of_the_device_itself_counts_again() -> None:
    here = emptied()
    here.manual.set_facts("oven", (("clamped", False),))
    here.wait(1.0)
    assert here.plant.dispatcher.memory.value(Fact.EMPTIED, "oven") is None
    here.manual.set_facts("oven", (("clamped", True),))
    here.wait(1.0)
    assert here.plant.cells["bench"].context.parts.holding == ["oven"]


def test_what_cannot_let_go_as_it_stands_is_emptied_by_hand() -> None:
    oven = oven_of(clamp=replace(VERBS["clamp"], needs={"lid": "open"}))
    here = Bench(model(oven=oven))
    here.manual.set_facts("oven", (("lid", "closed"), ("clamped", True)))
    assert here.wait(5.0, lambda: bool(here.plant.advice("bench")))
    first, second, *_ = here.plant.advice("bench")
    assert (first.do, first.by_hand, first.refusal) == (Verb.RELEASE, True, None)
    assert str(second.refusal) == "oven needs lid to be open, and says closed: it cannot let go"
    assert follow(here) == ["release by hand", "resume"]


def test_nobody_takes_out_what_is_not_held_or_at_work() -> None:
    here = Bench(model())
    said = "no part is known to be in oven"
    assert here.operate(Verb.RELEASE, "oven", by_hand=True) == said
    assert here.operate(Verb.RELEASE, "eye", by_hand=True) == "eye has no effector"
    assert here.operate(Verb.RELEASE, "bench", by_hand=True) == said
    here.submit("bench bake 10")
    assert here.wait(30.0, lambda: bool(here.plant.cells["bench"].context.parts.holding))
    assert "hold or stop it first" in str(here.operate(Verb.RELEASE, "oven", by_hand=True))


def test_a_part_that_was_taken_out_by_hand_is_missing_to_a_held_task() -> None:
    here = Bench(model())
    here.submit("bench bake 10")
    assert here.wait(30.0, lambda: bool(here.plant.cells["bench"].context.parts.holding))
    assert here.operate(Verb.HOLD, "bench") is None
    assert here.wait(60.0, lambda: here.plant.cells["bench"].state is CellState.HELD)
    here.wait(25.0)
    assert here.operate(Verb.RELEASE, "oven", by_hand=True) is None
    trouble = here.plant.cells["bench"].trouble
    assert trouble is not None and trouble.reason is Reason.PART_LOST


def test_of_two_that_hold_both_are_named() -> None:
    (bench,) = model().cells
    oven = bench.roles["oven"]
    second = replace(oven, name="kiln", mqtt="kiln")
    two = replace(bench, members=(("oven", oven), ("kiln", second), ("eye", bench.roles["eye"])))
    here = Bench(replace(model(), cells=(two,)))
    for name in ("oven", "kiln"):
        here.manual.set_facts(name, (("clamped", True),))
    here.wait(5.0)
    assert here.operate(Verb.ABANDON, "bench") == (
        "oven, kiln may each hold a part; release oven and release kiln first"
    )
    told = "release oven, then release kiln, then resume bench"
    assert str(sentence(here.plant.advice("bench"))) == told


def test_a_homing_that_failed_gives_way_to_the_robot_s_own_controls() -> None:
    here = Rig(shipped("sis_a", evidence=Evidence.IDS))
    here.wait(2.0)
    here.crash("ra_1")
    here.wait(3.0)
    body = here.boards["ra_1"].body
    body.home = lambda now_us: None  # it never finds its switches
    first = here.plant.advice("sis_a")[0]
    assert (first.do, first.scope) == (Verb.HOME, "ra1")
    assert here.operate(Verb.HOME, "ra1") is None
    here.wait(300.0, until=lambda: here.plant.acts[-1].outcome is Outcome.FAILED)
    told = [each.do for each in here.plant.advice("sis_a")][:2]
    assert told == [Hand.REFERENCE, Verb.HOME]
