"""The simulator judges that a robot which cells share is handed on empty and at home."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.kinds.test_shared_robots import plant

from arboleda.model.messages import TaskState, Verb
from arboleda.plant_file.loader import load
from arboleda.trees.hand_over import HandOver
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.judged import INVARIANTS
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld

RULE = "a_shared_device_is_handed_on_empty_at_home"


def two_tasks(text: str = "left carry") -> None:
    watched = JudgedWorld(plant(), invariants=[each for each in INVARIANTS if each.name == RULE])
    watched.world.advance(5.0)
    watched.world.request_task(text)
    watched.world.advance(60.0)
    watched.world.request_task("right carry")
    watched.world.advance(60.0)


def test_it_holds() -> None:
    two_tasks()


def test_it_bites_where_the_robot_is_left_anywhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(HandOver, "is_home", lambda self, device: True)
    with pytest.raises(BrokenInvariant, match=f"{RULE}.*robot is given back, and stands at"):
        two_tasks()


def test_it_bites_where_the_tool_is_left_with_a_part(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(HandOver, "may_hold", lambda self, device: False)
    with pytest.raises(BrokenInvariant, match=f"{RULE}.*jaw is given back, and holds a part"):
        two_tasks("left keep")


PLANT = """
name: two
uses: [recipes.py]
kinds:
  vise:
    facts: {clamped: bool}
    verbs:
      clamp:
        {effect: switch, with: {'on': bool}, sets: {clamped: $on}, holds: part, takes_s: 0.2, at_most_s: 1.2}
shared:
  vise: {kind: vise}
cells:
  left: {devices: {vise: {shared: vise}, ana: {kind: person}}}
  right: {devices: {vise: {shared: vise}, bob: {kind: person}}, zone_wait_s: 600}
"""
RECIPE = """
from arboleda.recipes import recipe, work

@recipe("clamp")
def clamp(cell):
    vise = cell.device("vise")
    return work(vise.clamp(on=True), vise.clamp(on=False))
"""


def clamping(folder: Path, fault: Fault) -> JudgedWorld:
    """Both cells want the vise, and something befalls its line as the first of them clamps a part."""
    (folder / "recipes.py").write_text(RECIPE, "utf-8")
    (folder / "plant.yaml").write_text(PLANT, "utf-8")
    watched = JudgedWorld(load(folder / "plant.yaml"))
    watched.expect(fault)
    watched.world.advance(5.1)
    watched.world.request_task("left clamp")
    watched.world.request_task("right clamp")
    return watched


def held(watched: JudgedWorld) -> tuple[str | None, str, object]:
    """The cell that has the vise, the grip that is believed of it, and its true one."""
    plant, vise = watched.world.plant, watched.world.boards["vise"]
    return (
        plant.zones.holder("vise"),
        plant.dispatcher.effectors.grips["vise"].value,
        vise.body.facts["clamped"],
    )


@pytest.mark.parametrize("late_s", [1.4, 2.5])
def test_it_holds_where_what_was_said_before_a_clamp_is_heard_after_that_has_failed(
    tmp_path: Path, late_s: float
) -> None:
    line = Fault(kind="delay", at=5.0, seconds=12.0, target="vise", amount=late_s, word="up")
    watched = clamping(tmp_path, line)
    watched.world.advance(15.0)
    assert held(watched) == ("left", "on", True)
    watched.world.request_verb(Verb.RELEASE, "vise")
    watched.world.advance(10.0)
    assert watched.world.plant.intake.tasks["t-1000-2"].state is TaskState.DONE


def test_what_has_lost_the_order_to_clamp_is_handed_on_once_it_has_named_a_later_one(tmp_path: Path) -> None:
    line = Fault(kind="partition", at=5.0, seconds=1.0, target="vise", word="down, lost")
    watched = clamping(tmp_path, line)
    watched.world.advance(20.0)
    states = [task.state for task in watched.world.plant.intake.tasks.values()]
    assert states == [TaskState.FAILED, TaskState.DONE]
    assert held(watched) == (None, "off", False)
