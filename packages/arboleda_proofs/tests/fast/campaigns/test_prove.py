"""`arboleda prove` on a lamp: what it finds, what it keeps, and the tests that it writes."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from functools import cache, partial
from itertools import chain, repeat
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import Mock
from xml.etree import ElementTree as Xml

import pytest
from tests.lengths import length, sample

from arboleda.model.errors import ArboledaError
from arboleda.model.plant_model import PlantModel
from arboleda.plant_check.mend import Edit, edited
from arboleda.plant_file import loader
from arboleda_proofs.campaigns.proof import forks, proof_campaign
from arboleda_proofs.campaigns.proof.between_steps import gaps, other_facts
from arboleda_proofs.campaigns.proof.calm import Calm, calm_run, calm_runs
from arboleda_proofs.campaigns.proof.changed_recipe import noticed_with, with_check
from arboleda_proofs.campaigns.proof.course import course_of
from arboleda_proofs.campaigns.proof.forks import run_all, run_one
from arboleda_proofs.campaigns.proof.instants import Instant, Side
from arboleda_proofs.campaigns.proof.outcome import End, outcome_from, plain
from arboleda_proofs.campaigns.proof.proof import MOST, Proof, Proved
from arboleda_proofs.campaigns.proof.proof_tally import ProofTally
from arboleda_proofs.campaigns.proof.scenario import scenarios
from arboleda_proofs.campaigns.proof.single_faults import single_faults
from arboleda_proofs.campaigns.proof.spent import Spent
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.testing import Sim

from .lamp import GOOD, PLANT, PRESS, Prove, calm_of, model_of, summary
from .lamp import plant as plant
from .lamp import prove as prove

QUIET = GOOD.replace(
    'cell.device("lamp").light(on=True)',
    'cell.fallback(cell.device("lamp").light(on=True), cell.wait(1))',
)
BLINK = QUIET.replace(', ends_with={"lamp.lit": True}', "").replace(
    "cell.wait(1))", 'cell.wait(1)), cell.device("lamp").light(on=False)'
)
TESTED = """
from arboleda.recipes import recipe, work


@recipe("shine")
def shine(cell):
    lamp = cell.device("lamp")
    seen = lamp.test()
    return work(seen, cell.choose(seen, {"good": lamp.light(on=True), "bad": cell.fail("a bad lamp")}))
"""
STAMP = """
from arboleda.recipes import recipe, work


@recipe("stamp")
def stamp(cell):
    press = cell.device("press")
    return work(press.press(), press.lift())
"""
CARRY = """
name: small
uses: [small.py]
cells:
  bench:
    devices:
      arm: {kind: arm, model: scara}
      jaw: {kind: gripper, tool_of: arm}
    targets:
      home:  {arm: {deg: [0, 0], mm: 0}}
      rack:  {arm: {deg: [60, 20], mm: 80, approach_mm: 40}}
      shelf: {arm: {deg: [-90, 20], mm: 80, approach_mm: 40}}
"""
CARRIED = """
from arboleda.recipes import recipe, work


@recipe("carry")
def carry(cell):
    arm, jaw = cell.devices("arm", "jaw")
    taken = arm.visit("rack", jaw.close(width_mm=40, force_n=20))
    return work(taken, arm.visit("shelf", jaw.open()), arm.home())
"""
KINDS = ("reboot", "driver_alarm", "refuses")


def ends(model: PlantModel, calm: Calm, instant: Instant) -> dict[tuple[str, str, float], str]:
    """The end of each fault of some kinds that begins at an instant, by kind, word and span."""
    faults = [each for part in single_faults(model, model.cells[0], instant, only=KINDS) for each in part]
    runs = run_all(model, calm, faults, lambda: None)
    rows = zip(faults, runs, strict=True)
    return {(fault.kind, fault.word, fault.seconds): run.outcome.words for fault, run in rows}


def test_what_holds_is_said_of_every_run(plant: Path, prove: Prove) -> None:
    said = prove("--fault", "refuses", "--fault", "lying_fact", "--all-instants")
    assert "HELD: all 30 runs, every single fault of 2 kinds at every instant" in said
    assert "lamp: It tells a false value: lamp.lit is false, not true (its board had not said so)" in said
    assert "a question may: lamp.test()" in said
    found = summary(plant)
    assert found["runs"] == {"done": 30, "of": 30, "represented": 30} and found["complete"]
    assert found["scenarios"][0]["ends_with"] == {"lamp.lit": True}
    assert found["unnoticed"][0]["checks"] == [{"steps": ["lamp.test()"], "is_sure": False, "behind": ""}]
    refuses = found["table"][0]["faults"]["refuses"]
    assert refuses["ends"] == {"done": 4, "failed": 16} and refuses["changes_with_the_moment"]


@pytest.mark.long
def test_a_second_run_runs_again_only_recipes_that_changed(plant: Path, prove: Prove) -> None:
    recipes = plant.parent / "small.py"
    recipes.write_text(GOOD + GOOD.partition("work\n")[2].replace("shine", "glow"))
    assert "kept from before" not in prove("--fault", "forgets")
    assert "8 runs, 8 of them kept from before" in prove("--fault", "forgets")
    recipes.write_text(recipes.read_text().replace('"glow", ends_with={"lamp.lit": True}', '"glow"'))
    assert "4 runs, 4 of them kept from before" in prove("--fault", "forgets", "--recipe", "shine")
    assert "8 runs, 4 of them kept from before" in prove("--fault", "forgets")


@pytest.mark.long
def test_a_recipe_that_gives_up_in_silence_is_found_and_its_test_fails_alike(
    plant: Path, prove: Prove
) -> None:
    (plant.parent / "small.py").write_text(QUIET)
    tests = plant.parent / "test_found.py"
    page = plant.parent / "out.html"
    said = prove("--fault", "refuses", "--tests", tests, "--html", page, ends=1)
    assert "lamp: lit: false" in page.read_text()
    assert "shine" in page.read_text().partition("The tree when it broke")[2]
    assert "lamp.lit is false, not true (the plant was told: a check would notice)" in said
    assert "bench shine breaks a rule" in said and "BROKEN: 1 breach" in said
    namespace: dict[str, Any] = {}
    exec(tests.read_text(), namespace)
    (written,) = [each for name, each in namespace.items() if name.startswith("test_")]
    with pytest.raises(AssertionError):
        written(Sim(plant.parent))
    (plant.parent / "small.py").write_text(GOOD)
    written(Sim(plant.parent))


def test_each_answer_that_leads_elsewhere_is_a_scenario(plant: Path) -> None:
    (plant.parent / "small.py").write_text(TESTED)
    model = model_of(plant)
    found = list(calm_runs(model, scenarios(model)))
    assert [(each.scenario.name, each.run.outcome.words) for each in found] == [
        ("bench shine", "done"),
        ("bench shine (lamp says bad)", "failed: rejected"),
    ]
    assert all(each.is_sound for each in found)


def test_what_takes_less_than_a_fork_is_done_anew_in_this_process(
    plant: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model, calm = calm_of(plant)
    parts = single_faults(model, model.cells[0], calm.instants[-1], only=("refuses",))
    faults = [each for part in parts for each in part]
    told = Mock()
    monkeypatch.setattr(forks, "CAN_FORK", True)
    monkeypatch.setattr(forks, "FORK_TAKES_S", 3600.0)
    assert len(run_all(model, calm, faults, told)) == told.call_count == len(faults) > 1


@pytest.mark.long
@pytest.mark.parametrize(
    ("file", "recipe", "every"),
    sample(
        [
            (PRESS, STAMP.replace("press.lift()", "cell.wait(8), press.lift()"), 19),
            (PRESS, STAMP, 9),
            (CARRY, CARRIED, 131),
        ],
        every=2,
    ),
)
def test_runs_that_end_as_soon_as_the_rest_is_known_have_the_outcomes_of_whole_ones(
    plant: Path, file: str, recipe: str, every: int
) -> None:
    (plant.parent / "small.yaml").write_text(file)
    (plant.parent / "small.py").write_text(recipe)
    model, calm = calm_of(plant)
    course, back = course_of(model, calm), 0
    for number, instant in enumerate(length(calm.instants[::21], whole=calm.instants)):
        parts = single_faults(model, model.cells[0], instant, number=number)
        faults = [each for part in parts for each in part][:: length(every, whole=1)]
        whole = run_all(model, calm, faults, lambda: None)
        short = run_all(model, calm, faults, lambda: None, course=course)
        assert [each.outcome for each in short] == [each.outcome for each in whole]
        back += sum(each.joined_at is not None for each in short)
        assert sum(each.seconds for each in short) < sum(each.seconds for each in whole)
    assert back > 0


def test_a_recipe_that_looks_at_a_fact_keeps_no_run_from_being_as_the_calm_one_again(plant: Path) -> None:
    plant.write_text(PRESS)
    looks = STAMP.replace("press.press()", 'press.says(ram="up"), press.press()')  # which keeps its device
    assert looks != STAMP
    (plant.parent / "small.py").write_text(looks)
    model, calm = calm_of(plant)
    fault = Fault(kind="duplicate", at=2.5, seconds=0.5, target="press", word="up")
    assert run_one(model, calm, fault, course=course_of(model, calm)).joined_at is not None


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("kind", "word"), [("mute", ""), ("duplicate", "up"), ("reorder", "up"), ("lost_queue", "")]
)
def test_a_run_in_which_more_or_fewer_messages_came_is_as_the_calm_one_again(
    plant: Path, kind: str, word: str
) -> None:
    plant.write_text(PRESS)
    (plant.parent / "small.py").write_text(STAMP)
    model, calm = calm_of(plant)
    fault = Fault(kind=kind, at=2.5, seconds=0.5, target="press", word=word)
    run = run_one(model, calm, fault, course=course_of(model, calm))
    whole = run_one(model, calm, fault)
    assert run.joined_at is not None and run.joined_at < 5.0
    assert run.outcome == whole.outcome


@pytest.mark.long
def test_a_task_that_ended_as_the_plant_died_counts_as_what_was_kept_of_it(plant: Path) -> None:
    model, calm = calm_of(plant)
    last = [each for each in calm.instants if each.commits][-1]
    parts = single_faults(model, model.cells[0], last, only=("crash_in_step",))
    runs = run_all(model, calm, [each for part in parts for each in part], lambda: None)
    assert runs and {run.outcome.end for run in runs} <= {End.DONE, End.HELD}
    assert End.DONE in {run.outcome.end for run in runs}
    assert max(run.seconds for run in runs) < 120.0


def test_a_kind_of_fault_or_a_recipe_that_there_is_not_is_refused(prove: Prove) -> None:
    assert "'rain' is no kind of fault; there are reboot" in prove("--fault", "rain", ends=2)
    assert "'dance' is no recipe of this plant; there are shine" in prove("--recipe", "dance", ends=2)
    assert "'soon' is no time" in prove("--budget", "soon", ends=2)


@pytest.mark.long
def test_the_page_and_the_junit_file_say_what_broke_and_what_nobody_notices(
    plant: Path, prove: Prove
) -> None:
    (plant.parent / "small.py").write_text(QUIET)
    html, junit = plant.parent / "out.html", plant.parent / "out.xml"
    prove("--fault", "refuses", "--fault", "lying_fact", "--html", html, "--junit", junit, ends=1)
    said = html.read_text()
    assert "<span lang=en>What nobody notices</span><span lang=es>Lo que nadie nota</span>" in said
    assert "recipes_end_as_they_say" in said and "sim.submit(" in said
    assert re.search("<span lang=en>[^<]+ is called done[^<]+</span><span lang=es>[^<]+ se da por", said)
    assert "http://" not in said and "https://" not in said
    suite = Xml.parse(junit).getroot()[0]
    assert [case.get("name") for case in suite] == ["without faults: bench shine", "refuses", "lying_fact"]
    assert [case.find("failure") is not None for case in suite] == [False, True, False]
    assert "nobody notices" in (suite[2].findtext("system-out") or "")


@pytest.mark.long
def test_any_other_moment_ends_as_one_of_the_instants_beside_it(plant: Path) -> None:
    plant.write_text(PRESS)
    (plant.parent / "small.py").write_text(STAMP)
    model, calm = calm_of(plant)
    known = cache(partial(ends, model, calm))
    for number in range(1, 8, length(4, whole=2)):
        at = round(2.0 + 0.43 * number, 3)
        before = known([each for each in calm.instants if each.at <= at][-1])
        after = known(next(each for each in calm.instants if each.at > at))
        for fault, end in ends(model, calm, replace(calm.instants[0], at=at)).items():
            assert end in (before[fault], after[fault]), (at, fault)


def test_ctrl_c_says_what_was_done_and_the_next_run_goes_on_there(
    plant: Path, prove: Prove, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = Proof.run

    def interrupted(proof: Proof, seed: int, **options: Any) -> Proved:
        if seed == 2:
            raise KeyboardInterrupt
        return run(proof, seed, **options)

    monkeypatch.setattr(Proof, "run", interrupted)
    said = prove("--fault", "reboot", ends=130)
    assert "interrupted; so far:" in said and "HELD in 2 of 8 runs (25%): a sample" in said
    assert not summary(plant)["complete"]
    monkeypatch.setattr(Proof, "run", run)
    assert "8 runs, 2 of them kept from before" in prove("--fault", "reboot")


@pytest.mark.long
def test_a_hold_in_the_very_step_in_which_a_command_ends_breaks_nothing(plant: Path) -> None:
    plant.write_text(PRESS)
    (plant.parent / "small.py").write_text(STAMP)
    sim = Sim(plant.parent)
    sim.plant("small.yaml")
    assert sim.prove("stamp", "operator_hold", at_most=None) == 1.0


def test_a_hold_in_the_very_step_in_which_a_question_is_answered_breaks_nothing(plant: Path) -> None:
    (plant.parent / "small.py").write_text(TESTED)
    model, calm = calm_of(plant)
    (answered,) = [each for each in calm.instants if each.at == 3.2 and each.side is Side.BEFORE]
    run = run_one(model, calm, Fault(kind="operator_hold", at=answered.at, target="bench"))
    assert (run.outcome.words, run.outcome.broken) == ("held: held", None)


def test_a_cell_is_ready_only_once_its_boards_have_said_what_is_truly_so(plant: Path) -> None:
    plant.write_text(CARRY)
    (plant.parent / "small.py").write_text(CARRIED)
    model, calm = calm_of(plant)
    fault = Fault(kind="stale_fact", at=2.0, seconds=15.0, target="jaw", word="gripped")
    outcome = run_one(model, calm, fault).outcome
    assert (outcome.words, outcome.broken, outcome.alone) == ("failed: deadline", None, False)


@pytest.mark.long
def test_the_acts_are_counted_that_get_a_cell_ready_again(plant: Path, prove: Prove) -> None:
    assert "after all others with at most 3 acts of one" in prove("--fault", "operator_stop")
    assert summary(plant)["unmended"] == []


def test_a_test_proves_a_recipe_by_as_many_runs_as_it_allows(plant: Path) -> None:
    sim = Sim(plant.parent)
    sim.plant("small.yaml")
    assert sim.prove("shine", "forgets") == 1.0
    assert 0.0 < sim.prove("shine", "forgets", at_most=1) < 1.0


def test_a_test_tells_what_breaks_a_recipe(plant: Path) -> None:
    (plant.parent / "small.py").write_text(QUIET)
    sim = Sim(plant.parent)
    sim.plant("small.yaml")
    with pytest.raises(
        AssertionError, match=r"(?s)bench shine breaks recipes_end_as_they_say.*the fault: lamp: It refuses"
    ):
        sim.prove("shine", "refuses")
    with pytest.raises(ArboledaError, match="'rain' is not a kind of fault"):
        sim.prove("shine", "rain")


def test_a_program_reads_progress_then_the_answer_as_lines(plant: Path, prove: Prove) -> None:
    (plant.parent / "small.py").write_text(QUIET)
    rows = [json.loads(line) for line in prove("--fault", "refuses", "--json", "-", ends=1).splitlines()]
    sorts = [sort for row in rows for sort in row]
    assert sorts[-1] == "answer" and set(sorts) == {"progress", "broken", "answer"}
    last = [row["progress"] for row in rows if "progress" in row][-1]
    assert (last["phase"], last["done"], last["of"]) == ("proving", 12, 12)
    broken = next(row["broken"] for row in rows if "broken" in row)
    assert broken["task"] == "bench shine" and broken["kind"] == "refuses" and broken["outcome"]["broken"]
    assert rows[-1]["answer"]["runs"] == {"done": 12, "of": 12, "represented": 20}


ASKS = """
from arboleda.recipes import recipe, work


@recipe("shine")
def shine(cell):
    lamp, ana = cell.devices("lamp", "ana")
    clean = ana.ask("Is it clean?", ["yes", "no"])
    return work(clean, cell.choose(clean, {"yes": lamp.light(on=True), "no": cell.fail("it is dirty")}))
"""


def test_each_answer_of_a_person_is_a_scenario(plant: Path) -> None:
    plant.write_text(PLANT.replace("lamp: {kind: lamp}}}", "lamp: {kind: lamp}, ana: {kind: person}}}"))
    (plant.parent / "small.py").write_text(ASKS)
    model = model_of(plant)
    found = list(calm_runs(model, scenarios(model)))
    assert [(each.scenario.name, each.run.outcome.words) for each in found] == [
        ("bench shine", "done"),
        ("bench shine (ana says no)", "failed: rejected"),
    ]
    assert found[0].commands[0] == "ana: asking ana"
    assert "ana: asking ana" in {each.what for each in found[0].instants}


ONCE = PLANT.replace("light: {effect: switch,", "light: {effect: switch, needs: {lit: false},")


def test_a_task_that_is_not_done_a_second_time_is_named(plant: Path, prove: Prove) -> None:
    plant.write_text(ONCE)
    assert "bench shine: once more, without any fault, it is not done: failed" in prove("--fault", "forgets")
    assert "lit" in summary(plant)["scenarios"][0]["once_more"]


def test_a_command_that_is_refused_without_any_fault_is_a_finding(plant: Path, prove: Prove) -> None:
    plant.write_text(PRESS.replace("lift: {effect: motion,", "lift: {effect: motion, needs: {ram: up},"))
    lenient = "cell.fallback(press.lift(), cell.wait(1))"
    (plant.parent / "small.py").write_text(STAMP.replace("press.lift()", lenient))
    assert "done without any fault: press: doing lift" in prove("--fault", "reboot", ends=1)
    assert "lift" in summary(plant)["scenarios"][0]["finding"]


@pytest.mark.long
def test_the_step_is_named_that_would_notice_what_the_plant_had_been_told(plant: Path, prove: Prove) -> None:
    (plant.parent / "small.py").write_text(QUIET.replace(', ends_with={"lamp.lit": True}', ""))
    page = plant.parent / "out.html"
    assert "a step notices it: lamp.becomes(lit=True, at_most_s=2)" in prove(
        "--fault", "refuses", "--html", page
    )
    assert "un paso lo nota: lamp.becomes(lit=True, at_most_s=2)" in page.read_text()


@pytest.mark.parametrize(("lit", "end"), [(True, End.FAILED), (False, None)])
def test_a_step_notices_a_fault_where_the_task_with_it_is_done_without_the_fault_only(
    plant: Path, lit: bool, end: End | None
) -> None:
    (plant.parent / "small.py").write_text(QUIET.replace(', ends_with={"lamp.lit": True}', ""))
    model = model_of(plant)
    scenario, fault = next(scenarios(model)), Fault(kind="refuses", at=2.0, seconds=1.0, target="lamp")
    changed = with_check(model.cells[0].recipe("shine"), "lamp", "lit", lit)
    found = noticed_with(model, scenario, changed, [replace(fault, word="ocupado")])
    assert (None if found is None else found.end) is end


@pytest.mark.long
def test_a_check_between_two_steps_is_named_where_none_at_the_end_notices_the_fault(
    plant: Path, prove: Prove
) -> None:
    (plant.parent / "small.py").write_text(BLINK)
    page = plant.parent / "out.html"
    said = prove("--fault", "refuses", "--html", page)
    check = "lamp.becomes(lit=True, at_most_s=2)"
    assert "lamp: doing light true has failed, and was not done later" in said
    assert f"a step behind step 1, fallback, notices it: {check}" in said
    assert f"un paso tras el paso 1, fallback, lo nota: {check}" in page.read_text()


def test_between_two_steps_only_what_the_plant_hears_otherwise_is_a_check(plant: Path) -> None:
    (plant.parent / "small.py").write_text(BLINK)
    model, calm = calm_of(plant)
    fault = Fault(kind="refuses", at=2.0, seconds=1.0, target="lamp", word="ocupado")
    found = [
        (gap.number, gap.name, fact, value)
        for gap, fact, value in other_facts(gaps(model, calm), gaps(model, calm, fault))
    ]
    assert found == [(1, "fallback", "lamp.lit", True)]
    assert not [*other_facts(gaps(model, calm), gaps(model, calm))]


def test_a_step_that_sees_nothing_of_a_fault_does_not_notice_it(plant: Path) -> None:
    model, calm = calm_of(plant)
    lies = Fault(kind="lying_fact", at=2.0, seconds=10.0, target="lamp", word="lit")
    assert run_one(model, calm, lies).outcome.goes_unnoticed
    changed = with_check(model.cells[0].recipe("shine"), "lamp", "lit", True)
    assert noticed_with(model, next(scenarios(model)), changed, [lies]) is None


@pytest.mark.long
def test_a_command_that_failed_and_is_passed_over_is_told_where_no_fact_shows_it(
    plant: Path, prove: Prove
) -> None:
    plant.write_text(PLANT.replace("      test:", "      dust: {effect: process, takes_s: 1}\n      test:"))
    lenient = 'cell.fallback(cell.device("lamp").dust(), cell.wait(0.1)), cell.device("lamp").light'
    (plant.parent / "small.py").write_text(GOOD.replace('cell.device("lamp").light', lenient))
    assert "lamp: doing dust has failed, and was not done later" in prove("--fault", "gives_up")


@pytest.mark.long
def test_one_of_two_equal_steps_that_failed_is_told_though_the_other_was_done(
    plant: Path, prove: Prove
) -> None:
    plant.write_text(PLANT.replace("      test:", "      dust: {effect: process, takes_s: 2}\n      test:"))
    lenient = 'cell.fallback(cell.device("lamp").dust(), cell.wait(0.1))'
    twice = f'{lenient}, {lenient}, cell.device("lamp").light'
    (plant.parent / "small.py").write_text(GOOD.replace('cell.device("lamp").light', twice))
    assert "lamp: doing dust has failed, and was not done later" in prove("--fault", "gives_up")


FORCED = """<root BTCPP_format="4"><BehaviorTree ID="main"><Sequence>
<ForceSuccess><mop_dust/></ForceSuccess><lamp_light on="true"/></Sequence></BehaviorTree></root>"""


@pytest.mark.parametrize(("at", "seconds"), [(1.9, 15.0), (2.25, 1.0)], ids=["before it is given", "at work"])
def test_work_that_failed_under_a_force_success_is_told_as_not_noticed(
    plant: Path, at: float, seconds: float
) -> None:
    mop = "  mop: {verbs: {dust: {effect: process, takes_s: 2}}}\ncells:"
    with_mop = PLANT.replace("cells:", mop).replace(
        "lamp: {kind: lamp}", "lamp: {kind: lamp}, mop: {kind: mop}"
    )
    plant.write_text(with_mop.replace("small.py", "main.xml"))
    (plant.parent / "main.xml").write_text(FORCED)
    model = loader.load(plant)
    calm = calm_run(model, next(scenarios(model)))
    alarm = Fault(kind="driver_alarm", at=at, seconds=seconds, target="mop")
    (run,) = run_all(model, calm, [alarm], lambda: None)
    assert run.outcome.end in (End.DONE, End.RECOVERED) and run.outcome.goes_unnoticed
    assert run.outcome.untrue == ("mop: doing dust has failed, and was not done later",)


def test_where_nothing_was_run_it_is_not_said_that_it_held(plant: Path, prove: Prove) -> None:
    tests = plant.parent / "test_found.py"
    assert "nothing was run: --budget was over before" in prove(
        "--fault", "refuses", "--budget", "0s", "--tests", tests, ends=2
    )
    assert not tests.exists()


def test_running_without_faults_takes_at_most_half_of_the_budget_and_what_is_left_out_is_said(
    plant: Path, prove: Prove, monkeypatch: pytest.MonkeyPatch
) -> None:
    recipes = plant.parent / "small.py"
    recipes.write_text(GOOD + GOOD.partition("work\n")[2].replace("shine", "glow"))
    seconds = chain([0.0, 1.0, 3.0], repeat(3.0))  # when it begins, and before the first two tasks
    clock = SimpleNamespace(monotonic=lambda: next(seconds), process_time=lambda: 0.0)
    monkeypatch.setattr(proof_campaign, "time", clock)
    said = prove("--fault", "refuses", "--budget", "4s")
    assert (
        "half of --budget was over when 1 task had run without faults: nothing is known of the others" in said
    )
    assert "HELD in 12 of 24 runs (50%): a sample" in said and "HELD: all" not in said
    assert not summary(plant)["complete"] and len(summary(plant)["scenarios"]) == 1


def test_runs_that_have_begun_are_given_up_soon_after_the_budget(
    plant: Path, prove: Prove, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [0.0]

    def slow(*arguments: Any, **options: Any) -> Any:
        now[0] += 4.0
        return run_one(*arguments, **options)

    monkeypatch.setattr(forks, "run_one", slow)
    clock = SimpleNamespace(monotonic=lambda: now[0], process_time=lambda: 0.0)
    monkeypatch.setattr(proof_campaign, "time", clock)
    assert f"HELD in {MOST} of " in prove("--budget", f"{4 * MOST + 8}s")  # no more than the first portion
    assert 4 * MOST + 8 < now[0] <= 4 * MOST + 8 + 5


def test_the_acts_that_got_a_cell_ready_are_known_by_step(plant: Path) -> None:
    model, calm = calm_of(plant)
    proof = Proof(model=model, calm=(calm,), kinds=("operator_stop",))
    tally = ProofTally(proof=proof, proved={0: proof.run(0)})
    by_step = {case.instant.what: case.outcome for case in tally.cases()}
    assert by_step["the request"].did == ("clear bench", "reset bench", "resume bench")
    assert {len(each.did) for each in by_step.values()} == {each.acts for each in by_step.values()} == {3}
    assert all(outcome_from(json.loads(json.dumps(plain(each)))) == each for each in by_step.values())


def test_what_a_run_took_is_said_and_on_what(plant: Path, prove: Prove) -> None:
    assert "a run took " in prove("--fault", "forgets") and "a run took" not in prove("--fault", "forgets")
    spent = Spent(courses_s=0.1, walks_s=0.3, forks_s=0.4, steps_s=1.2, plant_s=40.0, runs=4, joined=1)
    assert spent.words == (
        "a run took 500 ms of a processor: 300 ms to judge 10.0 s of the plant, 100 ms to fork, "
        "100 ms for what runs share; 25% ended early, as without the fault"
    )


@pytest.mark.long
def test_the_check_that_notices_is_proposed_as_an_edit_with_which_it_is_noticed(
    plant: Path, prove: Prove
) -> None:
    recipes = plant.parent / "small.py"
    recipes.write_text(QUIET.replace(', ends_with={"lamp.lit": True}', ""))
    prove("--fault", "refuses", "--mend")
    found = summary(plant)
    assert found["findings"] == [] and found["unnoticed"]
    (edit,) = found["mend"]["edits"]
    assert edit["new"] == ', cell.device("lamp").becomes(lit=True, at_most_s=2)'
    text = edited({"small.py": recipes.read_text()}, [Edit(**edit)])["small.py"]
    recipes.write_text(text)
    prove("--fault", "refuses")
    assert summary(plant)["unnoticed"] == []


def test_what_fails_without_any_fault_is_a_finding_and_gets_its_mend(plant: Path, prove: Prove) -> None:
    plant.write_text(PLANT.replace("test: {effect: query,", "test: {effect: query, needs: {lit: true},"))
    (plant.parent / "small.py").write_text(GOOD.replace("light(on=True)", "test()"))
    prove("--fault", "refuses", "--mend", ends=1)
    found = summary(plant)
    assert [each["source"] for each in found["findings"]] == ["run without faults"]
    assert found["mend"]["left"] == 0 and "light(on=True)" in found["mend"]["edits"][0]["new"]
