"""What the simulator found: each bug with the seed and the few faults that showed it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib.resources import as_file, files
from pathlib import Path

import pytest
from tests.scenario.test_found_by_simulation import boards_that_know_no_visto as boards_that_know_no_visto
from tests.scenario.test_found_by_simulation import in_one_centre
from tests.scenario.test_found_by_simulation import rig as rig

from arboleda.kinds.arm import SetEffector
from arboleda.model.cell_states import CellState
from arboleda.model.messages import TaskState
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load
from arboleda.rig import faults
from arboleda.testing import Rig, shipped
from arboleda.wire.board import Board, Message
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.run import Simulation
from arboleda_proofs.simulator.shrink import explicit
from arboleda_proofs.testing import Witness

EXAMPLES = Path(__file__).parents[5] / "examples"


@dataclass(frozen=True, kw_only=True)
class Found:
    """A bug: odd seeds simulate the shipped plant, even ones the shared one, unless it is in an `example`."""

    seed: int
    seconds: float
    faults: tuple[Fault, ...]
    example: str = ""

    @property
    def model(self) -> PlantModel:
        if self.example:
            return load(EXAMPLES / self.example / "plant.yaml")
        if self.seed % 2:
            return shipped()
        with as_file(files("arboleda") / "plants" / "shared.yaml") as path:
            return load(path)


NEW_PLANT_IN_A_STALL = (
    Fault(kind="piece_false", at=1.0, seconds=4.2, target="arm_back", word="a piece"),
    Fault(kind="bridge_restart", at=2.0, seconds=1.5, target="bridge"),
    Fault(kind="bridge_stall", at=3.3, seconds=3.7, target="bridge"),
)


FOUND = {
    "a step of a tree file that was tried again as it failed seemed not to begin anew, to the judge": Found(
        seed=5,
        seconds=75,
        faults=(Fault(kind="bridge_stall", at=27.938, seconds=1.386, target="bridge"),),
        example="own_tree",
    ),
    "a beat that no plant can have sent was taken for that of a leader, by the judge": Found(
        seed=73,
        seconds=60,
        faults=(Fault(kind="foreign_garbage", at=17.891, target="rm_sis_b", word="latido", seed=31),),
    ),
    "a halt that never left seemed to settle the move before it, which a stalled board obeyed late": Found(
        seed=2,
        seconds=60,
        faults=(
            Fault(kind="board_stall", at=7.3, seconds=13.2, target="arm_left", seed=1),
            Fault(
                kind="duplicate",
                at=20.1,
                seconds=2.0,
                target="arm_left",
                amount=0.5,
                word="up",
                seed=2,
            ),
        ),
    ),
    "an arm from which an override took one of its zones went through that zone on its way home": Found(
        seed=2,
        seconds=30,
        faults=(
            Fault(kind="broker_restart", at=3.8, seconds=1.0, target="broker", seed=1),
            Fault(kind="broker_restart", at=6.0, seconds=4.1, target="broker", seed=1),
            Fault(kind="operator_override", at=8.4, target="corner", seed=1),
            Fault(kind="operator_retry", at=9.9, target="right", seed=1),
        ),
    ),
    "a task opened the effector of an arm that somebody else had stopped while the plant was stalled": Found(
        seed=4,
        seconds=30,
        faults=(
            Fault(kind="plant_stall", at=6.9, seconds=2.5, target="plant", seed=1),
            Fault(kind="second_orchestrator", at=8.3, target="arm_right", word="stop", seed=1),
        ),
    ),
    "a move that was sent and lost in one long step seemed open when the next one left in it": Found(
        seed=1,
        seconds=30,
        faults=(
            Fault(kind="operator_hold", at=2.0, target="sis_a", seed=1),
            Fault(kind="mute", at=2.5, seconds=1.7, target="ra_1", seed=1),
            Fault(kind="plant_stall", at=3.0, seconds=3.0, target="plant", seed=1),
            Fault(kind="operator_resume", at=3.5, target="sis_a", seed=1),
        ),
    ),
    "what an arm said before somebody put it by hand to its reference was taken for a lie": Found(
        seed=2,
        seconds=30,
        faults=(
            Fault(kind="plant_stall", at=1.9, seconds=2.0, target="plant", seed=1),
            Fault(kind="operator_home", at=2.7, target="arm_right", word="by hand", seed=1),
        ),
    ),
    "positions of a bridge that stalled while its broker was away were taken for invented": Found(
        seed=344,
        seconds=120,
        faults=(
            Fault(kind="bridge_stall", at=66.59, seconds=2.167, target="bridge", seed=148631179),
            Fault(kind="broker_restart", at=66.625, seconds=4.202, target="broker", seed=316738146),
        ),
    ),
    "after a hold, a piece check woke its tree for ever, one rounding step apart": Found(
        seed=16,
        seconds=240,
        faults=(Fault(kind="operator_hold", at=101.563, target="arm_left", seed=2718880527),),
    ),
    "an arm that was homed beside its home pose was never seen outside the zones": Found(
        seed=8,
        seconds=180,
        faults=(
            Fault(
                kind="brown_out",
                at=145.239,
                seconds=14.18,
                target="scara_7",
                amount=4.08,
                seed=3978758097,
            ),
        ),
    ),
    "homing drove an arm through a zone that another one held": Found(
        seed=40,
        seconds=240,
        faults=(
            Fault(kind="broker_restart", at=71.263, seconds=2.323, target="broker", seed=2995232826),
            Fault(
                kind="reorder",
                at=106.244,
                seconds=11.077,
                target="bridge",
                amount=0.176,
                word="down",
                seed=3842073692,
            ),
            Fault(kind="reboot", at=150.312, target="scara_7", word="no will", seed=3040345968),
            Fault(kind="reboot", at=204.394, target="arm_back", word="no will", seed=2513146944),
            Fault(kind="operator_stop", at=205.249, target="back", seed=2403544348),
        ),
    ),
    "a held recovery that was abandoned left the cell's time standing still": Found(
        seed=49,
        seconds=120,
        faults=(
            Fault(
                kind="delay",
                at=4.014,
                seconds=19.598,
                target="ra_3",
                amount=0.155,
                word="up",
                seed=3539512268,
            ),
            Fault(kind="bridge_restart", at=6.238, seconds=0.499, target="bridge", seed=878159540),
            Fault(kind="foreign_halt", at=15.857, target="rm_sis_a", seed=657391177),
            Fault(kind="foreign_halt", at=16.801, target="rm_sis_c", seed=626605706),
            Fault(
                kind="lying_telemetry",
                at=39.527,
                seconds=0.378,
                target="rm_sis_a",
                amount=7.248,
                word="estado",
                seed=3995591584,
            ),
            Fault(
                kind="loss",
                at=41.283,
                seconds=23.875,
                target="ra_2",
                amount=0.081,
                word="down",
                seed=2446762277,
            ),
            Fault(
                kind="hop_partition",
                at=44.793,
                seconds=9.524,
                target="plant",
                word="to plant, held",
                seed=526769680,
            ),
            Fault(kind="stuck_effector", at=64.25, seconds=24.182, target="ra_2", seed=2083198559),
            Fault(kind="operator_hold", at=95.623, target="rm_sis_b", seed=1231062870),
        ),
    ),
    "an override freed a zone under an arm that was still at work in it": Found(
        seed=206,
        seconds=60,
        faults=(
            Fault(kind="bridge_stall", at=6.169, seconds=2.344, target="bridge", seed=3373212668),
            Fault(kind="operator_override", at=7.862, target="table", seed=1534135969),
        ),
    ),
    "a recovery crossed a zone on its way from a station outside it": Found(
        seed=10,
        seconds=60,
        faults=(
            Fault(kind="broker_restart", at=20.052, seconds=2.387, target="broker"),
            Fault(kind="hop_partition", at=26.358, seconds=2.706, target="plant", word="to bridge, held"),
            Fault(kind="hop_partition", at=27.638, seconds=7.644, target="plant", word="to plant, lost"),
        ),
    ),
    "a move of the work, given anew and halted in the same step, was taken for one of the recovery": Found(
        seed=166,
        seconds=60,
        faults=(
            Fault(
                kind="delay",
                at=17.618,
                seconds=2.147,
                target="bridge",
                amount=1.041,
                word="down",
                seed=4208822265,
            ),
            Fault(
                kind="plant_freeze",
                at=24.522,
                seconds=1.407,
                target="plant",
                amount=6.779,
                word="plant",
                seed=867490635,
            ),
            Fault(kind="plant_stall", at=47.886, seconds=4.381, target="plant", seed=1350324084),
            Fault(kind="lost_part", at=52.441, target="arm_back", seed=3420715198),
        ),
    ),
    "an effector that somebody opened while its report was on its way counted as never closed": Found(
        seed=303,
        seconds=31,
        faults=(
            Fault(kind="brown_out", at=2.811, seconds=11.449, target="ra_1", amount=5.093, seed=134363669),
            Fault(
                kind="hop_reorder",
                at=18.494,
                seconds=13.639,
                target="plant",
                amount=0.313,
                word="to plant",
                seed=2742292697,
            ),
            Fault(kind="opened_effector", at=29.613, target="ra_1", seed=1929225998),
        ),
    ),
    "an arm that rose, as its recovery begins, to where home is seemed to go there without its zones": Found(
        seed=652,
        seconds=61,
        faults=(
            Fault(kind="broker_restart", at=52.736, seconds=2.078, target="broker"),
            Fault(kind="broker_restart", at=57.166, seconds=3.149, target="broker"),
            Fault(
                kind="lying_telemetry",
                at=60.0,
                seconds=5.337,
                target="arm_back",
                amount=37.489,
                word="q3_mov",
            ),
        ),
    ),
    "a bridge that had heard no plant for long obeyed a copy that came before its original": Found(
        seed=830,
        seconds=123,
        faults=(
            Fault(kind="no_part", at=83.56, seconds=3.2, target="arm_left"),
            Fault(kind="bridge_restart", at=89.909, seconds=1.603, target="bridge"),
            Fault(
                kind="plant_freeze", at=113.207, seconds=2.043, target="plant", amount=3564.123, word="plant"
            ),
            Fault(kind="hop_partition", at=113.843, seconds=8.24, target="plant", word="to bridge, held"),
            Fault(kind="hop_partition", at=114.956, seconds=0.412, target="plant", word="to bridge, held"),
        ),
    ),
    "an effector that opened late was judged by a command that left in the same step": Found(
        seed=914,
        seconds=40,
        faults=(
            Fault(kind="brown_out", at=10.21, seconds=5.753, target="mobile_right", amount=4.305),
            Fault(kind="brown_out", at=12.101, seconds=1.138, target="scara_7", amount=3.213),
            Fault(kind="brown_out", at=20.028, seconds=19.113, target="mobile_back", amount=0.607),
            Fault(
                kind="hop_reorder",
                at=31.638,
                seconds=3.786,
                target="plant",
                amount=0.617,
                word="to plant",
                seed=1465144477,
            ),
            Fault(kind="operator_cancel", at=31.909, target="left"),
            Fault(kind="brown_out", at=36.914, seconds=4.485, target="mobile_left", amount=2.446),
            Fault(kind="hop_partition", at=38.184, seconds=1.523, target="plant", word="to bridge, held"),
        ),
    ),
    "a bridge that stalled seemed to tell a new plant words that its board took back in the same step": Found(
        seed=1054,
        seconds=8,
        faults=NEW_PLANT_IN_A_STALL,
    ),
    "a stalled bridge seemed to invent that a link was lost, for it refused a stop before it was back": Found(
        seed=1675,
        seconds=8,
        faults=(
            Fault(kind="broker_restart", at=3.0, seconds=2.4, target="broker"),
            Fault(kind="bridge_stall", at=3.3, seconds=3.0, target="bridge"),
            Fault(kind="operator_stop", at=4.0, target="sis_a"),
        ),
    ),
    "a stuck effector of which nobody reports anything was to be in the books of a task not checked": Found(
        seed=904,
        seconds=54,
        faults=(
            Fault(kind="partition", at=0.529, seconds=2.323, target="mobile_right", word="up, lost"),
            Fault(kind="hop_partition", at=12.821, seconds=6.697, target="plant", word="to bridge, held"),
            Fault(kind="hop_partition", at=20.467, seconds=7.959, target="plant", word="to bridge, lost"),
            Fault(kind="stuck_effector", at=42.989, seconds=22.063, target="scara_7"),
        ),
    ),
    "a person who was stopped counted as not stopped once a plant had died as it cleared the cell": Found(
        seed=21,
        seconds=58,
        example="lab_bench",
        faults=(
            Fault(kind="operator_stop", at=53.303, target="operator"),
            Fault(kind="crash_in_step", at=53.433, seconds=6.838, target="plant", amount=6.036, word="after"),
        ),
    ),
}


CASES = dict(sorted(FOUND.items(), key=lambda row: row[1].seconds))


@pytest.mark.sampled(40)
@pytest.mark.parametrize("found", list(CASES.values()), ids=list(CASES))
def test_every_invariant_holds_where_it_once_broke(found: Found) -> None:
    result = Simulation(found.model, found.seed, explicit(found.faults)).run(seconds=found.seconds)
    assert result.broken is None, result.broken


@pytest.mark.long
def test_a_new_plant_is_told_nothing_but_the_last_words_before_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def hear_plant(board: Board, at: float, epoch: int) -> list[Message]:
        """Says already what the board says only later in the same step."""
        return [replace(each, piece=False) if each.piece else each for each in told(board, at, epoch)]

    told = Board.hear_plant
    monkeypatch.setattr(Board, "hear_plant", hear_plant)
    found = Found(seed=1054, seconds=8, faults=NEW_PLANT_IN_A_STALL)
    result = Simulation(found.model, found.seed, explicit(found.faults)).run(seconds=found.seconds)
    assert str(result.broken).startswith(
        "telemetry_is_reported: arm_back is reported with what it has not said"
    )


def test_a_recovery_keeps_the_zones_that_it_takes_on_its_way_back() -> None:
    rig = Rig(in_one_centre())
    witness = Witness(rig)
    rig.wait(0.5)
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to station 7")
    rig.lost = faults.nth("ra_1/efector", 1)
    rig.submit("sis_b palletizing")
    rig.wait(60.0)
    assert rig.outcomes()["t-1000-1"].state is TaskState.FAILED
    assert rig.outcomes()["t-1000-2"].state is TaskState.DONE
    assert witness.collisions == []


@pytest.mark.usefixtures("boards_that_know_no_visto")
def test_no_task_starts_on_an_arm_that_may_hold_a_part(rig: Rig) -> None:
    """Effector on comes 3 s late while reports are lost: given up, it shows on the way home."""
    witness = Witness(rig)
    rig.submit("sis_a palletizing")
    rig.submit("sis_a palletizing")
    rig.wait_for("sis_a", "move to pick-up")
    rig.to_bridge.troubles.append(
        lambda message: (3.0,) if isinstance(message, SetEffector) and message.on else (0.0,)
    )
    rig.wait_for("sis_a", "effector on/switch")
    rig.to_plant.troubles.append(lambda message: ())
    rig.wait(1.6)
    rig.to_plant.troubles.clear()
    rig.wait(10.0)
    assert rig.outcomes()["t-1000-2"].state is TaskState.QUEUED
    assert rig.plant.cells["sis_a"].state is CellState.HELD
    assert witness.false_successes == []
