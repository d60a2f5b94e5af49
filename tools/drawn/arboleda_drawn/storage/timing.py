"""The waiting times of a drawn plant: usual, none at all, short, and shorter than robots can be."""

from __future__ import annotations

from arboleda_proofs.simulator.chance import Dice

from .poses import Section

TIMES: dict[str, tuple[float, ...]] = {
    "dwell_s": (0, 0.01, 0.2, 0.4),
    "effector_settle_s": (0, 0.01, 0.2, 0.4),
    "effector_timeout_s": (0.3, 1, 5),
    "stale_after_s": (0.3, 0.5, 1, 3),
    "stop_timeout_s": (0.3, 1, 5),
    "deadline_factor": (1, 1.5, 3),
    "deadline_floor_s": (0.5, 0.8, 1, 2),
    "piece_wait_s": (0.5, 1, 2),
    "piece_debounce_s": (0, 0.05, 0.1, 0.3),
}
HASTE = 0.3  # how often a file waits for hardly anything
HASTE_S = (0.05, 0.1, 0.2, 0.4)


def draw_timing(dice: Dice) -> Section:
    """Some of the times, at least one."""
    drawn: Section = {key: dice.pick(values) for key, values in TIMES.items() if dice.chance(0.5)}
    return drawn or {"dwell_s": 0}


def hasten(dice: Dice, file: Section) -> None:
    """Now and then, give robots, and arms that wait for zones, next to no time in this file."""
    if not dice.chance(HASTE):
        return
    hasty: Section = {
        key: dice.pick(HASTE_S) for key in ("stop_timeout_s", "deadline_floor_s") if dice.chance(0.5)
    }
    if hasty:
        file["timing"] = file.get("timing", {}) | hasty
    for cell in file["cells"].values():
        if dice.chance(0.3):
            cell["zone_wait_s"] = dice.pick(HASTE_S)
        for robot in (cell["arm"], cell["mobile"]):
            if dice.chance(0.4):
                robot["timeout_s"] = dice.pick(HASTE_S)
