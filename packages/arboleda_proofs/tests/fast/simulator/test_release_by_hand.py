"""A part that a person takes out of a gripper: nothing is commanded to that gripper's robot meanwhile."""

from __future__ import annotations

import pytest

from arboleda.dispatch.belief import Belief
from arboleda.dispatch.effectors import Effectors
from arboleda.model.messages import Verb
from arboleda.model.sentence import Phrase
from arboleda.rig.world import PLANT
from arboleda.testing import shipped
from arboleda_proofs.simulator.judged_world import BrokenInvariant, JudgedWorld

LATE_S = 0.002  # for so long the plant hears nothing, so that two things that happen meanwhile make one step


def with_a_part_in_hand() -> JudgedWorld:
    """Two cells: sis_a is held with a part in its gripper, sis_b has just let go of its own."""
    watched = JudgedWorld(shipped("sis_a", "sis_b"), keep=True)
    world = watched.world
    holds = world.plant.dispatcher.effectors.grips.holding
    world.advance(2.0)
    world.request_task("sis_a 1B 4")
    world.advance(0.3)
    world.request_task("sis_b 1B 4")
    assert world.advance(20.0, until=lambda: bool(holds("ra1")))
    world.request_verb(Verb.HOLD, "sis_a")
    assert world.advance(20.0, until=lambda: bool(holds("ra2")))
    assert world.advance(20.0, until=lambda: not holds("ra2"))
    return watched


def take_out_as_the_other_cell_goes_on(watched: JudgedWorld) -> list[str]:
    """The trace of the step in which a person takes the part from sis_a, and the arm of sis_b leaves."""
    world = watched.world
    world.advance(world.model.timing.effector_settle_s - LATE_S / 2)
    world.stall(PLANT, LATE_S)
    before = len(watched.trace.lines)
    world.request_verb(Verb.RELEASE, "sis_a", by_hand=True)
    world.advance(LATE_S)
    return watched.trace.lines[before:]


def test_another_cell_may_go_on_meanwhile() -> None:
    lines = "\n".join(take_out_as_the_other_cell_goes_on(with_a_part_in_hand()))
    assert "release sis_a by hand: the part was taken out" in lines
    assert "MoveJoints" in lines and "robot=ra2" in lines


def test_a_command_to_the_gripper_itself_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    watched = with_a_part_in_hand()
    declare, plant = Effectors.declare_empty, watched.world.plant

    def opens_it_too(effectors: Effectors, belief: Belief) -> None:
        doing = Phrase("test.opens", "opening")()
        plant.dispatcher.send(belief.robot.let_go, "sis_a", doing, watched.world.now, by_hand=True)
        declare(effectors, belief)

    monkeypatch.setattr(Effectors, "declare_empty", opens_it_too)
    with pytest.raises(BrokenInvariant, match="ra1 was commanded"):
        take_out_as_the_other_cell_goes_on(watched)
