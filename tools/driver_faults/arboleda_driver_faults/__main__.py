"""One driver, seed by seed, under the faults of its virtual controller.

Usage: tools/driver-faults DRIVER [SEEDS] [FIRST]

The plant's core, the supervisor of drivers and the driver are the shipped ones; device and time are
virtual. A breach is printed with its seed, and the status is 1.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path

from arboleda.plant_file.loader import load
from frame.telling import counts
from frame.words import words

from .dobot import DobotRig
from .gcode import GantryRig, LimpRig, MarlinRig, MoonrakerRig
from .gripper import CarryRig
from .modbus import ModbusRig
from .nav2 import RoundRig, WaypointsRig
from .opcua import OpcUaRig
from .pylabrobot import SIDE_BY_SIDE, ShakerRig
from .rig import Rig, run
from .s7 import S7Rig
from .serial_arm import ServoRig
from .ur import UrRig
from .vda5050 import AgvRig

EXAMPLES = Path(__file__).parents[3] / "examples"
RIGS: dict[str, tuple[Path | None, Callable[..., Rig]]] = {
    "dobot": (None, DobotRig),
    "modbus": (EXAMPLES / "plc_conveyor/plant.yaml", ModbusRig),
    "ur": (None, UrRig),
    "opcua": (EXAMPLES / "plc_conveyor/opcua.yaml", OpcUaRig),
    "s7": (EXAMPLES / "plc_conveyor/s7.yaml", S7Rig),
    "ros2_control": (EXAMPLES / "ros2_control/plant.yaml", CarryRig),
    "navigate_to_pose": (EXAMPLES / "nav2/plant.yaml", RoundRig),
    "follow_waypoints": (EXAMPLES / "nav2/plant.yaml", WaypointsRig),
    "gcode-grbl": (EXAMPLES / "gantry/bench.yaml", GantryRig),
    "gcode-limp": (EXAMPLES / "gantry/bench.yaml", LimpRig),
    "gcode-marlin": (EXAMPLES / "gantry/marlin.yaml", MarlinRig),
    "gcode-moonraker": (EXAMPLES / "gantry/moonraker.yaml", MoonrakerRig),
    "pylabrobot": (EXAMPLES / "plate_bench/bench.yaml", ShakerRig),
    "pylabrobot-side_by_side": (EXAMPLES / "plate_bench/bench.yaml", SIDE_BY_SIDE),
    "serial_arm-dynamixel": (EXAMPLES / "serial_arm/desk.yaml", partial(ServoRig, maker="dynamixel")),
    "serial_arm-feetech": (EXAMPLES / "serial_arm/desk.yaml", ServoRig),
    **{
        f"vda5050-{version}": (EXAMPLES / "agv/plant.yaml", partial(AgvRig, version=version))
        for version in ("2.0", "2.1", "3.0")
    },
}


def main() -> int:
    usage = f"usage: tools/driver-faults {' | '.join(RIGS)} [SEEDS] [FIRST]"
    (plant, rig), seeds, first = words(usage, RIGS.__getitem__, 200, 0)
    model, began = load(plant), time.perf_counter()
    ends, faults, wrong = Counter[str](), Counter[str](), 0
    for seed in range(first, first + seeds):
        result = run(rig(model), seed)
        faults.update(each.name for each in result.faults)
        ends.update(each.reason.value if each.reason else each.state.value for each in result.ended)
        for breach in result.breaches:
            wrong += 1
            print(f"seed {seed} ({', '.join(each.name for each in result.faults)}): {breach}")
    print(f"faults: {counts(dict(sorted(faults.items())))}")
    print(f"tasks: {counts(dict(ends.most_common()))}")
    print(f"{seeds} seeds in {time.perf_counter() - began:.0f} s: {wrong} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
