"""Checks of an arm's board at every level: report in time, reach goals, halt, leave bad messages alone."""

from __future__ import annotations

from itertools import pairwise
from math import copysign
from typing import Any

from arboleda.model.counting import counted
from arboleda.wire.topics import Channel
from arboleda.wire.units import to_wire

from .arm_bench import ArmBench
from .arm_procedures import drive, set_off
from .bench import MOVING, Bench, Send, Steps, Wait
from .procedures import demand, rest, stop, unmoved

LISTEN_S = 2.0
LONGEST_GAP_S = 1.0  # a plant calls a board stale after 1.5 s
LEAST_REPORTS = 14  # a network may lose some, QoS 0

MALFORMED = (
    b"",
    b"{",
    b"[1]",
    b'{"q1":NaN,"q2":0,"q3":0}',
    b'{"q1":true,"q2":0,"q3":0}',
    b'{"q1":"9","q2":0,"q3":0}',
    b'{"q1":9}',
    b'{"q1":9,"q1":9,"q2":0,"q3":0}',
    b'{"q1":1e39,"q2":0,"q3":0}',
    b'{"q1":9,"q2":0,"q3":0}' + b" " * 500,
)


def telemetry(bench: Bench[Any]) -> Steps:
    """Every report is one JSON object with the state, of at most 512 bytes."""
    yield Wait(seconds=LISTEN_S)
    demand(bool(bench.reports), f"nothing on {bench.name}/sensores that can be read in {LISTEN_S:g} s")
    damaged = "; ".join(bench.damaged[:1])
    demand(not damaged, f"it says what cannot be read: {damaged}")


def moves(bench: ArmBench) -> Steps:
    """A goal makes it report moving, and then standing still."""
    before = len(bench.reports)
    yield from drive(bench, bench.away(0.1))
    demand(bench.moves_since(before), "a goal did not make it report moving (1)")


def rhythm(bench: Bench[Any]) -> Steps:
    """It reports at 10 Hz, also while nothing happens."""
    before = len(bench.reports)
    yield Wait(seconds=LISTEN_S)
    times = [report.at for report in bench.reports[before:]]
    rate = f"{counted(len(times), 'report')} in {LISTEN_S:g} s"
    demand(len(times) >= LEAST_REPORTS, f"{rate}; 10 a second are needed")
    gap = max(after - at for at, after in pairwise(times))
    demand(gap <= LONGEST_GAP_S, f"{gap:.2f} s between two reports; 0.1 s are needed")


def reaches(bench: ArmBench) -> Steps:
    """It stands on the goal in the end."""
    for part in (0.1, 0.05):
        goal = bench.away(part)
        yield from drive(bench, goal)
        demand(bench.at(goal), f"it stands at {bench.steps} motor steps, not at {goal}")


def rounds(bench: ArmBench) -> Steps:
    """A goal between two motor steps is rounded, not cut off."""
    goal = bench.away(0.05)
    bench.beating = True
    yield bench.goal([count - copysign(0.4, count) for count in goal])
    yield Wait(seconds=1.0, until=lambda: bench.last.state == MOVING)
    yield from rest(bench)
    demand(bench.at(goal), f"for 0.4 steps less than {goal} it stands at {bench.steps}: it does not round")


def halts(bench: ArmBench) -> Steps:
    """`paro` 2 ends a move: short of its goal, and for good."""
    goal = bench.away(0.4)
    yield from set_off(bench, goal)
    yield stop(bench, 2)
    yield from rest(bench)
    demand(not bench.at(goal), "it went on to its goal after paro 2")
    yield from unmoved(bench, bench.steps, "a halt had ended its move")


def malformed(bench: ArmBench) -> Steps:
    """Messages that are damaged in any way change nothing."""
    before = bench.steps
    for payload in MALFORMED:
        yield Send(channel=Channel.JOINTS, payload=payload)
        yield from unmoved(bench, before, f"the damaged goal {payload[:40]!r}")


def limits(bench: ArmBench) -> Steps:
    """A goal beyond a limit changes nothing, whatever the other joints' goals are."""
    before = bench.steps
    beyond = round(to_wire(bench.arm.joints[-1], bench.arm.joints[-1].upper) + 5.0, 4)
    goal = [count * step for count, step in zip(bench.away(0.05), bench.step_deg, strict=True)]
    yield bench.goal_deg([*goal[:-1], beyond])
    yield from unmoved(bench, before, f"a goal with q{len(goal)} at {beyond}, beyond its limit")
