"""Instants that are one for a fault: which one is tried, and that it stands for the others."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Hashable, Iterator
from itertools import chain, repeat
from pathlib import Path
from types import SimpleNamespace

import pytest
from tests.lengths import length

from arboleda.model.plant_model import PlantModel
from arboleda_proofs.campaigns.proof import proof_campaign
from arboleda_proofs.campaigns.proof.calm import Calm, calm_runs
from arboleda_proofs.campaigns.proof.course import course_of
from arboleda_proofs.campaigns.proof.forecast import Forecast
from arboleda_proofs.campaigns.proof.forks import run_all
from arboleda_proofs.campaigns.proof.outcome import Outcome
from arboleda_proofs.campaigns.proof.proof import Proof
from arboleda_proofs.campaigns.proof.representatives import FIRSTS, Representatives
from arboleda_proofs.campaigns.proof.scenario import scenarios
from arboleda_proofs.campaigns.proof.single_faults import single_faults
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.faults.operators import NOWHERE

from .lamp import GOOD, PRESS, Prove, calm_of, summary
from .lamp import plant as plant
from .lamp import prove as prove

ROUNDS = """
from arboleda.recipes import recipe, work


@recipe("stamp", ends_with={"press.ram": "up"})
def stamp(cell):
    press = cell.device("press")
    rounds = [(press.press(), press.lift()) for _ in range(3)]
    return work(*(each for pair in rounds for each in pair))
"""
ONCE = """

@recipe("lift", ends_with={"press.ram": "up"})
def lift(cell):
    return work(cell.device("press").lift())
"""
CARELESS = ROUNDS.replace("press.lift())", "cell.fallback(press.lift(), cell.wait(1)))").replace("(3)", "(2)")
DIFFER = 0.05  # of instants may end otherwise than those that stand for them
KINDS = ("gives_up", "refuses", "reboot", "partition", "operator_hold", "plant_crash", "lying_fact", "loss")


def representatives(plant: Path, recipe: str, *kinds: str, every: bool = False) -> Representatives:
    plant.write_text(PRESS)
    (plant.parent / "small.py").write_text(recipe)
    model, calm = calm_of(plant)
    return Representatives(model=model, calm=(calm,), kinds=kinds, every=every)


def at(tried: Representatives) -> list[str]:
    """The instants at which something is tried."""
    instants = tried.calm[0].instants
    return [instants[number].name for (_, number), parts in tried.parts.items() if any(parts)]


def faults_of(tried: Representatives) -> list[list[Fault]]:
    """The faults that are tried, instant by instant."""
    return [[each for part in parts for each in part] for parts in tried.parts.values()]


def test_more_rounds_are_no_more_to_try(plant: Path) -> None:
    three, six = (representatives(plant, ROUNDS.replace("(3)", f"({each})"), "forgets") for each in (3, 6))
    assert [each.partition(" (")[0] for each in at(three)] == [each.partition(" (")[0] for each in at(six)]
    assert len(three.calm[0].instants) + 18 == len(six.calm[0].instants)
    assert at(three)[2:7] == [
        "just before press: doing press (2.200 s)",
        "just before press: doing press (5.200 s)",
        "in the middle after press: doing press (6.200 s)",
        "just before press: doing lift (7.200 s)",
        "in the middle after press: doing lift (7.700 s)",
    ]


def test_every_instant_is_tried_where_that_is_wanted_those_that_stand_for_others_first(plant: Path) -> None:
    some, every = (representatives(plant, ROUNDS, *KINDS, every=every) for every in (False, True))
    assert sum(len(part) for parts in every.parts.values() for part in parts) == every.total == some.total
    assert all(
        parts[:-1] == some.parts[place][:-1] for place, parts in every.parts.items() if place in some.parts
    )


def test_a_verb_that_the_plant_refuses_is_tried_once(plant: Path) -> None:
    verbs = ("operator_retry", "operator_hold")
    tried = representatives(plant, ROUNDS, *verbs)
    faults = Counter((each.kind, each.target) for some in faults_of(tried) for each in some)
    assert faults["operator_retry", "bench"] == faults["operator_hold", NOWHERE] == 1
    assert faults["operator_hold", "bench"] > 5


def test_what_sticks_while_nothing_else_is_told_is_tried_once(plant: Path) -> None:
    tried = representatives(plant, ROUNDS, "stuck_bit")
    words = Counter((each.word, each.seconds) for some in faults_of(tried) for each in some)
    assert words["arranque", 15.0] == words["arranque", 0.5] == 1 < words["hecho", 15.0]


def test_of_words_that_are_alike_one_is_tried_at_an_instant_and_each_at_some(plant: Path) -> None:
    tried = representatives(plant, ROUNDS, "garbled_telemetry")
    faults = faults_of(tried)
    assert all(len({each.word for each in some if each.seconds == 10.0}) <= 1 for some in faults)
    assert len({each.word for some in faults for each in some}) > 2


def test_a_death_behind_a_commit_is_one_before_the_next_one(plant: Path) -> None:
    tried = representatives(plant, ROUNDS, "crash_in_step")
    first = max(faults_of(tried), key=len)
    deaths = {(each.amount, each.word) for each in first if each.seconds == 12.0}
    assert len(deaths) > 2
    assert len(deaths) == len({amount - (word == "before") for amount, word in deaths})


def test_one_fault_of_each_kind_at_each_kind_of_step_comes_first(plant: Path) -> None:
    tried = representatives(plant, ROUNDS, *KINDS)
    firsts = [fault.kind for parts in tried.parts.values() for fault in parts[FIRSTS]]
    proof = Proof(model=tried.model, calm=tried.calm, kinds=KINDS)
    assert set(firsts) == set(KINDS)
    assert [portion.part for portion in proof.portions][:3] == [FIRSTS] * 3
    assert len(firsts) < proof.total / 3


def test_after_as_many_runs_as_pairs_of_a_step_and_a_kind_each_pair_was_met_once(plant: Path) -> None:
    tried = representatives(plant, ROUNDS + ONCE)
    calm = tuple(calm_runs(tried.model, scenarios(tried.model)))
    proof = Proof(model=tried.model, calm=calm)
    met = []
    for each in proof.portions:
        scenario, sights = calm[each.scenario].scenario, calm[each.scenario].sights
        step = scenario.recipe, sights.step(proof.instant(each))
        met += [(*step, fault.kind) for fault in proof.faults(each)]
    pairs = set(met)
    assert {each[0] for each in pairs} == {"stamp", "lift"}
    assert len(met[: len(pairs)]) == len({*met[: len(pairs)]}) == len(pairs) < proof.total / 3
    begun = [(each.scenario, proof.instant(each).at) for each in proof.portions[:8]]
    assert len({*begun}) > 4  # so the first 64 runs are not all of one step


def test_a_forecast_says_how_much_there_is_to_do_and_for_how_much_there_is_time(plant: Path) -> None:
    tried = representatives(plant, ROUNDS, *KINDS)
    proof = Proof(model=tried.model, calm=tried.calm, kinds=KINDS)
    forecast = Forecast(proof=proof, pace=0.01, jobs=2, budget_s=1.0)
    assert forecast.words.startswith(f"1 recipe, classes of instants: about {proof.total} runs, ")
    assert " s on 2 cores; --budget is enough for about " in forecast.words


def test_the_first_line_is_the_same_however_many_tasks_run_before_the_second(
    plant: Path, prove: Prove, monkeypatch: pytest.MonkeyPatch
) -> None:
    recipes = plant.parent / "small.py"
    recipes.write_text(GOOD + GOOD.partition("work\n")[2].replace("shine", "glow"))
    seconds = chain([0.0, 1.0, 3.0], repeat(3.0))  # when it begins, and before the first two tasks
    clock = SimpleNamespace(monotonic=lambda: next(seconds), process_time=lambda: 0.0)
    whole = prove("--fault", "forgets").splitlines()[:2]
    monkeypatch.setattr(proof_campaign, "time", clock)
    cut = prove("--fault", "forgets", "--budget", "4s").splitlines()
    assert whole[0] == cut[0] == "2 recipes, 2 tasks, 1 kind of fault; first each task without faults"
    assert whole[1].startswith("2 recipes, classes of instants: about 8 runs, ")
    assert any(each.startswith("half of --budget was over when 1 task had run") for each in cut)


def test_the_answer_says_how_many_runs_stand_for_how_many(plant: Path, prove: Prove) -> None:
    drawn, page = plant.parent / "out.svg", plant.parent / "out.html"
    said = prove("--fault", "forgets", "--badge", drawn, "--html", page)
    assert (
        "HELD: all 4 runs, every single fault of 1 kind at one instant of each class; --all-instants tries 5"
        in said
    )
    assert summary(plant)["runs"] == {"done": 4, "of": 4, "represented": 5}
    assert "held: each class, 4" in drawn.read_text()
    assert "at one instant of each class, of 5 at all instants" in page.read_text()


def test_what_was_run_of_classes_counts_where_every_instant_is_wanted(plant: Path, prove: Prove) -> None:
    prove("--fault", "forgets")
    assert "5 runs, 4 of them kept from before" in prove("--fault", "forgets", "--all-instants")
    assert summary(plant)["runs"]["of"] == 5


@pytest.mark.long
@pytest.mark.timeout(3600)  # every instant takes minutes
@pytest.mark.parametrize("recipe", [ROUNDS.replace("(3)", "(1)"), CARELESS])
def test_an_instant_that_is_tried_stands_for_the_others(plant: Path, recipe: str) -> None:
    tried = representatives(plant, recipe, *length(KINDS, whole=()))
    outcomes = dict(every_instant(tried.model, tried.calm[0], tried.kinds))
    classes: dict[Hashable, list[tuple[Fault, Outcome]]] = defaultdict(list)
    for (number, fault), outcome in outcomes.items():
        classes[tried.class_of((0, number), fault)].append((fault, outcome))
    chosen = [
        (number, fault) for (_, number), parts in tried.parts.items() for part in parts for fault in part
    ]
    ends = {tried.class_of((0, number), fault): outcomes[number, fault].words for number, fault in chosen}
    wrong = sum(each.words != ends[key] for key, members in classes.items() for _, each in members)
    assert len(chosen) == len(classes) < len(outcomes) and wrong / len(outcomes) < DIFFER
    found = {each for key in chosen for each in findings(key[1], outcomes[key])}
    assert {each for (_, fault), outcome in outcomes.items() for each in findings(fault, outcome)} == found


def every_instant(
    model: PlantModel, calm: Calm, kinds: tuple[str, ...]
) -> Iterator[tuple[tuple[int, Fault], Outcome]]:
    """The outcome of each fault at each instant, by the number of that."""
    course = course_of(model, calm)
    for number, instant in enumerate(calm.instants):
        parts = single_faults(model, model.cells[0], instant, number=number, only=kinds)
        faults = [each for part in parts for each in part]
        runs = run_all(model, calm, faults, lambda: None, course=course)
        yield from (((number, fault), run.outcome) for fault, run in zip(faults, runs, strict=True))


def findings(fault: Fault, outcome: Outcome) -> Iterator[tuple[str, ...]]:
    """Findings of a run."""
    if outcome.broken:
        yield outcome.broken[0], fault.kind, fault.target
    elif outcome.takes_too_much or outcome.goes_unnoticed:
        yield "unmended" if outcome.takes_too_much else "unnoticed", fault.kind, fault.target
