"""Without faults, a task that fails or a command that is refused is a finding of its recipe."""

from __future__ import annotations

from collections import Counter
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console
from tests.unit.kinds.lab import model

from arboleda.model.messages import Verb
from arboleda.plant_file.loader import load
from arboleda.recipes import Choice, Kit, recipe, work
from arboleda_proofs.campaigns import report, single_seed, summary
from arboleda_proofs.campaigns.request import Request
from arboleda_proofs.campaigns.seed_campaign import BROKEN, HELD, SeedCampaign
from arboleda_proofs.campaigns.tally import Tally
from arboleda_proofs.campaigns.workers import Processes
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.findings import Finding
from arboleda_proofs.simulator.run import Result, Simulation

PLANT = """
name: bench
uses: [recipes.py]
kinds:
  mover:
    facts: {plate: bool, out: bool}
    verbs:
      take_out: {effect: motion, sets: {out: true}, takes_s: 1}
      look: {effect: query, answers: [good, bad], takes_s: 1}
cells:
  bench: {devices: {mover: {kind: mover}}}
"""
RECIPE = """
from arboleda.recipes import recipe, work

@recipe("assay")
def assay(cell):
    mover = cell.device("mover")
    return work(mover.take_out(), mover.says(plate=True))
"""


@recipe("open_lid")
def open_lid(cell: Kit):  # type: ignore[no-untyped-def]
    return cell.device("oven").bake(dose=5)


@recipe("instead")
def instead(cell: Kit):  # type: ignore[no-untyped-def]
    oven = cell.device("oven")
    return cell.fallback(oven.bake(dose=5), oven.close())


@recipe("says")
def says(cell: Kit):  # type: ignore[no-untyped-def]
    return cell.device("oven").says(lid="closed")


@recipe("looks")
def looks(cell: Kit):  # type: ignore[no-untyped-def]
    seen = cell.device("eye").look()
    return work(seen, cell.choose(seen, {"good": [], "bad": cell.fail("the sample is bad")}))


@recipe("dies")
def dies(cell: Kit):  # type: ignore[no-untyped-def]
    return cell.fail("always")


@recipe("rescues")
def rescues(cell: Kit):  # type: ignore[no-untyped-def]
    seen = cell.device("eye").look()
    ways = {"good": cell.fail("no"), "bad": cell.fail("no")}
    return cell.recover([seen, cell.choose(seen, ways)], cell.device("oven").says(lid="closed"))


@recipe("good")
def good(cell: Kit, dose: Choice[5, 10]):  # type: ignore[no-untyped-def,valid-type]
    oven = cell.device("oven")
    bakes = [oven.clamp(on=True), oven.close(), oven.bake(dose=dose), oven.open(), oven.clamp(on=False)]
    return work(*bakes)


def run(*recipes: Any, faults: tuple[Fault, ...] = (), cycles: int = 4) -> Result:
    def plan(minute: int) -> list[Fault]:
        return list(faults) if minute == 0 else []

    result = Simulation(model(*recipes), 1, plan, invariants=()).run(cycles=cycles)
    assert result.broken is None and sum(result.outcomes.values()) >= cycles
    return result


def told(found: Counter[Finding]) -> set[str]:
    return {f"{each.kind.value} {each.recipe} [{each.step}] {each.reason}: {each.sentence}" for each in found}


@pytest.mark.sampled(5)
@pytest.mark.parametrize(
    ("recipe", "finding"),
    [
        (open_lid, "task failed open_lid [oven bake 5] precondition: oven needs lid to be closed, and said"
                   " open: no doing bake 5"),
        (instead, "command refused instead [oven: doing bake 5] precondition: oven needs lid to be closed,"
                  " and said open: no doing bake 5"),
        (says, "task failed says [says] precondition: oven says open of lid; closed is needed"),
        (dies, "task failed dies [fail] rejected: always"),
        (rescues, "task failed rescues [fail] rejected: no; and the rescue failed: oven says open of"
                  " lid; closed is needed"),
    ],
)  # fmt: skip
def test_what_fails_or_is_refused_is_found(recipe: Any, finding: str) -> None:
    result = run(recipe)
    assert told(result.findings) >= {finding}
    assert not result.as_written


BENCH = """
name: bench
uses: [recipes.py]
cells:
  bench:
    devices: {arm: {kind: arm, model: scara}, jaw: {kind: gripper, tool_of: arm}}
    targets:
      home: {arm: {deg: [0, 0], mm: 0}}
      in: {arm: {deg: [60, 20], mm: 50}}
      tray: {arm: {deg: [30, 60], mm: 50}}
    places: {in: {supply: true}, tray: {}}
"""
BRINGS = """
from arboleda.recipes import recipe, work

@recipe("bring")
def bring(cell):
    arm, jaw = cell.devices("arm", "jaw")
    take, put = jaw.close(width_mm=30, force_n=20), jaw.open()
    return work(arm.visit("FROM", take), arm.visit("TO", put), arm.home())
"""


@pytest.mark.parametrize(
    ("way", "advice"),
    [
        (
            ("in", "tray"),
            '; a recipe can wait for room there: cell.place("tray").gets_room(...), in XML place_gets_room',
        ),
        (
            ("tray", "in"),
            '; a recipe can wait for a part there: cell.place("tray").gets_part(...), in XML place_gets_part',
        ),
    ],
    ids=["full", "empty"],
)
def test_a_recipe_without_a_part_or_room_is_told_once_how_to_wait_for_it(
    tmp_path: Path, way: tuple[str, str], advice: str
) -> None:
    (tmp_path / "recipes.py").write_text(BRINGS.replace("FROM", way[0]).replace("TO", way[1]), "utf-8")
    (tmp_path / "plant.yaml").write_text(BENCH, "utf-8")
    simulation = Simulation(load(tmp_path / "plant.yaml"), 1, lambda minute: [], invariants=())
    (found,) = simulation.run(cycles=3).findings
    assert found.sentence.endswith(advice) and found.sentence.count("a recipe can wait") == 1


def test_it_is_counted() -> None:
    (count,) = run(says, cycles=5).findings.values()
    assert count >= 5


def test_what_a_recipe_says_to_an_answer_is_counted_apart() -> None:
    result = run(looks, cycles=12)
    assert not result.findings
    assert told(result.as_written) == {"task failed looks [fail] rejected: the sample is bad"}


def test_nothing_is_found_in_what_works() -> None:
    result = run(good)
    assert not result.findings and not result.as_written and result.outcomes == {"done": result.cycles}


def test_nothing_is_found_where_something_goes_wrong() -> None:
    result = run(says, faults=(Fault(kind="bridge_stall", at=1.0, seconds=0.1),))
    assert result.faults and result.outcomes and not result.findings


def test_people_who_cancel_are_no_finding() -> None:
    simulation = Simulation(model(good), 1, lambda minute: [], invariants=())
    world = simulation.world
    cancelled = []

    def cancel() -> None:
        run = world.plant.cells["bench"]
        if run.task is not None and not cancelled:
            cancelled.append(run.task.id)
            world.request_verb(Verb.CANCEL, run.task.id)

    world.watchers.append(cancel)
    result = simulation.run(cycles=3)
    assert result.outcomes["cancelled"] == 1 and not result.findings


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "plant.yaml").write_text(PLANT)
    (tmp_path / "recipes.py").write_text(RECIPE)
    return tmp_path / "plant.yaml"


@pytest.mark.long
def test_a_campaign_says_them_and_they_are_in_its_file(file: Path) -> None:
    request = Request(plant=file, seeds=2, cycles=3, faults="none")
    tally = Tally(setting=request.setting)
    for seed in request.turn:
        tally.add(request.setting.run(seed))
    (line,) = map(str, report.findings(tally))
    task = next(iter(tally.findings)).task
    count = tally.findings.total()
    assert line == (
        f'task failed {count} times without any fault: recipe assay, step "says" (precondition),'
        f' as in "{task}" of seed {request.turn[0]}:'
        " mover says false of plate; true is needed"
    )
    assert str(report.verdict(tally)) == f"FOUND: {count} findings in recipes, where nothing had gone wrong"
    (row,) = summary.summary(request, tally, None, complete=True)["findings"]
    assert (row["recipe"], row["step"], row["reason"], row["count"]) == (
        "assay",
        "says",
        "precondition",
        count,
    )


def test_tasks_that_tell_no_device_anything_end_a_seed_and_are_told(file: Path) -> None:
    (file.parent / "recipes.py").write_text(RECIPE.replace("mover.take_out(), ", ""))
    request = Request(plant=file, seeds=1, cycles=1000, faults="few")
    tally = Tally(setting=request.setting)
    result = request.setting.run(1)
    tally.add(result)
    assert result.in_vain and result.cycles == 0 and result.minutes < 5 and not tally.holds
    assert "100 tasks of each cell in a row told no device to do anything in 1 seed of 1;" in str(
        report.verdict(tally)
    )


@pytest.mark.long
def test_a_campaign_that_found_something_ends_with_1(file: Path, tmp_path: Path) -> None:
    request, console = Request(plant=file, seeds=1, cycles=2, faults="none"), Console(file=StringIO())
    assert SeedCampaign(request, console, None).run(Processes(1)) == BROKEN
    assert single_seed.run(request, console, trace=False, record=None, file=None) == BROKEN
    (tmp_path / "recipes.py").write_text(RECIPE.replace("plate=True", "plate=False"))
    request = Request(plant=file, seeds=1, cycles=2, faults="none")
    assert SeedCampaign(request, console, None).run(Processes(1)) == HELD


ANSWERED = '<mover_says plate="true"/>'
BY_ANSWER = """
<Sequence>
  <mover_look answer="{a}"/>
  <Switch2 variable="{a}" case_1="good" case_2="bad">
    <AlwaysFailure/><AlwaysFailure/><AlwaysFailure/>
  </Switch2>
</Sequence>
"""


@pytest.mark.long
@pytest.mark.parametrize(
    ("ways", "found", "as_written"),
    [(ANSWERED + BY_ANSWER, 0, 1), (BY_ANSWER + ANSWERED, 1, 0)],
    ids=["a tree that says failure to an answer", "a device that is not as it must be"],
)
def test_a_tree_is_judged_by_what_ended_it(tmp_path: Path, ways: str, found: int, as_written: int) -> None:
    tree = f'<root BTCPP_format="4"><BehaviorTree ID="T"><Fallback>{ways}</Fallback></BehaviorTree></root>'
    (tmp_path / "tree.xml").write_text(tree)
    (tmp_path / "plant.yaml").write_text(PLANT.replace("recipes.py", "tree.xml"))
    result = Simulation(load(tmp_path / "plant.yaml"), 1, lambda minute: ()).run(cycles=1)
    assert (len(result.findings), len(result.as_written)) == (found, as_written)
