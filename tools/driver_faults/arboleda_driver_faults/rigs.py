"""All drivers that are tried under faults, by name: the plant of each, and its rig."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

from arboleda.model.plant_model import PlantModel
from arboleda.plant_file.loader import load

from .dobot import DobotRig
from .gcode import GantryRig, LimpMarlinRig, LimpRig, MarlinRig, MoonrakerRig
from .gripper import CarryRig
from .modbus import ModbusRig
from .nav2 import RoundRig, WaypointsRig
from .opcua import OpcUaRig
from .own_topics import TopicsRig
from .rig import Rig
from .s7 import S7Rig
from .serial_arm import ServoRig
from .ur import UrRig
from .vda5050 import AgvRig

EXAMPLES = Path(__file__).parents[3] / "examples"
PLANTS = Path(__file__).parents[1] / "plants"


def _shaker(example: PlantModel, *, side_by_side: bool = False) -> Rig:
    from .pylabrobot import ShakerRig  # PyLabRobot is not everywhere

    return ShakerRig(example, side_by_side=side_by_side)


RIGS: dict[str, tuple[Path | None, Callable[..., Rig]]] = {
    "dobot": (None, DobotRig),
    "modbus": (EXAMPLES / "plc_conveyor/plant.yaml", ModbusRig),
    "ur": (None, UrRig),
    "opcua": (EXAMPLES / "plc_conveyor/opcua.yaml", OpcUaRig),
    "s7": (EXAMPLES / "plc_conveyor/s7.yaml", S7Rig),
    "ros2_control": (EXAMPLES / "ros2_control/plant.yaml", CarryRig),
    "mqtt-ids": (PLANTS / "own_topics/ids.yaml", TopicsRig),
    "mqtt-facts": (PLANTS / "own_topics/facts.yaml", TopicsRig),
    "navigate_to_pose": (EXAMPLES / "nav2/plant.yaml", RoundRig),
    "follow_waypoints": (EXAMPLES / "nav2/plant.yaml", WaypointsRig),
    "gcode-grbl": (EXAMPLES / "gantry/bench.yaml", GantryRig),
    "gcode-limp": (EXAMPLES / "gantry/bench.yaml", LimpRig),
    "gcode-marlin": (EXAMPLES / "gantry/marlin.yaml", MarlinRig),
    "gcode-marlin-limp": (EXAMPLES / "gantry/marlin.yaml", LimpMarlinRig),
    "gcode-moonraker": (EXAMPLES / "gantry/moonraker.yaml", MoonrakerRig),
    "pylabrobot": (EXAMPLES / "plate_bench/bench.yaml", _shaker),
    "pylabrobot-side_by_side": (EXAMPLES / "plate_bench/bench.yaml", partial(_shaker, side_by_side=True)),
    "serial_arm-dynamixel": (EXAMPLES / "serial_arm/desk.yaml", partial(ServoRig, maker="dynamixel")),
    "serial_arm-feetech": (EXAMPLES / "serial_arm/desk.yaml", ServoRig),
    **{
        f"vda5050-{version}": (EXAMPLES / "agv/plant.yaml", partial(AgvRig, version=version))
        for version in ("2.0", "2.1", "3.0")
    },
}


def maker_of(driver: str) -> Callable[[], Rig]:
    """The maker of rigs of this driver; raises KeyError for no such name."""
    plant, rig = RIGS[driver]
    return partial(rig, _model(plant))


def rig_of(driver: str) -> Rig:
    """A new rig of this driver."""
    return maker_of(driver)()


@cache
def _model(plant: Path | None) -> PlantModel:
    return load(plant)
