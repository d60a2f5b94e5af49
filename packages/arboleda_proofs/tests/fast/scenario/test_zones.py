"""Shared zones over the whole chain: never two arms in one, whatever falls silent, restarts or is stopped."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import pytest
from py_trees.common import Status
from tests.following import advised, follow, works
from tests.lengths import sample
from tests.scenario.restarts import crash_without_trail

from arboleda.core import reasons
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Fact, Journal, Reason, TaskState, Verb
from arboleda.model.plant_model import Evidence, PlantModel
from arboleda.plant_file.loader import load
from arboleda.rig import faults
from arboleda.testing import Rig, slowed
from arboleda.views.zone_rows import zone_rows
from arboleda_proofs.testing import Witness

ZONES = """
zones:
  centre:
    poses: [sis_a pickup, sis_b pickup, sis_c pickup]
  rack:
    poses: [sis_a station 4, sis_b station 4]
  aisle:
    poses: [sis_b station 5, sis_c station 4]
    moves: [[sis_a home, sis_a station 7]]
"""
CELLS = ("sis_a", "sis_b", "sis_c")
WAIT_S = 40.0  # zone_wait_s of every cell
HASTE_S = 1.0  # the same, of hasty cells
Plants = Callable[..., PlantModel]
levels = pytest.mark.parametrize("evidence", list(Evidence))
supervised = pytest.mark.parametrize("evidence", [Evidence.IDS, Evidence.JOINTS])


@pytest.fixture
def zoned(tmp_path: Path) -> Plants:
    """The shipped plant with three zones that its three arms share, its arms so many times slower."""

    def make(evidence: Evidence, slower: float = 2.0) -> PlantModel:
        text = files("arboleda").joinpath("plants/plant.yaml").read_text()
        text = text.replace("evidence: ids", f"evidence: {evidence.value}")
        text = text.replace("    home: {", f"    zone_wait_s: {WAIT_S}\n    home: {{")
        path = tmp_path / "plant.yaml"
        path.write_text(text + ZONES)
        return slowed(load(path), slower)

    return make


def start(model: PlantModel) -> tuple[Rig, Witness]:
    rig = Rig(model)
    witness = Witness(rig)
    rig.wait(0.5)
    return rig, witness


def at_rest(rig: Rig) -> bool:
    return rig.plant.at_rest and not any(cell.queue for cell in rig.plant.cells.values())


def zone(rig: Rig, name: str) -> tuple[str, str | None]:
    row = next(row for row in zone_rows(rig.plant.zones) if row["zone"] == name)
    return row["state"], row["robot"]


def meet(rig: Rig, station: int = 7) -> float:
    """ra1 is inside the centre, with its part, and ra2 waits for it; since when."""
    rig.submit(f"sis_a 0B {station}")
    rig.submit("sis_b 0B 7")
    rig.wait_for("sis_b", "take zones")
    since = rig.now
    rig.wait_for("sis_a", f"move to station {station}")
    rig.wait(0.4)
    assert zone(rig, "centre") == ("held", "ra1") and rig.runs("sis_b", "take zones")
    return since


def waits_for(rig: Rig, cell: str) -> str:
    """The sentence of a cell's step on its waiting."""
    return next(
        str(node.feedback)
        for node in rig.plant.cells[cell].run.nodes
        if node.name == "take zones" and node.status is Status.RUNNING
    )


def test_who_waits_for_a_zone_names_its_holder(zoned: Plants) -> None:
    rig, _ = start(zoned(Evidence.IDS))
    meet(rig)
    assert waits_for(rig, "sis_b") == "waits for zone centre, which ra1 holds"


def honest(witness: Witness) -> None:
    assert (witness.collisions, witness.false_successes, witness.illegal) == ([], [], [])


@pytest.mark.sampled(3)
@levels
def test_three_arms_share_three_zones_and_all_their_tasks_are_done(zoned: Plants, evidence: Evidence) -> None:
    rig, witness = start(zoned(evidence))
    waits: set[str] = set()
    rig.watchers.append(lambda: waits.update(robot for robot, _ in rig.plant.zones.queue.waiting))
    texts = [f"{cell} {path} {k}" for k, path in ((4, "0B"), (7, "1C"), (5, "2A")) for cell in CELLS]
    for text in texts:
        rig.submit(text)
    rig.submit("ra2 palletizing")
    assert rig.wait(400.0, until=lambda: at_rest(rig))
    assert {change.state for change in rig.outcomes().values()} == {TaskState.DONE}
    assert waits, "they met"
    assert all(row["state"] == "free" for row in zone_rows(rig.plant.zones))
    assert not rig.disk.facts.get(Fact.QUARANTINE)
    honest(witness)


@pytest.mark.sampled(2)
@supervised
def test_the_zone_of_a_silent_arm_is_quarantined_and_who_waits_gives_up_in_time(
    zoned: Plants, evidence: Evidence
) -> None:
    rig, witness = start(zoned(evidence))
    since = meet(rig)
    rig.lost = faults.from_board("ra_1")
    rig.wait(2.0)
    assert zone(rig, "centre") == ("quarantined", "ra1")
    assert rig.disk.facts[Fact.QUARANTINE]["centre"] == "ra1"
    assert rig.wait(WAIT_S + 20.0, until=lambda: rig.plant.cells["sis_b"].context.failures.first is not None)
    assert rig.now - since == pytest.approx(WAIT_S)
    assert rig.wait(WAIT_S + 20.0, until=lambda: rig.plant.cells["sis_b"].task is None)
    change = list(rig.outcomes().values())[1]
    assert (change.state, change.reason) == (TaskState.FAILED, Reason.ZONE_UNAVAILABLE)
    assert "centre" in str(change.sentence) and "ra2" in str(change.sentence)
    rig.wait(60.0)
    assert zone(rig, "centre") == ("quarantined", "ra1"), "never released by a timeout"
    honest(witness)


@pytest.mark.sampled(4)
@supervised
@pytest.mark.parametrize("gone_s", [2.0, 5.0, 15.0])
def test_a_silent_arm_that_is_seen_outside_again_frees_its_zones(
    zoned: Plants, evidence: Evidence, gone_s: float
) -> None:
    rig, witness = start(zoned(evidence))
    meet(rig, 4)
    rig.lost = lambda publication: publication.topic.startswith("ra_1/")
    rig.wait(gone_s)
    assert zone(rig, "centre") == ("quarantined", "ra1")
    rig.lost = lambda publication: False
    rig.wait(3.0)
    if rig.plant.cells["sis_a"].state is CellState.HELD:
        assert zone(rig, "centre") == ("quarantined", "ra1")
        assert rig.operate(Verb.RETRY, "sis_a") is None
    assert rig.wait(60.0, until=lambda: at_rest(rig))
    states = [change.state for change in rig.outcomes().values()]
    assert states == [TaskState.FAILED, TaskState.DONE]
    assert zone(rig, "centre") == ("free", None)
    honest(witness)


def test_a_rebooted_arm_keeps_its_zones_until_it_is_homed_and_seen_outside(zoned: Plants) -> None:
    rig, witness = start(zoned(Evidence.IDS))
    meet(rig)
    rig.crash("ra_1")
    rig.wait(12.0)
    assert zone(rig, "centre") == ("quarantined", "ra1")
    assert rig.operate(Verb.HOME, "ra1") is None
    assert rig.wait(30.0, until=lambda: zone(rig, "centre") == ("held", "ra2"))
    assert rig.devices.boards["ra_1"].homed
    assert rig.wait(60.0, until=lambda: rig.plant.cells["sis_b"].task is None)
    assert list(rig.outcomes().values())[1].state is TaskState.DONE
    honest(witness)


def test_the_zone_of_an_arm_that_is_being_homed_is_not_overridden(zoned: Plants) -> None:
    rig, witness = start(zoned(Evidence.IDS))
    meet(rig)
    rig.crash("ra_1")
    rig.wait(12.0)
    assert rig.operate(Verb.HOME, "ra1") is None
    assert zone(rig, "centre") == ("quarantined", "ra1")
    assert "ra1 has not given up its work in centre; stop sis_a" in str(rig.operate(Verb.OVERRIDE, "centre"))
    assert rig.wait(30.0, until=lambda: zone(rig, "centre") == ("held", "ra2"))
    honest(witness)


@levels
def test_an_operator_overrides_only_a_quarantine_and_it_is_journalled(
    zoned: Plants, evidence: Evidence
) -> None:
    rig, witness = start(zoned(evidence))
    assert "is free" in str(rig.operate(Verb.OVERRIDE, "centre"))
    meet(rig)
    assert "held by ra1, which still reports" in str(rig.operate(Verb.OVERRIDE, "centre"))
    assert "no zone" in str(rig.operate(Verb.OVERRIDE, "cellar"))
    rig.power_off("ra_1")
    rig.wait(10.0)
    assert zone(rig, "centre") == ("quarantined", "ra1")
    journal = len(rig.sent)
    assert rig.operate(Verb.OVERRIDE, "centre") is None
    assert [str(m.sentence) for m in rig.sent[journal:] if isinstance(m, Journal)] == ["override centre"]
    assert zone(rig, "centre") == ("held", "ra2")
    assert rig.disk.facts[Fact.QUARANTINE]["centre"] == "ra2", "it may be in there if the plant dies now"
    assert rig.wait(60.0, until=lambda: rig.plant.cells["sis_b"].task is None)
    assert list(rig.outcomes().values())[1].state is TaskState.DONE
    assert witness.collisions, "ra1 was in there, and the operator answered for it"
    assert (witness.false_successes, witness.illegal) == ([], [])


def test_an_arm_inside_goes_on_as_soon_as_what_an_override_took_from_it_is_free(zoned: Plants) -> None:
    rig, witness = start(zoned(Evidence.IDS))
    meet(rig, 4)
    rig.lost = lambda publication: publication.topic.startswith("ra_1/")
    rig.wait(10.0)
    assert rig.operate(Verb.OVERRIDE, "centre") is None
    rig.lost = lambda publication: False
    rig.wait(1.0)
    assert (zone(rig, "centre"), zone(rig, "rack")) == (("held", "ra2"), ("quarantined", "ra1"))
    assert rig.operate(Verb.RETRY, "sis_a") is None
    assert rig.wait(30.0, until=lambda: zone(rig, "centre")[1] != "ra2")
    assert zone(rig, "centre")[1] == "ra1"
    assert rig.wait(30.0, until=lambda: at_rest(rig))
    assert (witness.false_successes, witness.illegal) == ([], [])


@pytest.mark.sampled(2)
@levels
def test_a_crash_of_the_plant_keeps_the_zones_of_an_arm_inside(zoned: Plants, evidence: Evidence) -> None:
    rig, witness = start(zoned(evidence))
    meet(rig, 4)
    crash_without_trail(rig)
    rig.wait(5.0)
    assert (zone(rig, "centre"), zone(rig, "rack")) == (("quarantined", "ra1"), ("quarantined", "ra1"))
    rig.submit("sis_b 0B 7")
    rig.wait(10.0)
    assert rig.runs("sis_b", "take zones")
    assert rig.plant.cells["sis_a"].state is CellState.HELD, "it holds a part"
    assert rig.operate(Verb.RETRY, "sis_a") is None
    assert rig.wait(60.0, until=lambda: at_rest(rig))
    assert list(rig.outcomes().values())[-1].state is TaskState.DONE
    assert (zone(rig, "centre"), witness.part["ra1"]) == (("free", None), "pick-up")
    honest(witness)


def test_an_arm_outside_for_which_only_a_part_of_its_zones_was_kept_asks_for_all_of_them(
    zoned: Plants,
) -> None:
    """The plant dies as it keeps who holds them."""
    rig, witness = start(zoned(Evidence.IDS))
    rig.submit("sis_a 0B 7")
    rig.submit("sis_b 0B 4")
    rig.wait_for("sis_b", "take zones")
    rig.disk.facts[Fact.QUARANTINE] |= {"rack": "ra2"}
    rig.crash()
    rig.wait(2.0)
    assert zone(rig, "rack") == ("quarantined", "ra2")
    for name in ("sis_a", "sis_b"):
        assert rig.operate(Verb.RESUME, name) is None
    assert rig.wait(WAIT_S, until=lambda: at_rest(rig))
    assert {change.state for change in rig.outcomes().values()} == {TaskState.DONE}
    honest(witness)


@pytest.mark.sampled(3)
@levels
def test_after_a_crash_an_empty_arm_is_homed_out_of_the_zones(zoned: Plants, evidence: Evidence) -> None:
    rig, witness = start(zoned(evidence, 6.0))
    rig.submit("sis_a 0B 4")
    rig.wait_for("sis_a", "move to pick-up")
    rig.wait(0.4)
    rig.stop_bridge()
    crash_without_trail(rig)
    rig.wait(2.0)
    rig.start_bridge()
    rig.submit("sis_b 0B 4")
    rig.wait(15.0)
    assert zone(rig, "centre") == ("quarantined", "ra1") and rig.runs("sis_b", "take zones")
    if evidence is Evidence.STATE:
        return  # nobody can see where it stands
    rig.submit("sis_a 0B 7")
    assert "home ra1" in str(reasons.of_waiting(rig.plant.cells["sis_a"]))
    if evidence is Evidence.IDS:
        assert rig.operate(Verb.HOME, "ra1") is None
        assert rig.wait(120.0, until=lambda: at_rest(rig))
        assert {change.state for change in list(rig.outcomes().values())[1:]} == {TaskState.DONE}
    honest(witness)


@pytest.mark.sampled(3)
@levels
def test_who_asks_first_gets_the_zone_first(zoned: Plants, evidence: Evidence) -> None:
    rig, witness = start(zoned(evidence))
    served: list[str] = []

    def watch() -> None:
        holder = zone(rig, "centre")[1]
        if holder and (not served or served[-1] != holder):
            served.append(holder)

    rig.watchers.append(watch)
    for text in ("sis_a 2B 7", "sis_b 0B 7", "sis_c 0B 7"):
        rig.submit(text)
    assert rig.wait(120.0, until=lambda: at_rest(rig))
    assert served == ["ra2", "ra3", "ra1"]
    honest(witness)


@pytest.mark.sampled(2)
@levels
def test_hold_keeps_the_zones_and_resume_goes_on(zoned: Plants, evidence: Evidence) -> None:
    rig, witness = start(zoned(evidence))
    meet(rig)
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(WAIT_S / 2)
    assert zone(rig, "centre") == ("held", "ra1") and rig.runs("sis_b", "take zones")
    assert rig.operate(Verb.RESUME, "sis_a") is None
    assert rig.wait(120.0, until=lambda: at_rest(rig))
    assert {change.state for change in rig.outcomes().values()} == {TaskState.DONE}
    honest(witness)


@levels
def test_a_stopped_arm_keeps_its_zones_until_it_is_recovered(zoned: Plants, evidence: Evidence) -> None:
    rig, witness = start(zoned(evidence))
    meet(rig)
    assert rig.operate(Verb.STOP, "sis_a") is None
    rig.wait(5.0)
    assert zone(rig, "centre")[1] == "ra1"
    for verb in (Verb.CLEAR, Verb.RESET):
        assert rig.operate(verb, "sis_a") is None
        rig.wait(1.0)
    assert zone(rig, "centre")[1] == "ra1" and rig.plant.cells["sis_a"].state is CellState.HELD
    assert rig.operate(Verb.RETRY, "sis_a") is None
    assert rig.wait(90.0, until=lambda: at_rest(rig))
    assert [change.state for change in rig.outcomes().values()] == [TaskState.FAILED, TaskState.DONE]
    honest(witness)


@pytest.mark.sampled(3)
@levels
def test_a_recovery_keeps_its_place_among_those_that_wait_for_who_works_in_the_zone(
    zoned: Plants, evidence: Evidence
) -> None:
    rig, witness = start(hasty(zoned(evidence, 6.0)))
    held: set[str] = set()
    rig.watchers.append(lambda: held.update(c for c in CELLS if rig.plant.cells[c].state is CellState.HELD))
    rig.submit("ra1 palletizing")
    for text in ("ra2 palletizing", "ra3 palletizing", "ra1 palletizing", "ra2 palletizing"):
        rig.wait(2 * HASTE_S)
        rig.submit(text)
    assert rig.runs("sis_b", "recovery/take zones")
    assert rig.wait(300.0, until=lambda: at_rest(rig))
    reasons = [change.reason for change in rig.outcomes().values()]
    assert reasons[1] is Reason.ZONE_UNAVAILABLE, "it had no patience in its work"
    assert held == set(), "nobody had to help"
    honest(witness)


@levels
def test_a_recovery_gives_up_where_who_has_the_zone_or_waits_before_it_is_held(
    zoned: Plants, evidence: Evidence
) -> None:
    rig, witness = start(hasty(zoned(evidence, 6.0)))
    rig.submit("ra1 palletizing")
    rig.wait(1.0)
    rig.submit("ra3 palletizing")
    rig.wait(2 * HASTE_S)
    assert rig.operate(Verb.HOLD, "sis_c") is None
    rig.submit("ra2 palletizing")
    rig.wait(4 * HASTE_S)
    assert rig.plant.cells["sis_b"].state is CellState.HELD
    assert rig.operate(Verb.RESUME, "sis_c") is None
    assert rig.operate(Verb.HOLD, "sis_a") is None
    rig.wait(2 * HASTE_S)
    assert rig.plant.cells["sis_c"].state is CellState.HELD
    assert str(reasons.of_waiting(rig.plant.cells["sis_b"])).startswith(
        "sis_b is held (ra2: zone centre was not"
    )
    for name in ("sis_b", "sis_c", "sis_a"):
        follow(rig, name)
    assert rig.wait(120.0, until=lambda: at_rest(rig))
    honest(witness)


def hasty(model: PlantModel) -> PlantModel:
    """The same, with no patience for zones."""
    return replace(model, cells=tuple(replace(cell, zone_wait_s=HASTE_S) for cell in model.cells))


@pytest.mark.sampled(2)
@levels
@pytest.mark.parametrize("verb", [Verb.STOP, Verb.CANCEL])
def test_stop_and_cancel_end_the_waiting_for_a_zone(zoned: Plants, evidence: Evidence, verb: Verb) -> None:
    rig, witness = start(zoned(evidence))
    meet(rig)
    assert rig.operate(verb, "sis_b") is None
    rig.wait(1.0)
    assert "ra2" not in dict(rig.plant.zones.queue.waiting) or verb is Verb.CANCEL
    assert rig.wait(90.0, until=lambda: rig.plant.cells["sis_b"].task is None)
    assert list(rig.outcomes().values())[1].state is (
        TaskState.CANCELLED if verb is Verb.CANCEL else TaskState.FAILED
    )
    assert rig.wait(90.0, until=lambda: rig.plant.at_rest)
    assert zone(rig, "centre") == ("free", None)
    honest(witness)


@pytest.mark.sampled(3)
@levels
def test_waiting_for_a_zone_stands_still_while_held(zoned: Plants, evidence: Evidence) -> None:
    rig, witness = start(zoned(evidence))
    meet(rig)
    assert rig.operate(Verb.HOLD, "sis_a") is None
    assert rig.operate(Verb.HOLD, "sis_b") is None
    rig.wait(2 * WAIT_S)
    for name in ("sis_b", "sis_a"):
        assert rig.operate(Verb.RESUME, name) is None
    assert rig.wait(120.0, until=lambda: at_rest(rig))
    assert {change.state for change in rig.outcomes().values()} == {TaskState.DONE}
    honest(witness)


BOARDS = ("ra_1", "ra_2", "ra_3", "rm_sis_a", "rm_sis_b", "rm_sis_c")
VERBS = (
    *(Verb.STOP, Verb.CLEAR, Verb.RESET, Verb.HOLD, Verb.RESUME, Verb.CANCEL, Verb.RETRY, Verb.ABANDON),
    Verb.HOME,
)


def storm(rig: Rig, chance: random.Random) -> None:
    """One thing that happens in a plant, at a time that suits nobody."""
    kind = chance.choice(
        ["task", "task", "task", "verb", "verb", "verb", "silence", "broker", "reboot", "crash"]
    )
    cell, board = chance.choice(CELLS), chance.choice(BOARDS)
    if kind == "task":
        rig.submit(f"{cell} {chance.choice(['0B', '1C', '2A'])} {chance.choice([4, 5, 7, 8])}")
    elif kind == "verb":
        rig.operate(chance.choice(VERBS), chance.choice([*CELLS, "ra1", "rm_sis_b", ""]))
    elif kind == "silence":
        rig.lost = lambda publication: publication.topic.startswith(f"{board}/")
        rig.wait(chance.uniform(0.1, 4.0))
        rig.lost = lambda publication: False
    elif kind == "broker":
        rig.stop_broker()
        rig.wait(chance.uniform(0.1, 4.0))
        rig.start_broker()
    elif kind == "reboot":
        rig.crash(board)
    else:
        rig.crash()
    rig.wait(chance.uniform(0.0, 5.0))


def calm(rig: Rig) -> None:
    """An operator brings everything back: first the stops, then the homing, then the recoveries."""
    for _ in range(4):
        for verb in (Verb.CLEAR, Verb.RESET):
            rig.operate(verb)
            rig.wait(2.0)
        for robot, belief in rig.plant.dispatcher.beliefs.items():
            cell = rig.model.cell_of[robot]
            if belief.unhomed or rig.plant.cells[cell.name].context.zones.astray():
                rig.operate(Verb.HOME, robot)
        rig.wait(8.0)
        rig.operate(Verb.RETRY)
        rig.wait(60.0, until=lambda: at_rest(rig))
        rig.operate(Verb.RESUME)
        rig.wait(60.0, until=lambda: at_rest(rig))


@pytest.mark.sampled(2)
@pytest.mark.parametrize("seed", sample(range(4), every=2))
def test_whatever_happens_no_two_arms_meet_and_nothing_is_dropped(zoned: Plants, seed: int) -> None:
    rig, witness = start(zoned(Evidence.IDS))
    chance = random.Random(seed)
    for _ in range(25):
        storm(rig, chance)
        assert witness.collisions == []
    calm(rig)
    honest(witness)
    states = {name: (cell.state, reasons.of_hold(cell)) for name, cell in rig.plant.cells.items()}
    assert all(state is CellState.IDLE for state, _ in states.values()), states
    assert all(row["state"] == "free" for row in zone_rows(rig.plant.zones))


def test_two_arms_that_wait_for_each_others_zones_to_be_homed_are_advised_out(zoned: Plants) -> None:
    rig, witness = start(zoned(Evidence.IDS, 6.0))
    rig.submit("sis_a 0B 7")
    rig.submit("sis_b 0B 4")
    rig.wait_for("sis_a", "main/move to home", 200.0)
    rig.wait_for("sis_b", "main/move to pick-up")
    rig.wait(0.1)
    for board in ("ra_1", "ra_2"):
        rig.crash(board)
    rig.wait(20.0)
    assert zone(rig, "aisle") == ("quarantined", "ra1") and zone(rig, "centre") == ("quarantined", "ra2")
    assert "which ra2 holds" in str(rig.operate(Verb.HOME, "ra1"))
    ways = ["see that nobody is in aisle", "override aisle", "home ra2", "home ra1"]
    assert advised(rig, "sis_a")[:4] == ways
    follow(rig, "sis_a")
    follow(rig, "sis_b")
    assert works(rig, "sis_a") and works(rig, "sis_b")
    assert witness.collisions == []


def test_an_arm_whose_way_home_a_silent_one_blocks_waits_until_that_is_back(zoned: Plants) -> None:
    rig, witness = start(zoned(Evidence.IDS))
    meet(rig)
    rig.power_off("ra_1")
    rig.crash("ra_2")
    rig.wait(WAIT_S + 20.0)
    answered = [
        f"{act} {name}" for name in ("aisle", "centre") for act in ("see that nobody is in", "override")
    ]
    assert advised(rig, "sis_b")[:6] == ["bring ra1 back", *answered, "home ra2"]
    (blocked,) = [each for each in rig.plant.advice("sis_b") if each.scope == "ra2"]
    assert str(blocked.refusal) == "ra2 may cross zone aisle, which ra1 holds; home it once the zone is free"
    assert follow(rig, "sis_b")[:3] == ["bring ra1 back", "home ra1", "home ra2"]
    honest(witness)


def test_an_arm_whose_way_home_a_held_one_blocks_waits_for_what_that_cell_needs(zoned: Plants) -> None:
    rig, witness = start(zoned(Evidence.IDS))
    meet(rig)
    rig.operate(Verb.HOLD, "sis_a")
    rig.crash("ra_2")
    rig.wait(WAIT_S + 20.0)
    assert advised(rig, "sis_b")[:2] == ["resume sis_a", "home ra2"]
    assert follow(rig, "sis_b")[:2] == ["resume sis_a", "home ra2"]
    honest(witness)


def test_a_zone_that_is_kept_for_an_arm_that_is_gone_is_answered_for_first(zoned: Plants) -> None:
    """A plant file before this one had the arm."""
    rig, _ = start(zoned(Evidence.IDS))
    rig.disk.facts.setdefault(Fact.QUARANTINE, {})["centre"] = "ra9"
    rig.crash()
    rig.crash("ra_2")
    rig.wait(2.0)
    assert advised(rig, "sis_b") == ["see that nobody is in centre", "override centre", "home ra2"]
    assert not any(each.instead for each in rig.plant.advice("sis_b")), "there is no other way"
