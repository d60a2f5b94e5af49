"""Robots of a drawn cell of devices: arms and mobile robots, their targets, tools and places."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from arboleda_proofs.simulator.chance import Dice

from .kinds import shipped
from .kinds_text import TURNTABLE
from .layout import Device, Parts, Robot, Section

ROLES = {"arm": ("loader", "picker"), "mobile": ("cart", "agv"), TURNTABLE: ("table", "carousel")}
NODES = (1, 2, 4, 5, 7, 8, 0)
HOME_NODE = 6
PATHS = {"0A": (0, 3, 6), "0B": (0, 3, 4, 7), "1C": (1, 4, 5), "2A": (2, 5, 8, 7, 6)}
APART_DEG = 14.0  # between two targets of an arm


class RobotDrawer:
    """Draws the robots of a cell, and `tools` that they carry; `section` has targets, groups and places."""

    def __init__(self, dice: Dice, devices: Sequence[Device], *, are_written: bool) -> None:
        self._dice = dice
        self._are_written = are_written  # kinds, of robots too, in Python
        self._devices = devices
        self.robots: list[Robot] = []
        self.tools: list[Device] = []
        self.groups: dict[str, tuple[str, ...]] = {}
        self.parts: Parts | None = None
        self.section: Section = {}

    def named(self, role: str) -> Robot:
        return next(each for each in self.robots if each.role == role)

    def replace(self, robot: Robot) -> None:
        self.robots = [robot if each.role == robot.role else each for each in self.robots]

    def draw(self, count: int, *, has_hand: bool) -> None:
        """Draw so many robots; `has_hand`: the first one is an arm whose hand moves parts."""
        for number in range(max(count, has_hand)):
            is_hand = has_hand and not number
            kind = "arm" if is_hand or self._dice.chance(0.7) else "mobile"
            if self._are_written and not is_hand and self._dice.chance(0.4):
                kind = TURNTABLE
            role = ROLES[kind][number]
            tool = self._tool(role, is_arm=kind == "arm")
            self._targets(role, tool, kind, moves_parts=is_hand)

    def _tool(self, role: str, *, is_arm: bool) -> str | None:
        dice = self._dice
        sort = dice.pick(("gripper", "effector", "own" if is_arm else "", "own" if is_arm else ""))
        if sort in ("own", ""):
            return "" if sort else None
        name = f"{role}_tool"
        section: Section = {"kind": sort, "tool_of": role}
        if sort == "gripper" and dice.chance(0.5):
            section["max_force_n"] = 60
        self.tools.append(Device(role=name, kind=shipped(sort), tool_of=role, section=section))
        return name

    def _targets(self, role: str, tool: str | None, kind: str, *, moves_parts: bool) -> None:
        dice, is_arm = self._dice, kind == "arm"
        poses = POSES[kind](dice)
        targets = self.section.setdefault("targets", {})
        targets.setdefault("home", {})[role] = poses.pop(0)
        racks: tuple[str, ...] = ()
        if is_arm and dice.chance(0.3):
            racks = self._array(role)
        names = [f"{role}_{number}" for number in range(1, 1 + dice.pick((1, 2, 3)) + (not racks))]
        for name in names:
            targets[name] = {role: poses.pop(0)}
        if not racks:
            racks = tuple(names[: 1 + dice.below(len(names) - 1)])
            self.section.setdefault("groups", {})[f"{role}_racks"] = list(racks)
        self.groups[f"{role}_racks"] = racks
        rest = [name for name in names if name not in racks]
        if tool is not None and self.parts is None and rest and (moves_parts or dice.chance(0.6)):
            self._places(role, racks, rest)
        section = self._section(role, kind)
        paths = () if kind != "mobile" or section.get("evidence") == "state" else self._paths(role)
        found = Robot(
            role=role, targets=("home", *racks, *rest), doors={}, tool=tool, paths=paths, section=section
        )
        self.robots.append(found)

    def _paths(self, role: str) -> tuple[str, ...]:
        """The codes of the paths over which a mobile robot without parts drives, now and then."""
        if (self.parts is not None and self.parts.robot == role) or not self._dice.chance(0.5):
            return ()
        drawn = [code for code in PATHS if self._dice.chance(0.6)] or ["0A"]
        self.section.setdefault("paths", {})[role] = {code: list(PATHS[code]) for code in drawn}
        return tuple(drawn)

    def _array(self, role: str) -> tuple[str, ...]:
        name, rows, columns = f"{role}_racks", 2, self._dice.pick((2, 3))
        corners = [
            {"deg": [first, second], "mm": 60, "approach_mm": 20}
            for first in (-80, -60)
            for second in (-110, -80)
        ]
        grid = {"grid": [rows, columns], "corners": {role: corners}}
        self.section.setdefault("groups", {})[name] = grid
        return tuple(f"{name}_{number}" for number in range(1, rows * columns + 1))

    def _places(self, role: str, racks: tuple[str, ...], rest: list[str]) -> None:
        dice = self._dice
        goal = rest[0]
        places: dict[str, Any] = {f"{role}_racks": {"supply": True}, goal: {"holds": 20, "output": True}}
        nest = machine = ""
        if len(rest) > 1:
            nest = rest[1]
            machines = [each.role for each in self._devices if not each.kind.is_shipped]
            if machines and dice.chance(0.6):
                machine = dice.pick(machines)
            places[nest] = {"of": machine} if machine else {}
        self.section["places"] = places
        self.parts = Parts(
            robot=role, source=f"{role}_racks", sources=racks, goal=goal, nest=nest, machine=machine
        )

    def _section(self, role: str, kind: str) -> Section:
        dice = self._dice
        number = len(self.robots)
        section: Section = {"kind": kind}
        if kind == TURNTABLE and dice.chance(0.5):
            section["deg_s"] = dice.pick((20, 200))
        elif kind == "arm":
            section |= {"model": "scara", "base": {"origin_m": [2.0 * number, 0]}}
        elif kind == "mobile":
            section["grid"] = {"origin_m": [1.0 + 3 * number, 3]}
        if dice.chance(0.4):
            section["evidence"] = dice.pick(("joints", "state"))
        if dice.chance(0.2):
            section["mqtt"] = f"{role}_board"
        return section


def _arm_poses(dice: Dice) -> list[Section]:
    poses: list[Section] = [{"deg": [0, 0], "mm": 0}]
    for number in range(6):
        pose: Section = {
            "deg": [round(20 + APART_DEG * number + dice.between(0, 4), 2), round(dice.between(-60, 60), 2)],
            "mm": dice.pick((0, 40, 80)),
        }
        if pose["mm"] and dice.chance(0.5):
            pose["approach_mm"] = 30
        poses.append(pose)
    return poses


def _nodes(dice: Dice) -> list[Section]:
    return [{"node": HOME_NODE}, *({"node": node} for node in NODES)]


def _angles(dice: Dice) -> list[Section]:
    """Those of a turntable."""
    return [{"deg": [0]}, *({"deg": [angle]} for angle in (90, -90, 45.5, 170, -20, 120))]


POSES: dict[str, Callable[[Dice], list[Section]]] = {
    "arm": _arm_poses,
    "mobile": _nodes,
    TURNTABLE: _angles,
}
