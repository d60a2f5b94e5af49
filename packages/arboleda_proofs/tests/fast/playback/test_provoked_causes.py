"""Faults by hand and of the simulator, beside the cause of a failed task."""

from __future__ import annotations

from arboleda.core.plant import Plant
from arboleda.model.messages import FaultByHand, Reason
from arboleda.rig.world import World
from arboleda.testing import shipped
from arboleda_proofs.campaigns.simulated_recorder import TapedPlant
from arboleda_proofs.playback.cause import Evidence, cause_of
from arboleda_proofs.playback.incident import Reader
from arboleda_proofs.playback.replay import plant_of
from arboleda_proofs.playback.troubles import BOOT
from arboleda_proofs.running.fault_desk import INSTANT
from arboleda_proofs.simulator.faults import KINDS, Fault

from .test_cause import ARM, trouble


def test_a_command_of_an_earlier_start_is_somebody_elses() -> None:
    model = shipped("sis_a")
    world = World(model, make_plant=TapedPlant)
    world.advance(2.0)
    world.request_task("sis_a 0B 7 #lot")
    world.advance(1.5)
    halt = Fault(kind="second_orchestrator", at=0.0, target="rm_sis_a", word="halt", seed=1)
    KINDS[halt.kind].begin(world, halt)
    world.advance(30.0)
    plant = world.plant
    assert isinstance(plant, TapedPlant)
    again, reader = plant_of(plant.beginning, model), Reader("lot", model, drawn=False)
    for step in plant.tape:
        reader.take(again, step.unix_ns, step.now, step.events, again.step(step.now, step.events))
    cause = reader.incident.cause
    assert (cause.kind, cause.robot) == ("foreign", "rm_sis_a")


def test_a_fault_by_hand_at_the_robot_stands_beside_the_cause() -> None:
    what = INSTANT(what="Reboot its board")

    def sentence(at: float, robot: str) -> str:
        known = {"reason": Reason.LINK_LOST, "key": "command.link_lost", "failed_at": 1000.0, "robot": ARM}
        booted = trouble(BOOT, 999.9)
        found = cause_of(Evidence(**known, troubles=[booted], provoked=[(at, robot, what)]))
        assert found.kind == "boot"
        return str(found.sentence)

    assert sentence(999.0, ARM).endswith(f"Shortly before: {what}")
    assert "by hand" not in sentence(999.0, "ra2")
    assert "by hand" not in sentence(1000.5, ARM)
    assert "by hand" not in sentence(500.0, ARM)


def test_the_record_of_a_task_has_the_faults_by_hand_that_began() -> None:
    reader = Reader("lot", shipped("sis_a"))
    plant = Plant(shipped("sis_a"), epoch=1, now=0.0)
    told = INSTANT(what="Reboot its board")
    events = [
        FaultByHand(at=0.5, robot=ARM, sentence=told),
        FaultByHand(at=0.6, robot=ARM, sentence=told, is_over=True),
    ]
    reader.take(plant, 0, 0.6, events, plant.step(0.6, events))
    assert reader.incident.provoked == [(0.5, ARM, told)]
