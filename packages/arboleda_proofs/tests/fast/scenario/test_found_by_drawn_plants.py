"""What plants drawn from a seed have found: each plant, as much of it as was needed, with seed and faults."""

from __future__ import annotations

from dataclasses import dataclass

import pytest
import yaml
from tests.lengths import sample

from arboleda_drawn.plants import loaded
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.run import Simulation
from arboleda_proofs.simulator.shrink import explicit


@dataclass(frozen=True, kw_only=True)
class Found:
    """A breach: the plant file, the seed of the people, and what went wrong."""

    file: str
    seed: int
    seconds: float = 60.0
    faults: tuple[Fault, ...]


ASSUMES_HOMED = """
    name: drawn_45
    cells:
      cell_1:
        arm: {name: arm_1, model: scara, link: mqtt, evidence: ids, assume_homed: true}
        mobile: {name: mobile_1, link: mqtt, evidence: ids}
        home: {deg: [36.9, 18.9], mm: 46.1}
        pickup: {deg: [-9.0, 100.9], mm: 89.6}
        paths: {2Z: [2, 1, 2]}
        stations: {columns_q1_deg: [-126.5, 70.2, -45.4], rows_q2_deg: [72.5, 132.9], mm: 92.6}
"""

FOUND = {
    "an arm at rest where it picks up rose as if work had failed there": Found(
        seed=1,
        seconds=20.0,
        faults=(),
        file="""
            name: drawn_910020
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: ids}
                mobile: {name: mobile_1, link: mqtt, evidence: ids}
                home: {deg: [-21.4, 128.1], mm: 62.5}
                pickup: {deg: [-21.4, 128.1], mm: 62.5, approach_mm: 6.2}
                paths: {za: [5, 4]}
                stations: {"0": {deg: [10, 100], mm: 62.32}}
                palletizing: {pick: station 0, place: pickup}
        """,
    ),
    "an arm whose place is told late rose at rest, where it picks up, as if work had failed there": Found(
        seed=930005,
        seconds=44.0,
        faults=(),
        file="""
            name: drawn_930005
            timing: {dwell_s: 0.01}
            stations: {columns_q1_deg: [5.8, 10.3, -17.7], rows_q2_deg: [18.6, 14.9], mm: 5.7}
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: ros, evidence: state}
                mobile: {name: mobile_1, link: mqtt, evidence: ids}
                home: {deg: [-26.0, 63.0], mm: 11.9}
                pickup: {deg: [-26.0, 63.0], mm: 11.9, approach_mm: 11.8}
                paths: {yc: [4, 1, 0, 1, 2, 1]}
                drive_to_start: false
        """,
    ),
    "the first step, tried again, was taken for the second where a cell rests at its pick-up": Found(
        seed=78,
        faults=(Fault(kind="stuck_bit", at=12.5, seconds=4.0, target="arm_1", word="q2_mov"),),
        file="""
            name: drawn_78
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: joints}
                mobile: {name: mobile_1, link: mqtt, evidence: joints}
                home: {deg: [-107.7, 5.6], mm: 0.3}
                pickup: {deg: [-107.7, 5.6], mm: 0.3}
                paths: {C4: [1, 4, 7, 8, 7, 8], "01": [2, 5, 8, 7, 8, 5]}
                stations: {columns_q1_deg: [-17.1], rows_q2_deg: [-14.5, -7.4, -2.2], mm: 7.3}
                retry: {times: 1}
        """,
    ),
    "after a restart a path that ends where it begins was taken for the way to its start": Found(
        seed=1015,
        seconds=85.0,
        faults=(Fault(kind="full_disk", at=64.95, seconds=11.083, target="plant"),),
        file="""
            name: drawn_1015
            paths: {zx: [2, 5, 2], AZ: [8]}
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: ids}
                mobile: {name: mobile_1, link: ros, evidence: ids, speed_mm_s: 100.9}
                home: {deg: [15.2, -99.0], mm: 7.3}
                pickup: {deg: [0.0, 0.0], mm: 0.0}
                stations: {0: {deg: [-49.9, 23.1], mm: 59.2}}
        """,
    ),
    "an arm that lifts nothing at all, as its part belongs where it lies, had been said to hold none": Found(
        seed=1,
        faults=(Fault(kind="no_grip", at=0.0, seconds=60.0, target="arm_1"),),
        file="""
            name: drawn_1015
            timing: {dwell_s: 0.2, piece_debounce_s: 0.05}
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: ids, speeds: {q3_mm_s: 54.8}}
                mobile: {name: mobile_1, link: mqtt, evidence: ids, assume_homed: true}
                home: {deg: [15.2, -99.0], mm: 7.3}
                pickup: {deg: [0.0, 0.0], mm: 0.0}
                paths: {56: [1]}
                stations: {0: {deg: [0.0, 0.0], mm: 0.0}}
        """,
    ),
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
        file=ASSUMES_HOMED,
    ),
    "an arm that assumes to be homed was not known to have been homed by its routine": Found(
        seed=45,
        faults=(
            Fault(kind="reboot", at=5.0, target="arm_1", word="will"),
            *(Fault(kind="operator_home", at=5.0 + wait, target="arm_1") for wait in range(1, 20)),
        ),
        file=ASSUMES_HOMED,
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
    "a mobile robot that stopped on its last node, too early on its round trip, was taken for done": Found(
        seed=1,
        seconds=40.0,
        faults=(Fault(kind="hop_partition", at=5.1, seconds=2.3, target="plant", word="to bridge, lost"),),
        file="""
            name: drawn_61
            paths: {rt: [8, 7, 4, 7, 4, 7]}
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: ids}
                mobile: {name: mobile_1, link: mqtt, evidence: joints, speed_mm_s: 84.3}
                home: {deg: [-55.1, -7.3], mm: 61.3}
                pickup: {deg: [91.7, 42.1], mm: 9.8}
                stations: {columns_q1_deg: [-83.1, 112.1], rows_q2_deg: [20.1]}
        """,
    ),
    "an arm that says it stands where it cannot was given more time than its longest way takes": Found(
        seed=411,
        faults=(
            Fault(
                kind="lying_telemetry", at=7.605, seconds=4.477, target="arm_2", amount=27.542, word="q2_mov"
            ),
        ),
        file="""
            name: drawn_411
            cells:
              cell_2:
                arm:
                  name: arm_2
                  model: scara
                  link: mqtt
                  evidence: state
                  tolerance: {deg: [0.512, 22.552], mm: 1.87}
                mobile: {name: mobile_2, link: mqtt, evidence: joints}
                home: {deg: [95.0, 78.0], mm: 33.9}
                pickup: {deg: [132.9, 41.7], mm: 20.3}
                paths: {5X: [5]}
                stations: {0: {deg: [0, 0], mm: 0}}
        """,
    ),
    "an arm that tells no position was put at its reference, and the plant did not take note": Found(
        seed=237,
        faults=(
            Fault(kind="plant_freeze", at=32.4, seconds=1.682, target="plant", amount=0.06, word="plant"),
        ),
        file="""
            name: drawn_237
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: none, evidence: state}
                mobile: {name: mobile_1, link: ros, evidence: joints}
                home: {deg: [4.0, 84.5], mm: 39.8}
                pickup: {deg: [29.3, -60.0], mm: 63.3}
                paths: {C5: [0, 1]}
                stations: {0: {deg: [-97.1, -87.4], mm: 10.2}}
            zones:
              zone_1: {poses: [cell_1 pickup]}
        """,
    ),
    "a task was expected to wait for a zone longer than its plant file lets it": Found(
        seed=207,
        faults=(),
        file="""
            name: drawn_207
            stations: {columns_q1_deg: [-17.7, -5.6], rows_q2_deg: [14.1]}
            cells:
              cell_2:
                arm: {name: arm_2, model: cr10a, link: mqtt, evidence: ids}
                mobile: {name: mobile_2, link: mqtt, evidence: ids}
                home: {deg: [-92.8, -5.2, 123.8, -50.1, 164.0, -73.1]}
                pickup: {deg: [-28.6, 44.3, 114.9, -73.6, 3.9, -2.2]}
                paths: {x7: [4]}
              cell_3:
                arm: {name: arm_3, model: scara, link: mqtt, evidence: state}
                mobile: {name: mobile_3, link: mqtt, evidence: joints}
                home: {deg: [-109.9, 117.2], mm: 39.9}
                pickup: {deg: [76.2, 60.8], mm: 90.0}
                paths: {4c: [5, 2, 5]}
                zone_wait_s: 0.5
            zones:
              zone_1:
                poses: [cell_3 pickup]
                moves: [[cell_2 station 1, cell_2 home]]
        """,
    ),
    "a drive to the start of a path of one node was taken for that path": Found(
        seed=208,
        faults=(
            Fault(kind="operator_hold", at=2.137, target="arm_1"),
            Fault(kind="hop_delay", at=8.51, seconds=10.995, target="plant", amount=4.201, word="to plant"),
            Fault(kind="plant_freeze", at=53.87, seconds=3.491, target="plant", amount=6.608, word="machine"),
        ),
        file="""
            name: drawn_208
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: joints}
                mobile: {name: mobile_1, link: ros, evidence: state}
                home: {deg: [-27.0, -39.3], mm: 79.2}
                pickup: {deg: [2.5, -68.4], mm: 46.9, approach_mm: 46.9}
                paths: {81: [2]}
                stations:
                  0: {deg: [-98.1, 79.2], mm: 87.6}
                  1: {deg: [81.7, -123.6], mm: 9.6, approach_mm: 9.5}
              cell_2:
                arm: {name: arm_2, model: scara, link: none, evidence: joints}
                mobile: {name: mobile_2, link: mqtt, evidence: joints}
                home: {deg: [-97.9, 8.6], mm: 44.0}
                pickup: {deg: [-99.5, 19.3], mm: 21.5, approach_mm: 21.4}
                paths: {c5: [5], b7: [6], 4z: [5, 4]}
                stations:
                  0: {deg: [-6.6, 5.7], mm: 34.0, approach_mm: 34.0}
                  1: {deg: [-131.7, 25.0], mm: 17.4, approach_mm: 1.7}
                  2: {deg: [-12.5, 11.4], mm: 14.9}
                  3: {deg: [-35.6, 3.7], mm: 15.0}
                  4: {deg: [-16.0, 21.1], mm: 59.3, approach_mm: 29.6}
        """,
    ),
    "a step sent as an operator declared a robot homed was taken for the operator's": Found(
        seed=211,
        faults=(Fault(kind="brown_out", at=20.853, seconds=10.534, target="mobile_1_board", amount=8.921),),
        file="""
            name: drawn_211
            timing: {dwell_s: 0}
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: none, evidence: state}
                mobile: {name: mobile_1, link: mqtt, evidence: joints, mqtt: mobile_1_board}
                home: {deg: [-4.3, -93.7], mm: 78.1}
                pickup: {deg: [-4.3, -93.7], mm: 78.1}
                paths: {ay: [0]}
                stations: {0: {deg: [-145.0, -10.1], mm: 60.7}}
        """,
    ),
    "a grip that was tried again, where the place looks like the pick-up, was taken for putting down": Found(
        seed=358,
        faults=(
            Fault(kind="no_part", at=21.335, seconds=27.832, target="arm_3"),
            Fault(kind="piece_false", at=21.341, seconds=11.786, target="arm_3", word="a piece"),
            Fault(
                kind="piece_flicker", at=35.696, seconds=0.62, target="arm_3", amount=0.497, seed=3712501228
            ),
        ),
        file="""
            name: drawn_358
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: state}
                mobile: {name: mobile_1, link: none, evidence: joints}
                home: {deg: [-95.8, 5.1], mm: 83.3}
                pickup: {deg: [-95.801, 5.235], mm: 83.323}
                paths: {Z2: [6]}
                stations: {columns_q1_deg: [-0.3], rows_q2_deg: [-93.4]}
                piece_check: true
              cell_3:
                arm: {name: arm_3, model: scara, link: mqtt, evidence: ids}
                mobile: {name: mobile_3, link: mqtt, evidence: ids}
                home: {deg: [-110.7, -86.6], mm: 1.9}
                pickup: {deg: [-110.707, -86.873], mm: 2.176}
                paths: {2Z: [3]}
                stations:
                  0: {deg: [-74.3, -116.0], mm: 10.2}
                  1: {deg: [-74.296, -115.928], mm: 10.159}
                palletizing: {pick: station 0, place: station 1}
                retry: {times: 3}
                piece_check: true
              cell_4:
                arm: {name: arm_4, model: scara, link: none, evidence: joints}
                mobile: {name: mobile_4, link: none, evidence: joints}
                home: {deg: [73.2, 37.1], mm: 50.6}
                pickup: {deg: [-5.3, 30.1], mm: 86.7}
                paths: {y2: [0]}
                stations: {0: {deg: [73.206, 36.78], mm: 50.72}}
        """,
    ),
    "a cancel that came when the plant had just held its cells was expected to find them at work": Found(
        seed=1,
        faults=(
            Fault(kind="hop_partition", at=19.7, seconds=6.0, target="plant", word="to plant, lost"),
            Fault(kind="plant_freeze", at=20.0, seconds=2.9, target="plant", amount=0.001, word="plant"),
            Fault(kind="operator_cancel", at=22.5, target="cell_1"),
        ),
        file="""
            name: cancelled_after_an_absence
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: ids}
                mobile: {name: mobile_1, link: mqtt, evidence: ids}
                home: {deg: [0, 0], mm: 0}
                pickup: {deg: [5, 5], mm: 10}
                paths: {c5: [5], 4z: [5, 4]}
                stations: {0: {deg: [10, 10], mm: 20}}
        """,
    ),
    "a round trip was cut short by a node that was older than the end of the drive before it": Found(
        seed=620,
        seconds=40.0,
        faults=(),
        file="""
            name: drawn_620
            paths: {XZ: [5, 2, 1, 2, 5], ZX: [2, 1, 4, 1]}
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: ros, evidence: state}
                mobile: {name: mobile_1, link: none, evidence: state, grid: {pitch_mm: 1}}
                home: {deg: [40.7, 23.6], mm: 69.3}
                pickup: {deg: [-31.6, -23.3], mm: 65.2}
                stations:
                  columns_q1_deg: [-49.1, 141.7, 145.7]
                  rows_q2_deg: [-100.2, -66.9, 35.7]
                  mm: 50.0
        """,
    ),
    "a robot without a stop was tried again and again though its bridge kept it stopped": Found(
        seed=63,
        seconds=90.0,
        faults=(
            Fault(kind="foreign_command", at=47.38, target="arm_1", word="stop"),
            Fault(kind="reorder", at=59.384, seconds=2.104, target="arm_1_board", amount=0.132, word="up"),
        ),
        file="""
            name: drawn_63
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: state, mqtt: arm_1_board, stop: none}
                mobile: {name: mobile_1, link: mqtt, evidence: ids}
                home: {deg: [50.1, 31.5], mm: 74.8}
                pickup: {deg: [-101.9, 34.0], mm: 25.6}
                paths: {'44': [5, 8, 7, 4, 7, 6]}
                stations:
                  columns_q1_deg: [29.5, 72.3, 96.6]
                  rows_q2_deg: [-2.7, -14.1, -29.1]
                  mm: 32.4
        """,
    ),
    "a mobile robot that came home while its board did nothing was blamed for moving unhomed": Found(
        seed=482,
        faults=(
            Fault(kind="reboot", at=32.693, target="mobile_2_board", word="will"),
            Fault(kind="bridge_stall", at=41.104, seconds=0.604, target="bridge"),
            Fault(kind="board_stall", at=41.163, seconds=7.025, target="mobile_2_board"),
        ),
        file="""
            name: drawn_482
            timing: {stale_after_s: 0.5}
            stations: {columns_q1_deg: [-2.1, 6.9], rows_q2_deg: [3.0, 3.3]}
            cells:
              cell_2:
                arm: {name: arm_2, model: scara, link: none, evidence: ids}
                mobile: {name: mobile_2, link: none, evidence: ids, mqtt: mobile_2_board, speed_mm_s: 156.4}
                home: {deg: [-141.7, -11.5], mm: 21.6}
                pickup: {deg: [63.9, 54.7], mm: 38.4}
                paths: {ab: [6, 3, 4]}
                drive_to_start: false
        """,
    ),
    "an arm that gripped and went one motor step in one instant seemed to grip where it went": Found(
        seed=1087,
        seconds=9.0,
        faults=(
            Fault(kind="hop_delay", at=2.968, seconds=8.115, target="plant", amount=0.736, word="to plant"),
            Fault(kind="hop_partition", at=4.728, seconds=3.293, target="plant", word="to bridge, held"),
        ),
        file="""
            name: drawn_1087
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: joints}
                mobile: {name: mobile_1, link: ros, evidence: ids}
                home: {deg: [81.7, 3.0], mm: 66.7}
                pickup: {deg: [81.706, 3.435], mm: 66.807}
                paths: {4x: [3, 6, 3]}
                stations:
                  0: {deg: [-40.1, 89.8], mm: 77.0}
                  1: {deg: [-84.6, 84.9], mm: 34.8}
                  2: {deg: [81.701, 3.624], mm: 67.127}
              cell_2:
                arm: {name: arm_2, model: scara, link: none, evidence: state}
                mobile: {name: mobile_2, link: none, evidence: state}
                home: {deg: [-12.3, -127.4], mm: 38.6}
                pickup: {deg: [0.5, -96.1], mm: 28.0}
                paths: {'98': [6, 7, 4, 3, 0, 1]}
                stations: {0: {deg: [-31.7, -74.0], mm: 83.8}}
        """,
    ),
    "an arm that somebody put at its reference, before a frozen plant heard of its end, had not moved": Found(
        seed=45,
        faults=(
            Fault(kind="plant_freeze", at=5.6, seconds=3.6, target="plant", amount=0.001, word="plant"),
            Fault(kind="operator_home", at=8.6, target="arm_1", word="by hand"),
        ),
        file=ASSUMES_HOMED,
    ),
    "an arm that stood a motor step beyond its limit was told to rise there, which its board refuses": Found(
        seed=3658,
        faults=tuple(
            Fault(kind="operator_cancel", at=8.0 + 5.3 * number, target="cell_1") for number in range(10)
        ),
        file="""
            name: drawn_3658
            cells:
              cell_1:
                arm:
                  name: arm_1
                  model: scara
                  link: mqtt
                  evidence: ids
                  limits: {q1_deg: [-150.0, 150.0], q2_deg: [-119.6, 135.0], q3_mm: [0.0, 100.0]}
                mobile: {name: mobile_1, link: mqtt, evidence: ids}
                home: {deg: [-135.4, -39.1], mm: 96.9}
                pickup: {deg: [-77.2, -119.6], mm: 71.4, approach_mm: 7.1}
                paths: {0Y: [2]}
                stations: {0: {deg: [-20.0, -119.6], mm: 50.0, approach_mm: 10.0}}
        """,
    ),
    "a number that a board told before the bridge gave it had to name the command that got it": Found(
        seed=2,
        faults=(
            Fault(kind="bridge_stall", at=8.0, seconds=3.7, target="bridge"),
            Fault(kind="lying_telemetry", at=8.4, seconds=6.0, target="arm_1", word="ack", seed=2),
        ),
        file="""
            name: drawn_5109
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: ids}
                mobile: {name: mobile_1, link: mqtt, evidence: ids}
                home: {deg: [-135.4, -39.1], mm: 96.9}
                pickup: {deg: [-77.2, -119.6], mm: 71.4}
                paths: {0Y: [2]}
                stations: {0: {deg: [-20.0, -119.6], mm: 50.0}}
        """,
    ),
    "a move that a bridge sent after a stall in which its broker went away seemed open ever after": Found(
        seed=2,
        faults=(
            Fault(kind="bridge_stall", at=18.3, seconds=2.2, target="bridge"),
            Fault(kind="broker_restart", at=19.9, seconds=3.8, target="broker"),
        ),
        file="""
            name: drawn_4609
            timing: {stale_after_s: 3}
            cells:
              cell_1:
                arm: {name: arm_1, model: scara, link: mqtt, evidence: ids}
                mobile: {name: mobile_1, link: mqtt, evidence: ids}
                home: {deg: [-1.3, -17.8], mm: 5.8}
                pickup: {deg: [122.8, 14.8], mm: 68.2}
                paths: {ab: [6, 3, 0, 1]}
                stations: {0: {deg: [148.8, -127.2], mm: 68.4}}
        """,
    ),
    "a zone was freed of an arm that said that it stood still, and was on its way back into it": Found(
        seed=3534,
        faults=(
            Fault(
                kind="lying_telemetry",
                at=14.104,
                seconds=6.712,
                target="arm_1",
                word="estado",
                seed=2961435331,
            ),
        ),
        file="""
            name: drawn_3534
            stations: {columns_q1_deg: [-11.8], rows_q2_deg: [-17.3]}
            cells:
              cell_1:
                arm:
                  name: arm_1
                  model: scara
                  link: mqtt
                  evidence: ids
                  tolerance: {deg: [0.512, 90.205], mm: 37.381}
                mobile: {name: mobile_1, link: mqtt, evidence: joints, grid: {pitch_mm: 50}}
                home: {deg: [139.1, -55.6], mm: 14.8}
                pickup: {deg: [-86.3, -64.7], mm: 57.6}
                paths: {cc: [6, 3, 4, 7]}
              cell_2:
                arm: {name: arm_2, model: cr10a, link: mqtt, evidence: joints}
                mobile: {name: mobile_2, link: mqtt, evidence: joints}
                home: {deg: [88.6, -165.8, -89.9, 190.5, 86.2, -59.3]}
                pickup: {deg: [260.2, 37.5, -53.3, 240.0, 14.9, -228.0]}
                paths: {yc: [1, 4, 5, 2]}
            zones: {zone_1: {poses: [cell_1 pickup]}}
        """,
    ),
    "an effector was opened at no pose, as somebody had just put its arm at its reference": Found(
        seed=3007,
        seconds=90.0,
        faults=(Fault(kind="operator_home", at=4.96, target="arm_1", word="by hand"),),
        file="""
            name: drawn_3007
            foreign_commands: refuse
            timing: {effector_timeout_s: 1, stale_after_s: 1, stop_timeout_s: 5, deadline_factor: 3}
            cells:
              cell_1:
                arm:
                  name: arm_1
                  model: scara
                  link: ros
                  evidence: joints
                  mqtt: arm_1_board
                  timeout_s: 2.0
                  twin: twin_of_arm_1
                  limits: {q1_deg: [-150.0, 150.0], q2_deg: [-135.0, 134.4], q3_mm: [0.0, 78.9]}
                  tolerance: {deg: [0.011, 4.511], mm: 0.374}
                mobile:
                  name: mobile_1
                  link: mqtt
                  evidence: state
                  mqtt: mobile_1_board
                  timeout_s: 0.5
                  speed_mm_s: 80.4
                home: {deg: [-2.5, -50.5], mm: 75.9}
                pickup: {deg: [107.1, -63.4], mm: 49.9}
                paths: {AZ: [0]}
                stations: {'0': {deg: [-56.6, 10.9], mm: 4.8}}
                drive_to_start: true
            zones:
              zone_1: {poses: [cell_1 pickup]}
        """,
    ),
    "a stop that is said again to a board whose low numbers count in hindsight was not expected": Found(
        seed=5634,
        faults=(
            Fault(kind="stuck_bit", at=5.8, seconds=13.248, target="mobile_1", word="seq"),
            Fault(kind="operator_stop", at=12.148, target="mobile_1"),
        ),
        file="""
            name: drawn_5634
            cells:
              cell_1:
                arm: {name: arm_1, model: cr10a, link: mqtt, evidence: joints}
                mobile: {name: mobile_1, link: mqtt, evidence: ids}
                home: {deg: [-172.3, -229.9, 55.5, -65.1, 325.7, -296.0]}
                pickup: {deg: [254.7, 311.6, 96.9, 286.9, 3.4, -99.8]}
                paths: {6a: [0, 1, 4, 1, 0]}
                stations: {columns_q1_deg: [146.8, 45.8, -194.7], rows_q2_deg: [316.2, 94.1]}
        """,
    ),
}


@pytest.mark.sampled(36)
@pytest.mark.parametrize("found", FOUND.values(), ids=FOUND)
def test_every_invariant_holds(found: Found) -> None:
    plant = loaded(yaml.safe_load(found.file))
    result = Simulation(plant.model, found.seed, explicit(found.faults)).run(seconds=found.seconds)
    assert result.broken is None, str(result.broken)
    assert len(result.faults) == len(found.faults), "each of them happened"
    assert result.outcomes.get("done", 0) > 0


@pytest.mark.sampled(4)
@pytest.mark.parametrize(
    ("evidence", "least_s", "patience_s", "drives_s"),
    [
        ("ids", 0.1, 0.05, 0.05),
        ("state", 0.3, 0.3, 0.05),
        ("joints", 0.5, 0.05, 10),
        ("joints", 0.8, 0.05, 0.05),
    ],
)
def test_the_least_times_that_check_takes_are_enough_where_nothing_goes_wrong(
    evidence: str, least_s: float, patience_s: float, drives_s: float
) -> None:
    file = f"""
        name: hasty
        timing: {{deadline_factor: 1, deadline_floor_s: {least_s}, stop_timeout_s: {patience_s}}}
        cells:
          cell_1:
            arm: {{name: arm_1, model: scara, link: mqtt, evidence: {evidence}, timeout_s: 0.05}}
            mobile: {{name: mobile_1, link: mqtt, evidence: {evidence}, timeout_s: {drives_s}}}
            home: {{deg: [0, 0], mm: 0}}
            pickup: {{deg: [0, 0.3], mm: 0}}
            paths: {{c5: [5], 4z: [5, 4]}}
            stations: {{0: {{deg: [0, 0.3], mm: 0}}, 1: {{deg: [50, 10], mm: 20}}}}
    """
    for seed in sample(range(1, 5), every=4):
        result = Simulation(loaded(yaml.safe_load(file)).model, seed, explicit(())).run(seconds=30.0)
        assert result.broken is None, str(result.broken)
        assert result.outcomes.keys() == {"done"}
