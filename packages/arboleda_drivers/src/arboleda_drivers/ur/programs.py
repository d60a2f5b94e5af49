"""Programs in URScript, and their port; each names itself by a number as it begins and as it ends."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from arboleda.drivers import Joint

from .port_data import PRIMARY, Send
from .rtde import Frame, beat_name

LAST_NUMBER = 2**31 - 2  # of a register of 32 bits
WATCH_HZ = 1  # the controller ends our program without a heartbeat in that time
OUTPUTS = (("standard", 8), ("configurable", 8), ("tool", 2))  # by the bits of actual_digital_output_bits
OUTPUT_COUNT = sum(count for _, count in OUTPUTS)


class ProgramPort:
    """Port to which programs are sent, whatever connection there is."""

    def __init__(self, out: list[Any]) -> None:
        self._out = out
        self._number = 0  # of the last program

    def run(self, program: str) -> None:
        self._out.append(Send(port=PRIMARY, data=program.encode()))

    def next_number(self, frame: Frame | None) -> int:
        """A number that no driver has given since the controller was switched on; `frame` is its last one."""
        if frame is None:
            self._number += 1
        else:
            self._number = max(self._number, frame.begun, frame.done, 0) % LAST_NUMBER + 1
        return self._number


def move(number: int, q: Sequence[float], *, speed: float, acceleration: float, register: int) -> str:
    """The program of a joint move to `q`, rad; `speed` and `acceleration` are of its leading joint."""
    joints = ",".join(f"{each:.6f}" for each in q)
    watch = f'rtde_set_watchdog("{beat_name(register)}", {WATCH_HZ}, "stop")'
    line = f"movej([{joints}], a={acceleration:.4f}, v={speed:.4f})"
    return _numbered("move", number, [watch], [line], register)


def stop(number: int, *, acceleration: float, register: int) -> str:
    """The program that brakes all joints; it takes the place of whatever program runs."""
    return _numbered("stop", number, [], [f"stopj({acceleration:.4f})"], register)


def switch(output: int, *, on: bool) -> str:
    """The program that switches an output beside the one that runs, if any does."""
    for name, count in OUTPUTS:
        if output < count:
            return f"sec arboleda_switch():\n  set_{name}_digital_out({output}, {on})\nend\n"
        output -= count
    raise ValueError(f"there are {OUTPUT_COUNT} outputs")


def leading(joints: Sequence[Joint], here: Sequence[float], there: Sequence[float]) -> tuple[float, float]:
    """Highest speed and acceleration of the joint with the longest way at which no joint exceeds its own."""
    ways = [(joint, abs(b - a)) for joint, a, b in zip(joints, here, there, strict=True)]
    longest = max(way for _, way in ways)
    moving = [(joint, longest / way) for joint, way in ways if way > 0 and math.isfinite(longest / way)]
    if not moving:
        return joints[0].speed, joints[0].acceleration
    return (
        min(joint.speed * share for joint, share in moving),
        min(joint.acceleration * share for joint, share in moving),
    )


def _numbered(name: str, number: int, first: Sequence[str], lines: Sequence[str], register: int) -> str:
    body = [
        *first,
        f"write_output_integer_register({register}, {number})",
        *lines,
        f"write_output_integer_register({register + 1}, {number})",
    ]
    return "\n  ".join([f"def arboleda_{name}_{number}():", *body]) + "\nend\n"
