"""Arms and mobile robots of a drawn plant file."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from arboleda.kinds.joints import Joint
from arboleda.model.plant_model import Evidence, Link
from arboleda_proofs.simulator.chance import Dice

from .poses import Axis, Section, in_file_mm

LINKS = (*(Link.MQTT.value,) * 3, Link.ROS.value, Link.NONE.value)
LEVELS = tuple(level.value for level in Evidence)
TIMEOUTS_S = (0.5, 2.0, 10.0)
AROUND = 20.0  # deg or mm; limits are not drawn narrower, so that cells can share stations
TOLERANCE_SLACK = 1.001  # above half a motor step and a little, which is the least that a file may say


@dataclass(frozen=True, kw_only=True)
class DrawnArm:
    """The section `arm:`, and the joints that poses are drawn for."""

    model: str
    section: Section
    axes: tuple[Axis, ...]

    def around_zero(self) -> tuple[Axis, ...]:
        """Limits of the joints that every arm of this model can have."""
        least = [max(axis.lower, 0.0 if axis.slides else -AROUND) for axis in self.axes]
        rows = zip(self.axes, least, strict=True)
        return tuple(replace(axis, lower=lower, upper=min(axis.upper, AROUND)) for axis, lower in rows)


def draw_arm(dice: Dice, name: str, models: Mapping[str, Sequence[Joint]]) -> DrawnArm:
    """An arm of one of the models."""
    fewest_joints = min(sorted(models), key=lambda each: len(models[each]))  # it is simulated twice as fast
    model = fewest_joints if dice.chance(0.4) else dice.pick(sorted(models))
    section = {"name": name, "model": model, **_common(dice, name)}
    axes = tuple(_axis(joint) for joint in models[model])
    if dice.chance(0.3):
        section["twin"] = f"twin_of_{name}"
    if dice.chance(0.3):
        section["base"] = {
            "origin_m": [round(dice.between(-3, 3), 2), 0.0],
            "yaw_deg": dice.pick((0, 90, -45)),
        }
    if dice.chance(0.4):
        axes = tuple(_narrower(dice, axis) for axis in axes)
        section["limits"] = {f"{_key(n, axis)}": [axis.lower, axis.upper] for n, axis in enumerate(axes, 1)}
    if dice.chance(0.4):
        section["speeds"] = _speeds(dice, models[model])
    if dice.chance(0.5):
        section["tolerance"], axes = _tolerance(dice, axes)
    if dice.chance(0.3):
        section["piece_on_change"] = dice.chance(0.7)
    if dice.chance(0.3):
        section["trigger_when_busy"] = dice.pick(("queue", "refuse"))
    return DrawnArm(model=model, section=section, axes=axes)


def draw_mobile(dice: Dice, name: str, models: Mapping[str, float]) -> Section:
    """A mobile robot of one of the models."""
    model = dice.pick(sorted(models))
    section = {"name": name, **_common(dice, name)}
    if dice.chance(0.3):
        section["model"] = model
    fastest = models[model] * 1000
    if dice.chance(0.5):
        section["speed_mm_s"] = round(dice.between(0.4, 1.0) * fastest, 1)
    if dice.chance(0.4):
        section["grid"] = {
            "origin_m": [0.5, round(dice.between(-1, 1), 2)],
            "yaw_deg": dice.pick((0, 180, 30.5)),
            "pitch_mm": dice.pick((1, 50, 200, 400)),
        }
    return section


def _common(dice: Dice, name: str) -> Section:
    evidence = dice.pick(LEVELS)
    section: Section = {"link": dice.pick(LINKS), "evidence": evidence}
    if dice.chance(0.4):
        section["mqtt"] = f"{name}_board"
    if dice.chance(0.5):
        section["assume_homed"] = dice.chance(0.7)
    if evidence == Evidence.IDS.value and not section.get("assume_homed") and dice.chance(0.5):
        section["home_at_start"] = dice.chance(0.7)
    if dice.chance(0.3):
        section["stop"] = dice.pick(("none", "supported"))
    if dice.chance(0.4):
        section["timeout_s"] = dice.pick(TIMEOUTS_S)
    return section


def _axis(joint: Joint) -> Axis:
    slides = joint.unit == "m"

    def in_file_units(value: float) -> float:
        return value * 1000 if slides else math.degrees(value)

    return Axis(
        slides=slides,
        lower=math.ceil(in_file_units(joint.lower) * 10) / 10,
        upper=math.floor(in_file_units(joint.upper) * 10) / 10,
        tolerance=in_file_units(joint.step / 2 + 1e-5) * TOLERANCE_SLACK,
        up=joint.up,
    )


def _narrower(dice: Dice, axis: Axis) -> Axis:
    room = 0.0 if axis.slides else AROUND
    lower = axis.lower if dice.chance(0.5) else min(round(axis.lower * dice.random(), 1), -room)
    upper = axis.upper if dice.chance(0.5) else max(round(axis.upper * dice.random(), 1), AROUND)
    return replace(axis, lower=max(lower, axis.lower), upper=min(upper, axis.upper))


def _speeds(dice: Dice, joints: Sequence[Joint]) -> Section:
    speeds: Section = {}
    for number, joint in enumerate(joints, 1):
        if dice.chance(0.6):
            fastest = joint.speed * 1000 if joint.unit == "m" else math.degrees(joint.speed)
            unit = "mm_s" if joint.unit == "m" else "deg_s"
            speeds[f"q{number}_{unit}"] = round(dice.between(0.4, 0.99) * fastest, 1)
    return speeds or _half_speed(joints[0])


def _half_speed(joint: Joint) -> Section:
    if joint.unit == "m":
        return {"q1_mm_s": round(joint.speed * 500, 1)}
    return {"q1_deg_s": round(math.degrees(joint.speed) / 2, 1)}


def _tolerance(dice: Dice, axes: Sequence[Axis]) -> tuple[Section, tuple[Axis, ...]]:
    """Tolerances from just above the default to half of the arm's room, different for each joint."""
    widths = (1.0, 2.0, 10.0) if dice.chance(0.5) else (10.0, 50.0, 200.0)
    wide = tuple(
        replace(axis, tolerance=round(axis.tolerance * dice.pick(widths) + 0.0005, 3)) for axis in axes
    )
    section: Section = {}
    if turning := [axis.tolerance for axis in wide if not axis.slides]:
        section["deg"] = turning
    if sliding := [axis.tolerance for axis in wide if axis.slides]:
        section["mm"] = in_file_mm(sliding)
    return section, wide


def _key(number: int, axis: Axis) -> str:
    return f"q{number}_{'mm' if axis.slides else 'deg'}"
