"""The simulation that a test drives: what it asks for, what it sees, how it reads when something is wrong."""

from __future__ import annotations

from collections.abc import Iterable

import pytest
from py_trees.behaviour import Behaviour
from py_trees.composites import Sequence
from tests.unit.kinds.tending import plant

from arboleda.model.task import Order
from arboleda.recipes import Kit, recipe, work
from arboleda.recipes.storage import storage
from arboleda.testing import shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.trees.context import Context
from arboleda.trees.leaves import Dwell
from arboleda_proofs.simulator.invariants.invariant import Look, Trigger, invariant
from arboleda_proofs.testing import Misuse, Sim


@recipe("thrice")
def thrice(cell: Kit):  # type: ignore[no-untyped-def]
    left = cell.device("left")
    return cell.repeat(work(left.go("feed_2"), left.home()), 3)


@pytest.fixture
def sim() -> Sim:
    """A simulation of one shipped cell."""
    sim = Sim()
    sim.plant(shipped("sis_a"))
    return sim


@invariant(Trigger.EXECUTED)
def nobody_moves(look: Look) -> Iterable[str]:
    """Nothing is ever carried out."""
    yield from (f"{board} does something" for board, _ in look.moment.executed)


def test_a_task_is_followed_to_its_end(sim: Sim) -> None:
    task = sim.submit("sis_a 0B 7")
    assert (task.state, task.ended) == ("running", False)
    sim.run(until=lambda: task.ended)
    assert task.history == ["queued", "running", "done"]
    assert task.id is not None
    assert sim.now == pytest.approx(8.47, abs=0.1)


def test_a_step_that_a_recipe_repeats_may_give_its_command_in_each_turn() -> None:
    sim = Sim()
    sim.plant(plant(thrice))
    task = sim.submit("tending thrice")
    sim.run(until=lambda: task.ended)
    assert task.state == "done"


def test_a_refused_text_is_a_handle_too(sim: Sim) -> None:
    task = sim.submit("sis_a 0X 7")
    assert (task.id, task.state, task.ended, task.history) == (None, "refused", True, ["refused"])
    assert "'0X' is not a path of sis_a" in task.sentence


def test_two_requests_for_one_id_are_one_task(sim: Sim) -> None:
    first, second = sim.submit("sis_a 0B 7 #lot"), sim.submit("sis_a 0B 7 #lot")
    sim.run(until=lambda: first.ended)
    assert (first.id, first.state, second.id, second.state) == ("lot", "done", "lot", "done")


def test_a_waiting_task_says_for_what(sim: Sim) -> None:
    sim.submit("sis_a 0B 7")
    waiting = sim.submit("sis_a 1B 7")
    assert (waiting.state, waiting.sentence) == ("queued", "sis_a is busy")
    assert sim.cell("sis_a").queue == (waiting.id,)


def test_an_operator_is_obeyed_or_refused(sim: Sim) -> None:
    assert sim.operate("stop") is None
    assert sim.cell("sis_a").state == "aborting"
    assert sim.operate("stop", "sis_x") == (
        "'sis_x' is neither a cell nor a robot of this plant; there are sis_a, ra1, rm_sis_a"
    )


def test_a_plant_that_stands_still_does_not_answer(sim: Sim) -> None:
    sim.fault("plant_stall", seconds=2.0)
    task = sim.submit("sis_a 0B 7")
    assert (task.state, sim.operate("stop")) == ("asked", "the plant did not answer")
    sim.run(3.0)
    assert (task.state, sim.cell("sis_a").state) == ("queued", "aborted")


def test_a_robot_is_where_it_is_and_not_where_it_is_believed_to_be(sim: Sim) -> None:
    task = sim.submit("sis_a 0B 7")
    sim.fault("lost_steps", "ra1", word="q2", amount=50)
    sim.run(until=lambda: task.ended)
    arm = sim.robot("ra_1")
    assert arm.name == "ra1"
    assert arm.believed_joints == pytest.approx((0, 0, 0))
    assert arm.joints == pytest.approx((0, 45, 0))
    assert (arm.node, arm.effector, arm.holds, arm.homed) == (None, False, False, True)
    assert (sim.robot("rm_sis_a").node, sim.robot("rm_sis_a").believed_node) == (7, 7)


def test_a_prismatic_joint_is_in_millimetres() -> None:
    sim = Sim()
    pickup = StorageLayout(sim.plant().cell("sis_a")).pickup
    assert pickup.q[2] == 0.0
    assert sim.snapshot()["robots"][0]["units"] == ["rad", "rad", "m"]
    sim.fault("lost_steps", "ra1", word="q3", amount=1)
    assert sim.robot("ra1").joints == pytest.approx((0, 0, 0.353), abs=1e-3)


def test_a_cell_tells_its_step(sim: Sim) -> None:
    task = sim.submit("sis_a 0B 7")
    sim.run(1.0)
    cell = sim.cell("sis_a")
    assert (cell.state, cell.task, cell.step) == ("execute", task.id, "drive path 0B")


def test_at_rest_all_faults_are_over_and_cells_go_again(sim: Sim) -> None:
    task = sim.submit("sis_a 0B 7")
    sim.fault("mute", "ra1", at=4.0)
    sim.run(until=lambda: task.ended)
    assert sim.cell("sis_a").state == "held"
    sim.rest()
    assert sim.cell("sis_a").state == "idle"
    assert sim.world.faults_active == 0


def test_a_broken_invariant_is_told_with_its_rule_and_what_led_to_it(
    sim: Sim, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("arboleda_proofs.simulator.judged.INVARIANTS", (nobody_moves,))
    sim = Sim()
    sim.submit("sis_a 0B 7")
    with pytest.raises(AssertionError) as breach:
        sim.run(1.0)
    lines = str(breach.value).splitlines()
    assert lines[:2] == [
        "nobody_moves is broken at 0.200 s: rm_sis_a does something",
        "must hold: Nothing is ever carried out.",
    ]
    last = "     0.200  rm_sis_a   carries out PathGoal nodes=(0, 3, 4, 7) seq=1 epoch=1001 heard=3"
    assert lines[-1] == f"{last} token=53890d000401"


def test_an_invariant_may_be_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("arboleda_proofs.simulator.judged.INVARIANTS", (nobody_moves,))
    sim = Sim()
    sim.without("nobody_moves")
    task = sim.submit("sis_a 0B 7")
    sim.run(until=lambda: task.ended)
    assert task.state == "done"


def test_an_exception_of_the_plant_breaks_an_invariant(sim: Sim) -> None:
    sim.world.at(sim.now + 101.0, lambda _: {}["nothing"])
    with pytest.raises(
        AssertionError, match=r"no_exception is broken at 1\.000 s: KeyError: 'nothing'"
    ) as breach:
        sim.run(2.0)
    assert isinstance(breach.value.__cause__, KeyError)


def test_an_exception_of_the_test_stays_what_it_is(sim: Sim) -> None:
    with pytest.raises(KeyError, match="mine"):
        sim.run(until=lambda: {}["mine"])
    sim.run(1.0)


def test_what_never_comes_true_is_told_with_tasks_and_cells(sim: Sim) -> None:
    task = sim.submit("sis_a 0B 7")
    with pytest.raises(AssertionError) as failure:
        sim.run(until=lambda: task.state == "failed", at_most=30)
    assert str(failure.value).splitlines()[:4] == [
        "what the test waits for did not come true in 30 s",
        "task 'sis_a 0B 7': done",
        "cell sis_a: idle",
        "",
    ]
    assert sim.now == 30.0


def test_the_timeline_rounds_and_is_cut(sim: Sim) -> None:
    for _ in range(4):
        sim.submit("sis_a 0B 7")
    with pytest.raises(AssertionError) as failure:
        sim.run(until=lambda: False, at_most=60)
    told = str(failure.value).splitlines()
    assert (
        f"the last 40 things that happened, with the time in s; sim.timeline() has {len(sim.timeline())}:"
        in told
    )
    assert "q=(0.7854, 0.1745, 0.0)" in str(failure.value)


def unhurried(order: Order, context: Context) -> Behaviour:
    """The shipped recipe after a rest."""
    children = [Dwell("rest", context.time, 3.0), storage.build(order, context)]
    return Sequence("unhurried", memory=True, children=children)


def test_a_recipe_of_ones_own_carries_tasks_out(sim: Sim) -> None:
    sim.recipe("storage", unhurried)
    task = sim.submit("sis_a 0B 7")
    assert sim.cell("sis_a").step == "unhurried"
    sim.run(until=lambda: task.ended)
    assert task.state == "done"
    assert sim.now == pytest.approx(11.47, abs=0.1)


def test_a_recipe_of_ones_own_outlives_the_plant_process(sim: Sim) -> None:
    sim.recipe("storage", unhurried)
    sim.run(1.0)
    sim.fault("plant_crash")
    sim.submit("sis_a 0B 7")
    assert sim.cell("sis_a").step == "unhurried"


def test_a_recipe_that_raises_breaks_an_invariant_or_fails_its_task(sim: Sim) -> None:
    sim.recipe("storage", lambda order, context: {}["wrong"])
    try:
        task = sim.submit("sis_a 0B 7")
    except AssertionError as breach:
        assert "KeyError in the tree: 'wrong'" in str(breach)
    else:
        assert task.reason == "internal"


@pytest.mark.long
def test_seeds_hold(sim: Sim) -> None:
    sim.seeds(2, cycles=3, faults="few")


def test_a_seed_that_breaks_is_shrunk_and_told(monkeypatch: pytest.MonkeyPatch) -> None:
    @invariant(Trigger.SENT)
    def nothing_fails(look: Look) -> Iterable[str]:
        """No task ever fails."""
        yield from (each.text for each in look.moment.sent if getattr(each, "reason", None))

    monkeypatch.setattr("arboleda_proofs.simulator.judged.INVARIANTS", (nothing_fails,))
    sim = Sim()
    sim.plant(shipped("sis_a"))
    with pytest.raises(AssertionError) as failure:
        sim.seeds(20, cycles=10)
    told = str(failure.value)
    assert told.startswith("seed ")
    assert "must hold: No task ever fails." in told
    assert " enough:\n" in told
    seed = told.split()[1].rstrip(":")
    assert f"to see it again: sim.seeds(1, first={seed}, cycles=10, faults='normal')" in told
    assert "FAULT" in told


WRONG = {
    "kind": (
        lambda sim: sim.fault("rebot", "ra1"),
        "'rebot' is not a kind of fault",
        "did you mean 'reboot'?",
    ),
    "target": (
        lambda sim: sim.fault("reboot", "ra9"),
        "'ra9' is not what reboot can befall",
        "ra_1, rm_sis_a",
    ),
    "no target": (lambda sim: sim.fault("reboot"), "reboot needs a target; there are ra_1, rm_sis_a", ""),
    "word": (
        lambda sim: sim.fault("reboot", "ra1", word="maybe"),
        "reboot of 'ra_1' knows no 'maybe'",
        "allowed",
    ),
    "past": (lambda sim: sim.fault("reboot", "ra1", at=-1), "0 or more; is -1", ""),
    "seconds": (lambda sim: sim.fault("mute", "ra1", seconds=-1), "at and seconds are 0 or more", ""),
    "verb": (lambda sim: sim.operate("hodl"), "'hodl' is not a verb; there are stop, clear", "'hold'?"),
    "cell": (lambda sim: sim.cell("sis_b"), "'sis_b' is not a cell of this plant; there are sis_a", ""),
    "robot": (lambda sim: sim.robot("ra"), "'ra' is not a robot of this plant; there are ra1, rm_sis_a", ""),
    "recipe": (lambda sim: sim.recipe("stor", None), "'stor' is not a recipe; there are storage", ""),
    "invariant": (lambda sim: sim.without("all"), "'all' is not an invariant", ""),
    "level": (lambda sim: sim.seeds(1, faults="lots"), "'lots' is not a level of faults; there are none", ""),
    "nothing to run": (lambda sim: sim.run(), "one of them is needed", ""),
    "backwards": (lambda sim: sim.run(-1), "time only passes: seconds is 0 or more, is -1", ""),
    "file": (lambda sim: sim.plant("nowhere.yaml"), "nowhere.yaml: there is no such file", ""),
}


@pytest.mark.parametrize(("ask", "sentence", "hint"), WRONG.values(), ids=WRONG)
def test_what_means_nothing_gets_one_sentence(sim: Sim, ask, sentence: str, hint: str) -> None:
    with pytest.raises(Misuse) as refusal:
        ask(sim)
    assert sentence in str(refusal.value)
    assert hint in str(refusal.value)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("choice", [("plant", None), ("recipe", "storage", storage.build), ("without",)])
def test_what_is_simulated_is_chosen_before_it_starts(sim: Sim, choice: tuple[object, ...]) -> None:
    sim.run(1.0)
    name, *arguments = choice
    with pytest.raises(Misuse, match=f"sim.{name} comes before the simulation starts"):
        getattr(sim, str(name))(*arguments)


def test_a_device_answers_as_a_test_has_prepared() -> None:
    sim = Sim()
    sim.plant("examples/lab_bench/plant.yaml")
    sim.answers("scale", "weigh", "short")
    states = []
    for _ in range(2):
        task = sim.submit("bench weigh 10")
        sim.run(until=lambda task=task: task.ended)
        states.append(task.state)
    assert states == ["failed", "done"]


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        (("scale", "weigh", "much"), "scale weigh never answers 'much'; its answers are enough, short"),
        (("scale", "tare", "enough"), "'tare' is not a verb by which scale is asked; there are weigh"),
        (
            ("operator", "ask", "yes"),
            "operator is asked nothing; a person answers by sim.operate('answer', ...)",
        ),
    ],
)
def test_an_answer_that_a_device_never_gives_is_a_misuse(asked: tuple[str, str, str], sentence: str) -> None:
    sim = Sim()
    sim.plant("examples/lab_bench/plant.yaml")
    with pytest.raises(Misuse) as error:
        sim.answers(*asked)
    assert str(error.value).startswith(sentence)
