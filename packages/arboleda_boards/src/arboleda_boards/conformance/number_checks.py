"""Checks of arms' boards with command numbers only: prove which command was accepted, refused, finished."""

from __future__ import annotations

from arboleda.wire.topics import Channel

from .arm_bench import ArmBench
from .arm_procedures import drive, set_off
from .bench import LATCHED, MOVING, CheckSkipped, Send, Steps, Wait
from .procedures import (
    accepted,
    answer,
    demand,
    echoes_tokens,
    numbered_reports,
    only_in_time,
    refused,
    refused_as_retained,
    rest,
    stop,
    unmoved,
)

SILENCE_S = 1.0
RAMP_S = 1.5  # to come to rest after that, and to be heard


def numbers(bench: ArmBench) -> Steps:
    """A goal is acknowledged by its number, and done by the same number when it rests on it."""
    goal = bench.away(0.1)
    bench.beating = True
    yield from accepted(bench, bench.goal(goal))
    demand(bench.last.done != bench.seq or bench.at(goal), "it says hecho before it stands on the goal")
    yield from rest(bench)
    demand(bench.last.done == bench.seq, f"it rests, and hecho is {bench.last.done}, not {bench.seq}")
    demand(bench.last.ack == bench.seq, "ack has changed without a command")


def telling(bench: ArmBench) -> Steps:
    """Reports are numbered upwards in one boot, and say all that belongs to this level."""
    yield from numbered_reports(bench)
    demand(bench.last.homed is not None and bench.last.effector is not None, "ref or efector is missing")


def duplicate(bench: ArmBench) -> Steps:
    """The last command once more (QoS 1 may deliver twice) is neither refused nor carried out again."""
    goal = bench.goal(bench.away(0.1))
    bench.beating = True
    yield from accepted(bench, goal)
    yield from rest(bench)
    before, number = bench.steps, bench.seq
    yield goal
    yield from unmoved(bench, before, "the same command came twice")
    demand(bench.last.refused != number, f"it refuses the second delivery with {bench.last.refusal}")
    demand(bench.last.done == number, "the second delivery took its hecho away")


def old(bench: ArmBench) -> Steps:
    """A number that is not greater than the last one is refused with viejo."""
    yield from drive(bench, bench.away(0.05))
    here, there = bench.steps, bench.away(0.1)
    yield from drive(bench, there)
    yield from refused(bench, bench.goal(here, seq=bench.seq - 1), "viejo", bench.seq - 1)


def old_epoch(bench: ArmBench) -> Steps:
    """A lower epoca is refused with viejo, whatever its seq."""
    yield from accepted(bench, stop(bench, 2))
    number = bench.seq + 100
    yield from refused(
        bench, bench.goal(bench.away(0.05), seq=number, epoch=bench.epoch - 1), "viejo", number
    )


def new_epoch(bench: ArmBench) -> Steps:
    """A higher epoca begins numbers of its own, and the old ones disappear."""
    yield from drive(bench, bench.away(0.05))
    bench.epoch, bench.seq = bench.epoch + 1, 0
    yield from accepted(bench, stop(bench, 2))
    demand(bench.last.done is None, f"hecho {bench.last.done} of the older epoca is still there")


def stamped(bench: ArmBench) -> Steps:
    """A goal without seq and epoca is refused with formato."""
    before, payload = bench.steps, b'{"efector":0}'
    yield Send(channel=Channel.EFFECTOR, payload=payload)
    yield Wait(seconds=1.0, until=lambda: bench.last.refusal == "formato")
    demand(bench.last.refusal == "formato", f"{payload.decode()} without numbers is not refused with formato")
    yield from unmoved(bench, before, "a command without numbers")


def retained(bench: ArmBench) -> Steps:
    """A goal that a broker has kept for the board is refused with retenido when it comes back."""
    yield from accepted(bench, stop(bench, 2))
    before, goal = bench.steps, bench.goal(bench.away(0.05), seq=bench.seq)
    # an old number: heard while it is connected, the goal is harmless
    yield from refused_as_retained(bench, goal, "a retained goal")
    yield from unmoved(bench, before, "a retained goal")


def late(bench: ArmBench) -> Steps:
    """A goal that names in visto what it told over 2 s ago is refused with tarde; paro never is."""
    yield from only_in_time(bench, lambda visto: bench.goal(bench.away(0.05), visto=visto))


def token(bench: ArmBench) -> Steps:
    """The ficha of a goal is echoed with ack and with hecho, and by no number of another command."""
    yield from echoes_tokens(bench, lambda ficha: bench.goal(bench.away(0.05), ficha=ficha))


def words(bench: ArmBench) -> Steps:
    """Damaged commands are refused with formato, goals beyond a limit with limite."""
    yield Send(channel=Channel.STOP, payload=b'{"paro":3}')
    answered = yield Wait(seconds=1.0, until=lambda: bench.last.refusal == "formato")
    demand(answered, 'it does not refuse {"paro":3} with formato')
    yield from refused(bench, bench.goal_deg([5000.0, *(0.0 for _ in bench.step_deg[1:])]), "limite")


def halted(bench: ArmBench) -> Steps:
    """A halted move never appears as done."""
    yield from set_off(bench, bench.away(0.4))
    number = bench.seq
    yield from accepted(bench, stop(bench, 2))
    yield from rest(bench)
    demand(bench.last.done != number, "it says hecho for a move that paro 2 has ended")


def stop_from_anybody(bench: ArmBench) -> Steps:
    """`paro` 2 is obeyed whatever its numbers are."""
    goal = bench.away(0.4)
    yield from set_off(bench, goal)
    yield stop(bench, 2, seq=1, epoch=1)
    yield from rest(bench)
    demand(not bench.at(goal), "it went on to its goal: a halt with old numbers has to be obeyed too")


def latch(bench: ArmBench) -> Steps:
    """`paro` 1 stops and latches; until `paro` 0 neither goals nor effector on; clearing moves nothing."""
    goal = bench.away(0.4)
    yield from set_off(bench, goal)
    yield from accepted(bench, stop(bench, 1))
    yield from rest(bench)
    demand(bench.last.state == LATCHED, f"after paro 1 its estado is {bench.last.state}, not {LATCHED}")
    yield from refused(bench, bench.goal(bench.away(0.05)), "paro")
    yield from refused(bench, bench.send(Channel.EFFECTOR, efector=1), "paro")
    before = bench.steps
    yield from accepted(bench, stop(bench, 0))
    yield from unmoved(bench, before, "paro 0")
    demand(bench.last.state == 0, f"after paro 0 its estado is {bench.last.state}, not 0")


def retarget(bench: ArmBench) -> Steps:
    """A second goal in the middle of a move replaces the first, which is never done."""
    first = bench.away(0.4)
    here = bench.steps
    yield from set_off(bench, first)
    replaced = bench.seq
    yield from accepted(bench, bench.goal(here))
    yield from rest(bench)
    demand(bench.at(here), f"it stands at {bench.steps}, not at its second goal {here}")
    demand(all(report.done != replaced for report in bench.reports[-50:]), "it says hecho for the first goal")
    demand(bench.last.done == bench.seq, "it does not say hecho for the second goal")


def silence(bench: ArmBench) -> Steps:
    """Once it has heard a beat, 1 s without beat or command ends a move."""
    yield from drive(bench, _end(bench, upper=False))
    far = _end(bench, upper=True)
    yield from set_off(bench, far)
    bench.beating = False
    yield Wait(seconds=SILENCE_S + RAMP_S, until=lambda: bench.last.state != MOVING)
    if bench.at(far):
        raise CheckSkipped("its longest way takes too little time to tell")
    demand(bench.last.state != MOVING, f"it still moves {SILENCE_S + RAMP_S:g} s after the last beat")
    demand(bench.last.done != bench.seq, "it says hecho for a move that silence has ended")


def effector(bench: ArmBench) -> Steps:
    """It reports its effector as it was commanded."""
    for wanted in (1, 0):
        yield from accepted(bench, bench.send(Channel.EFFECTOR, efector=wanted))
        demand(bench.last.effector == bool(wanted), f"efector is not {wanted} after the command was accepted")


def homing(bench: ArmBench) -> Steps:
    """Homing: not homed and busy on the way, homed, done and at the reference in the end."""
    bench.beating = True
    yield from accepted(bench, bench.send(Channel.HOME, ref=1))
    number = bench.seq
    demand(bench.last.homed is False, "it says ref 1 while it looks for its reference")
    yield from answer(bench, bench.goal(bench.steps))
    demand(bench.last.refusal == "ocupado", f"a goal during homing is refused with {bench.last.refusal}")
    done = yield Wait(seconds=2 * bench.patience_s, until=lambda: bench.last.done == number)
    demand(done, f"homing has no hecho within {2 * bench.patience_s:g} s")
    demand(bench.last.homed is True and bench.last.state == 0, "homing is done, and it says it is not homed")
    demand(bench.at(tuple(0 for _ in bench.step_deg)), f"after homing it stands at {bench.steps} motor steps")


def _end(bench: ArmBench, *, upper: bool) -> tuple[int, ...]:
    """The far end of the joint that takes longest; the others stay."""
    joints = bench.arm.joints
    slowest = max(range(len(joints)), key=lambda at: joints[at].travel_s(joints[at].upper - joints[at].lower))
    joint, steps = joints[slowest], list(bench.steps)
    steps[slowest] = joint.steps(joint.upper if upper else joint.lower)
    return tuple(steps)
