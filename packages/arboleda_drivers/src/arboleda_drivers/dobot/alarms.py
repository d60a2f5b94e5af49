"""Meanings of the controller alarms that an operator meets most; the maker lists some thousand."""

from __future__ import annotations

from collections.abc import Sequence

ALARMS = {
    16: "near the singularity of the shoulder",
    17: "no joints reach that pose",
    18: "outside of the working space",
    **{48 + joint: f"joint {joint + 1} too fast" for joint in range(6)},
    116: "the stop button at the robot is pressed",
    132: "a stop by software of the robot's own",
    133: "a stop by a safety input",
}


def named(alarms: Sequence[int]) -> str:
    """The alarms by number, with their meanings as far as known here."""
    return ", ".join(
        f"alarm {each}: {ALARMS[each]}" if each in ALARMS else f"alarm {each}" for each in alarms
    )
