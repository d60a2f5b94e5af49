"""Steps that several checks of a declared device share: carry an order out, begin one that lasts."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.kinds.declared import Effect, VerbCall
from arboleda.model.commands import OnStop

from .bench import MOVING, CheckSkipped, Steps, Wait
from .device_bench import DeviceBench, is_work
from .procedures import ANSWER_S, demand

LEAST_S = 0.4  # what takes less cannot be caught in the middle


def named(told: VerbCall) -> str:
    """An order as its recipe writes it."""
    return f"{told.verb}({', '.join(f'{name}={value}' for name, value in told.values)})"


def carry_out(bench: DeviceBench, told: VerbCall) -> Steps:
    """One order, beating, until the board has proved it."""
    bench.beating = True
    yield bench.order(told)
    yield from outcome(bench, told)
    bench.beating = False


def outcome(bench: DeviceBench, told: VerbCall) -> Steps:
    """Wait until the last order has come to its end, by what a board of its level can say."""
    number, before = bench.seq, len(bench.said)
    if bench.last.boot_id is None:
        yield Wait(seconds=ANSWER_S, until=lambda: any(said.state == MOVING for said in bench.said[before:]))
    over = yield Wait(seconds=told.at_most_s + ANSWER_S, until=lambda: _ended(bench, told, number))
    words = [word for seq, word in bench.last.failures if seq == number]
    demand(not words, f"it gave {named(told)} up: {words[:1]}")
    demand(bench.last.refused != number, f"it refused {named(told)} with {bench.last.refusal}")
    wanted = ", ".join(f"{name} {value}" for name, value in told.sets) or "its end"
    demand(over, f"{named(told)}: {wanted} was not said within {told.at_most_s:g} s")


def lead_to(bench: DeviceBench, wanted: Callable[[VerbCall], bool], what: str) -> Steps:
    """Carry out the orders that have to come before a wanted one, and return that one."""
    row = bench.way(wanted)
    if row is None:
        raise CheckSkipped(f"its kind has no {what}")
    for told in row[:-1]:
        yield from carry_out(bench, told)
    return row[-1]


def lasting(bench: DeviceBench, least_s: float = LEAST_S) -> Steps:
    """Begin, with beats, a motion or process that lasts and that a stop ends, and return its order."""

    def wanted(told: VerbCall) -> bool:
        return is_work(told) and told.told.on_stop is OnStop.HALT and told.takes_s >= least_s

    told = yield from lead_to(bench, wanted, f"motion or process of {least_s:g} s and more that a stop ends")
    bench.beating = True
    yield bench.order(told)
    number = bench.seq
    began = yield Wait(seconds=ANSWER_S, until=lambda: bench.last.state == MOVING)
    if not began and bench.last.done == number:
        raise CheckSkipped(f"{named(told)} was over before it could be seen")
    demand(began, f"it does not report moving (1) after {named(told)}")
    yield Wait(seconds=0.1)
    return told


def at_rest(bench: DeviceBench, within_s: float, after: str) -> Steps:
    """Demand that the device is at rest within this time."""
    rested = yield Wait(seconds=within_s, until=lambda: bench.last.state != MOVING)
    demand(rested, f"it still reports moving (1) {within_s:g} s after {after}")


def _ended(bench: DeviceBench, told: VerbCall, number: int) -> bool:
    last = bench.last
    if last.boot_id is None:
        return last.state != MOVING and bench.holds(told.sets)
    if number == last.refused or any(seq == number for seq, _ in last.failures):
        return True
    if told.told.effect is Effect.QUERY:
        return last.answered == number
    return bench.holds(told.sets) and (not is_work(told) or last.done == number)
