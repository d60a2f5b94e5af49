"""What plants drawn from a seed have found: each plant, as much of it as was needed, with seed and faults."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
import yaml

from arboleda.app.simulate.drawn import loaded
from arboleda.simulator.faults import Fault
from arboleda.simulator.run import Simulation
from arboleda.simulator.shrink import explicit


@dataclass(frozen=True, kw_only=True)
class Found:
    """A breach: the plant file, the seed of the people, and what went wrong."""

    file: str
    seed: int
    seconds: float = 60.0
    faults: tuple[Fault, ...]


FOUND = {
    "nobody could put a board right that reports joints and says that it is not homed": Found(
        seed=10,
        faults=(Fault(kind="brown_out", at=48.361, seconds=9.488, target="mobile_1_board", amount=2.961),),
        file="""
            name: drawn_10
            paths: {9y: [2, 5, 4, 7]}
            stations: {columns_q1_deg: [-10.2], rows_q2_deg: [-8.0], mm: 7.3}
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: joints}
                mobile: {name: mobile_1, link: mqtt, evidence: joints, mqtt: mobile_1_board}
                home: {deg: [-103.9, -110.3], mm: 96.7}
                pickup: {deg: [122.9, 117.3], mm: 37.1}
        """,
    ),
    "a mobile robot that tells only its state was expected to prove where it got to": Found(
        seed=12,
        faults=(Fault(kind="reboot", at=3.233, target="mobile_4", word="no will"),),
        file="""
            name: drawn_12
            paths: {zb: [4, 3, 6, 3]}
            cells:
              cell_4:
                arm: {name: arm_4, model: scara, link: mqtt, evidence: ids}
                mobile: {name: mobile_4, link: mqtt, evidence: state, assume_homed: true}
                home: {deg: [-55.1, -7.3], mm: 61.3}
                pickup: {deg: [91.7, 42.1], mm: 9.8}
                stations: {columns_q1_deg: [-83.1, 112.1], rows_q2_deg: [20.1]}
        """,
    ),
    "an arm that assumes to be homed was believed after a boot, and moved by counters that were wrong": Found(
        seed=45,
        seconds=120.0,
        faults=(Fault(kind="reboot", at=87.865, target="arm_1", word="will"),),
        file="""
            name: drawn_45
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: ids, assume_homed: true}
                mobile: {name: mobile_1, link: mqtt, evidence: ids}
                home: {deg: [36.9, 18.9], mm: 46.1}
                pickup: {deg: [-9.0, 100.9], mm: 89.6}
                paths: {2Z: [2, 1, 2]}
                stations: {columns_q1_deg: [-126.5, 70.2, -45.4], rows_q2_deg: [72.5, 132.9], mm: 92.6}
        """,
    ),
    "an arm that assumes to be homed was not known to have been homed by its routine": Found(
        seed=45,
        faults=(
            Fault(kind="reboot", at=5.0, target="arm_1", word="will"),
            *(Fault(kind="operator_home", at=5.0 + wait, target="arm_1") for wait in range(1, 20)),
        ),
        file="""
            name: homed_by_its_routine
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: ids, assume_homed: true}
                mobile: {name: mobile_1, link: mqtt, evidence: ids}
                home: {deg: [36.9, 18.9], mm: 46.1}
                pickup: {deg: [-9.0, 100.9], mm: 89.6}
                paths: {2Z: [2, 1, 2]}
                stations: {0: {deg: [10, 10], mm: 50}}
        """,
    ),
    "an arm whose poses all look the same was blamed for what late commands made it pick": Found(
        seed=28,
        faults=(
            Fault(kind="delay", at=25.081, seconds=5.332, target="arm_1_board", amount=0.517, word="down"),
            Fault(kind="hop_delay", at=49.866, seconds=1.147, target="plant", amount=2.156, word="to bridge"),
        ),
        file="""
            name: drawn_28
            timing: {effector_settle_s: 0.01}
            cells:
              cell_1:
                arm:
                  name: arm_1
                  model: scara
                  link: none
                  evidence: joints
                  mqtt: arm_1_board
                  tolerance: {deg: [0.103, 22.552], mm: 37.381}
                mobile: {name: mobile_1, link: none, evidence: ids, timeout_s: 0.5, grid: {pitch_mm: 1}}
                home: {deg: [110.0, 90.3], mm: 49.4}
                pickup: {deg: [110.017, 85.685], mm: 33.438, approach_mm: 16.7}
                paths: {b7: [3, 0, 1, 0, 3]}
                stations: {0: {deg: [110.071, 88.231], mm: 17.325}}
                retry: {times: 1, backoff_s: 0.3}
        """,
    ),
}


@pytest.mark.parametrize("found", FOUND.values(), ids=FOUND)
def test_every_invariant_holds(found: Found) -> None:
    plant = loaded(yaml.safe_load(found.file))
    result = Simulation(plant.model, found.seed, explicit(found.faults)).run(seconds=found.seconds)
    assert result.broken is None, str(result.broken)
    assert len(result.faults) == len(found.faults), "each of them happened"
    assert result.outcomes.get("done", 0) > 0
