"""Parts of a proof: instants, single faults, classes of parameters, things that are kept."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as Xml

import pytest

from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel
from arboleda.testing import shipped
from arboleda.testing.plants import shared
from arboleda_proofs.campaigns.from_above import as_svg
from arboleda_proofs.campaigns.proof.badge import badge
from arboleda_proofs.campaigns.proof.calm import calm_run
from arboleda_proofs.campaigns.proof.end_state import differences
from arboleda_proofs.campaigns.proof.growing_numbers import GrowingNumber, Ranks
from arboleda_proofs.campaigns.proof.instants import Instant, Mark, Side, instants
from arboleda_proofs.campaigns.proof.kept import Kept
from arboleda_proofs.campaigns.proof.moment import Moment
from arboleda_proofs.campaigns.proof.outcome import End, Outcome, outcome_from, plain
from arboleda_proofs.campaigns.proof.proof import Proof, Proved, spread
from arboleda_proofs.campaigns.proof.proof_report import unmended_lines
from arboleda_proofs.campaigns.proof.proof_tally import ProofTally
from arboleda_proofs.campaigns.proof.recipe_digest import recipe_digests
from arboleda_proofs.campaigns.proof.scenario import alone, scenarios
from arboleda_proofs.campaigns.proof.single_faults import single_faults
from arboleda_proofs.commands.prove import seconds_of

AT = Instant(at=2.0, side=Side.BEFORE, what="the request", commits=2)


@pytest.fixture
def model() -> PlantModel:
    return shipped("sis_a")


def mark(at: float, what: str, *, begins: bool = True, commits: int = 0) -> Mark:
    return Mark(at=at, what=what, begins=begins, commits=commits)


def test_an_instant_lies_before_and_after_each_event_and_in_the_middle_between_two() -> None:
    found = instants([mark(2.0, "a step"), mark(3.0, "its end", begins=False)])
    assert [(each.at, each.side) for each in found] == [
        (2.0, Side.BEFORE),
        (2.000001, Side.AFTER),
        (2.5, Side.BETWEEN),
        (3.0, Side.BEFORE),
        (3.000001, Side.AFTER),
    ]
    assert [each.level for each in found] == [0, 2, 1, 2, 2]


def test_events_that_follow_at_once_have_no_middle() -> None:
    assert [each.side for each in instants([mark(2.0, "a"), mark(2.01, "b")])] == [
        Side.BEFORE,
        Side.AFTER,
        Side.BEFORE,
        Side.AFTER,
    ]


def test_events_of_one_time_are_one_with_the_name_of_the_step_and_all_commits() -> None:
    found = instants([mark(2.0, "an end", begins=False, commits=1), mark(2.0, "a step", commits=2)])
    assert [(each.what, each.commits, each.level) for each in found] == [("a step", 3, 0), ("a step", 0, 2)]


def test_an_instant_is_never_after_the_event_that_it_precedes() -> None:
    before, after = instants([mark(2.12345678, "a step")])
    assert before.at <= 2.12345678 < after.at


def test_faults_of_an_instant_are_one_form_of_each_kind_and_target_then_all_others(
    model: PlantModel,
) -> None:
    *firsts, others = single_faults(model, model.cell("sis_a"), AT)
    first = [each for part in firsts for each in part]
    assert len({(each.kind, each.target) for each in first}) == len(first)
    assert not set(first) & set(others)
    assert {each.at for each in (*first, *others)} == {2.0}


def test_faults_of_the_device_whose_step_it_is_come_first_and_of_those_the_ones_in_its_work(
    model: PlantModel,
) -> None:
    of_step, kinds = replace(AT, what="ra1: moves"), ["reboot", "plant_crash", "no_grip"]
    of_work, of_board, of_others, _ = single_faults(model, model.cell("sis_a"), of_step, only=kinds)
    assert [(each.kind, each.target) for each in of_work] == [("no_grip", "ra_1")]
    assert [(each.kind, each.target) for each in of_board] == [("reboot", "ra_1")]
    assert {each.kind for each in of_others} >= {"reboot", "plant_crash"}
    assert "ra_1" not in {each.target for each in of_others}


def test_each_form_comes_first_at_one_of_the_instants(model: PlantModel) -> None:
    cell = model.cell("sis_a")
    parts = [single_faults(model, cell, AT, number=number, only=["reboot"])[2] for number in range(2)]
    assert {each.word for faults in parts for each in faults} == {"will", "no will"}


@pytest.mark.parametrize(
    ("count", "order"), [(0, []), (1, [0]), (5, [0, 4, 2, 1, 3]), (8, [0, 4, 2, 6, 1, 3, 5, 7])]
)
def test_what_is_spread_begins_far_apart_and_leaves_nothing_out(count: int, order: list[int]) -> None:
    assert spread(range(count)) == order


@pytest.mark.long
def test_a_short_budget_meets_each_recipe_at_several_steps(model: PlantModel) -> None:
    proof = Proof(model=model, calm=tuple(calm_run(model, each) for each in scenarios(model)))
    first = proof.portions[:8]
    assert {each.part for each in first} == {0} and {proof.instant(each).level for each in first} == {0}
    assert {proof.calm[each.scenario].scenario.recipe for each in first} == {"storage", "palletizing"}
    assert len({(each.scenario, each.instant) for each in first}) >= 6


def test_what_is_told_is_in_the_order_of_tasks_and_instants(model: PlantModel) -> None:
    proof = Proof(model=model, calm=tuple(calm_run(model, each) for each in scenarios(model)))
    proved = {
        number: Proved(
            number=number, outcomes=(Outcome(end=End.DONE),), rows=(0,) * proof.count(number), digest=""
        )
        for number in range(8)
    }
    cases = list(ProofTally(proof=proof, proved=proved).cases())
    assert [(each.row, each.instant.at) for each in cases] == sorted(
        (each.row, each.instant.at) for each in cases
    )


def test_a_death_of_the_plant_comes_at_each_commit_that_follows(model: PlantModel) -> None:
    parts = single_faults(model, model.cell("sis_a"), AT, only=["crash_in_step"])
    assert {each.amount for faults in parts for each in faults} == {1.0, 2.0}


def test_what_belongs_to_other_cells_is_left_alone() -> None:
    model = shipped()
    parts = single_faults(model, model.cell("sis_a"), AT)
    targets = {each.target for part in parts for each in part}
    assert "rb_1" not in targets and {"ra_1", "plant", "bridge", "broker"} <= targets


def test_tasks_of_one_shape_have_one_scenario(model: PlantModel) -> None:
    found = list(scenarios(model))
    assert [(each.task, each.alike) for each in found] == [("sis_a 0A 0", 81), ("sis_a palletizing", 1)]
    assert [each.recipe for each in scenarios(model, ["palletizing"])] == ["palletizing"]


def test_a_cell_that_shares_nothing_is_alone_on_its_stage() -> None:
    assert [cell.name for cell in alone(shipped(), "sis_b").cells] == ["sis_b"]
    assert alone(shared(), shared().cells[0].name) == shared()


def test_an_end_differs_in_facts_places_and_parts_but_not_in_a_hair() -> None:
    expected = {"lamp.lit": True, "the place of arm": (0.0, 1.0), "parts at nest": 1}
    assert differences(expected, {"lamp.lit": True, "the place of arm": (0.0, 1.000001)}, {}) == ()
    found = {"lamp.lit": False, "parts at nest": 0}
    assert differences(expected, found, {}) == ("lamp.lit is false, not true", "parts at nest is 0, not 1")


def test_of_a_fact_that_is_not_so_it_is_said_whether_the_plant_was_told() -> None:
    expected, found = {"lamp.lit": True}, {"lamp.lit": False}
    (known,) = differences(expected, found, {"lamp.lit": False})
    (unknown,) = differences(expected, found, {"lamp.lit": True})
    assert known == "lamp.lit is false, not true (the plant was told: a check would notice)"
    assert unknown == "lamp.lit is false, not true (its board had not said so)"


def test_an_outcome_is_the_same_after_it_was_written() -> None:
    outcome = Outcome(end=End.HELD, cause="held", alone=False, untrue=("a",), broken=("rule", "sentence"))
    assert outcome_from(plain(outcome)) == outcome


def files_of(recipes: str, *, plant: str = "cells: {one: {}, two: {}}", tree: bytes = b"<a/>") -> PlantFiles:
    contents = {"a.yaml": plant.encode(), "b.py": recipes.encode(), "c.xml": tree}
    return PlantFiles(plant="a.yaml", contents=contents)


def digests(model: PlantModel, files: PlantFiles) -> tuple[str, str]:
    """The digests of the two recipes of the first cell."""
    found = recipe_digests(model, files)
    return found["sis_a", "storage"], found["sis_a", "palletizing"]


RECIPES = """
def help(): return 1
@recipe("storage")
def one(cell): return help()
@recipe("palletizing")
def two(cell): return 2
"""


def test_a_change_of_one_recipe_is_seen_by_no_other(model: PlantModel) -> None:
    before = digests(model, files_of(RECIPES))
    after = digests(model, files_of(RECIPES.replace("return 2", "return 3")))
    assert (before[0] == after[0], before[1] == after[1]) == (True, False)


@pytest.mark.parametrize(
    "changed",
    [
        files_of(RECIPES.replace("return 1", "return 4")),
        files_of(RECIPES, tree=b"<b/>"),
        files_of(RECIPES, plant="name: other"),
    ],
)
def test_what_recipes_share_is_seen_by_all(model: PlantModel, changed: PlantFiles) -> None:
    before, after = digests(model, files_of(RECIPES)), digests(model, changed)
    assert before[0] != after[0] and before[1] != after[1]


def test_a_recipe_that_names_another_one_sees_it(model: PlantModel) -> None:
    calls = RECIPES.replace("return help()", "return two(cell)")
    one = digests(model, files_of(calls))[0]
    assert one != digests(model, files_of(calls.replace("return 2", "return 3")))[0]


def test_a_file_that_looks_names_up_is_seen_whole(model: PlantModel) -> None:
    looks = RECIPES.replace("return help()", 'return globals()["t" + "wo"](cell)')
    one = digests(model, files_of(looks))[0]
    assert one != digests(model, files_of(looks.replace("return 2", "return 3")))[0]


def test_comments_and_cells_that_cannot_be_met_are_not_seen(model: PlantModel) -> None:
    cells = "cells: {sis_a: {robots: 1}, other: {robots: %d}}"
    before = digests(model, files_of(RECIPES, plant=cells % 1))
    assert before == digests(model, files_of(RECIPES + "# more", plant=cells % 2 + " # more"))


def test_what_is_kept_cannot_be_read_by_a_proof_of_something_else(tmp_path: Path, model: PlantModel) -> None:
    kept = Kept(tmp_path, {("sis_a", "storage"): "key"}, Proof(model=model))
    (tmp_path / "key.jsonl").write_text('{"portion": "gone"}\n{"portio')
    assert kept.known() == {}
    kept.forget(all=True)
    assert not list(tmp_path.iterdir())


def test_what_cannot_be_kept_is_noted(tmp_path: Path, model: PlantModel) -> None:
    (tmp_path / "taken").write_text("a file where a folder is needed")
    proof = Proof(model=model, calm=(calm_run(model, next(scenarios(model))),), kinds=("forgets", "reboot"))
    kept = Kept(tmp_path / "taken", {("sis_a", "storage"): "key"}, proof)
    kept.keep(Proved(number=0, outcomes=(Outcome(end=End.DONE),), rows=(0,), digest=""))
    assert kept.trouble is not None and "taken" in kept.trouble


@pytest.mark.parametrize(
    ("runs", "total", "broken", "said"),
    [
        (4, 4, False, "held: all 4"),
        (4, 1200, False, "held: 4 of 1,200"),
        (4, 4, True, "broken"),
        (0, 4, False, "nothing was run"),
    ],
)
def test_a_badge_says_how_much_of_all_held(
    model: PlantModel, runs: int, total: int, broken: bool, said: str
) -> None:
    proved = Proved(number=0, outcomes=(Outcome(end=End.DONE),), rows=(0,) * runs, digest="")
    tally = ProofTally(proof=Proof(model=model), proved={0: proved})
    drawn = Xml.fromstring(badge(tally, total, broken=broken))
    assert drawn.get("aria-label") == f"every single fault: {said}"


@pytest.mark.parametrize(("acts", "too_much"), [(0, False), (6, False), (7, True), (None, True)])
def test_more_acts_than_six_are_too_much_and_so_is_a_cell_that_is_never_ready(
    acts: int | None, too_much: bool
) -> None:
    assert Outcome(end=End.HELD, acts=acts).takes_too_much is too_much
    assert not Outcome(end=End.HELD, acts=acts, broken=("rule", "sentence")).takes_too_much


def test_the_worst_case_of_what_advice_does_not_mend_is_said(model: PlantModel) -> None:
    calm = calm_run(model, next(scenarios(model, ["palletizing"])))
    proof = Proof(model=model, calm=(calm,), kinds=("reboot",))
    first = next(each for each in range(len(proof.portions)) if proof.count(each) > 1)
    count = proof.count(first)
    outcomes = (Outcome(end=End.HELD, acts=7), Outcome(end=End.HELD, acts=None), Outcome(end=End.DONE))
    rows = (0, 1, *([2] * (count - 2)))
    proved = Proved(number=first, outcomes=outcomes, rows=rows, digest="")
    tally = ProofTally(proof=proof, proved={first: proved})
    assert [(case.outcome.acts, times) for case, times in tally.unmended()] == [(7, 1), (None, 1)]
    assert tally.most_acts == 7
    said = [str(line) for line in unmended_lines(tally.unmended())]
    assert "it takes 7 acts" in said[1] and "it is never ready" in said[2]


@pytest.mark.long
def test_the_shipped_plant_calls_no_task_done_whose_part_is_lost_missed_or_was_never_there(
    model: PlantModel,
) -> None:
    calm = calm_run(model, next(scenarios(model, ["storage"])))
    proof = Proof(model=model, calm=(calm,), kinds=("no_part", "no_grip", "lost_part"), every=True)
    rows = [(proof.instant(each), number) for number, each in enumerate(proof.portions)]
    begins = [number for at, number in sorted(rows, key=lambda row: row[0].at) if "ra1" in at.what]
    outcomes = [each for number in begins[::6] for each in proof.run(number).each]
    assert len(outcomes) > 10 and not any(each.goes_unnoticed or each.broken for each in outcomes)
    assert {"part_lost", "no_piece"} <= {each.cause for each in outcomes}


def ranks(*numbers: tuple[str, int, bool]) -> list[tuple[tuple[str, str], list[int]]]:
    found = Ranks()
    for robot, value, counts in numbers:
        found.note(robot, GrowingNumber("reports", value, counts=counts))
    return [*found]


def test_growing_numbers_count_by_their_order_robot_by_robot() -> None:
    one = ranks(("arm", 7, False), ("lamp", 3, True), ("arm", 9, True), ("arm", 0, False))
    other = ranks(("arm", 70, False), ("lamp", 4, True), ("arm", 71, True), ("arm", 0, False))
    assert one == other == [(("arm", "reports"), [1, 2, 0]), (("lamp", "reports"), [1])]
    assert one != ranks(("arm", 9, False), ("lamp", 3, True), ("arm", 9, True), ("arm", 0, False))


def test_a_number_above_the_count_or_without_one_counts_by_its_value() -> None:
    assert ranks(("arm", 9, True), ("arm", 12, False)) == [(("arm", "reports"), [9, 12])]
    assert ranks(("arm", 12, False)) == [(("arm", "reports"), [12])]


def test_a_portion_is_broken_where_one_of_its_outcomes_is() -> None:
    held, broken = Outcome(end=End.DONE), Outcome(end=End.DONE, broken=("rule", "sentence"))
    assert not Proved(number=0, outcomes=(held,), rows=(0, 0), digest="").broken
    assert Proved(number=0, outcomes=(held, broken), rows=(0, 1), digest="").each == [held, broken]


@pytest.mark.parametrize(("budget", "seconds"), [("30s", 30.0), ("10m", 600.0), ("1.5h", 5400.0)])
def test_a_budget_is_a_time_as_people_write_it(budget: str, seconds: float) -> None:
    assert seconds_of(budget) == seconds


def test_the_instants_are_told_at_which_the_outcome_of_a_fault_changes(model: PlantModel) -> None:
    calm = calm_run(model, next(scenarios(model, ["palletizing"])))
    proof = Proof(model=model, calm=(calm,), kinds=("lost_part",))
    places = sorted(range(len(proof.portions)), key=lambda number: proof.instant(proof.portions[number]).at)
    outcomes = [Outcome(end=End.DONE), Outcome(end=End.HELD, cause="held"), Outcome(end=End.DONE)]
    row = {
        number: Proved(number=number, outcomes=(outcome,), rows=(0,), digest="")
        for number, outcome in zip(places[:3], outcomes, strict=True)
    }
    (found,) = ProofTally(proof=proof, proved=row).table()["sis_a", "palletizing"].values()
    assert found.changes
    (turns,) = found.turns.values()
    assert [words for _, words in turns] == ["done", "held: held", "done"]
    assert [instant.at for instant, _ in turns] == sorted(instant.at for instant, _ in turns)


def test_the_devices_of_a_breach_are_drawn_from_above() -> None:
    moment = Moment(lines={"arm": [[0.0, 0.0], [0.3, 0.2]], "lamp": []}, grids=[[[1.0, 1.0]]])
    drawn = Xml.fromstring(as_svg(moment))
    assert [each.text for each in drawn.iterfind(".//{*}text")] == ["arm"]
    assert as_svg(Moment(facts={"lamp": "lit: true"})) == ""
