"""Steps that several checks of an arm share: drive somewhere, set off, look for the reference."""

from __future__ import annotations

from arboleda.wire.topics import Channel

from .arm_bench import ArmBench
from .bench import MOVING, NOT_HOMED, Steps, Wait
from .procedures import ANSWER_S, demand, rest


def drive(bench: ArmBench, steps: tuple[int, ...]) -> Steps:
    """Drive somewhere, and wait until it rests."""
    bench.beating = True
    yield bench.goal(steps)
    yield Wait(seconds=1.0, until=lambda: bench.last.state == MOVING or bench.at(steps))
    yield from rest(bench)
    bench.beating = False


def set_off(bench: ArmBench, steps: tuple[int, ...]) -> Steps:
    """Begin a long way, beating, and wait until it is well under way."""
    before = bench.steps
    bench.beating = True
    yield bench.goal(steps)
    moving = yield Wait(seconds=ANSWER_S, until=lambda: bench.last.state == MOVING)
    demand(moving, "it does not begin to move")
    yield Wait(seconds=0.3, until=lambda: False)
    changed = yield Wait(seconds=ANSWER_S, until=lambda: bench.steps != before or bench.last.q is None)
    demand(changed, "its joints do not change while it moves")


def ready(bench: ArmBench) -> Steps:
    """Have a board that can look for its reference do so, if it has to."""
    if bench.last.state == NOT_HOMED and bench.last.boot_id is not None:
        bench.beating = True
        yield bench.send(Channel.HOME, ref=1)
        homed = yield Wait(seconds=2 * bench.patience_s, until=lambda: bench.last.homed is True)
        bench.beating = False
        demand(homed, "it is not homed, and homing does not help")
