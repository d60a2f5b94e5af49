"""Steps that several checks of a declared device share: carry an order out, begin one that lasts."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.drivers import Effect, OnStop, VerbCommand

from .bench import MOVING, CheckSkipped, Steps, Wait
from .device_bench import DeviceBench, is_work
from .procedures import ANSWER_S, demand

LEAST_S = 0.4  # shorter work cannot be caught in the middle
NO_WORK = "its kind has no motion and no process"
NO_VERB = "its kind has no verb"


def named(command: VerbCommand) -> str:
    """An order as its recipe writes it."""
    return f"{command.verb}({', '.join(f'{name}={value}' for name, value in command.values)})"


def carry_out(bench: DeviceBench, command: VerbCommand) -> Steps:
    """One order, beating, until the board has proved it."""
    bench.beating = True
    yield bench.order(command)
    yield from outcome(bench, command)
    bench.beating = False


def outcome(bench: DeviceBench, command: VerbCommand) -> Steps:
    """Wait until the last order has ended, as far as a board of its level can report that."""
    number, before = bench.seq, len(bench.reports)
    if bench.last.boot_id is None:
        yield Wait(seconds=ANSWER_S, until=lambda: bench.moves_since(before))
    over = yield Wait(seconds=command.at_most_s + ANSWER_S, until=lambda: _ended(bench, command, number))
    words = [word for seq, word in bench.last.failures if seq == number]
    demand(not words, f"it gave {named(command)} up: {words[:1]}")
    demand(bench.last.refused != number, f"it refused {named(command)} with {bench.last.refusal}")
    wanted = ", ".join(f"{name} {value}" for name, value in command.sets) or "its end"
    demand(over, f"{named(command)}: {wanted} was not said within {command.at_most_s:g} s")


def lead_to(bench: DeviceBench, wanted: Callable[[VerbCommand], bool], lacking: str) -> Steps:
    """Carry out the orders that have to come before a wanted one, and return that one.

    Where there is no way to one, the check is skipped, and `lacking` is why.
    """
    row = bench.way(wanted)
    if row is None:
        raise CheckSkipped(lacking)
    for command in row[:-1]:
        yield from carry_out(bench, command)
    return row[-1]


def lasting(bench: DeviceBench, least_s: float = LEAST_S) -> Steps:
    """Begin, with beats, a motion or process that lasts and that a stop ends, and return its order."""

    def wanted(command: VerbCommand) -> bool:
        return is_work(command) and command.definition.on_stop is OnStop.HALT and command.takes_s >= least_s

    lacking = f"its kind has no motion or process of {least_s:g} s and more that a stop ends"
    order = yield from lead_to(bench, wanted, lacking)
    bench.beating = True
    yield bench.order(order)
    number = bench.seq
    began = yield Wait(seconds=ANSWER_S, until=lambda: bench.last.state == MOVING)
    if not began and bench.last.done == number:
        raise CheckSkipped(f"{named(order)} was over before it could be seen")
    demand(began, f"it does not report moving (1) after {named(order)}")
    yield Wait(seconds=0.1)
    return order


def at_rest(bench: DeviceBench, within_s: float, after: str) -> Steps:
    """Demand that the device is at rest within this time."""
    rested = yield Wait(seconds=within_s, until=lambda: bench.last.state != MOVING)
    demand(rested, f"it still reports moving (1) {within_s:g} s after {after}")


def _ended(bench: DeviceBench, command: VerbCommand, number: int) -> bool:
    last = bench.last
    if last.boot_id is None:
        return last.state != MOVING and bench.holds(command.sets)
    if number == last.refused or any(seq == number for seq, _ in last.failures):
        return True
    if command.definition.effect is Effect.QUERY:
        return last.answered == number
    return bench.holds(command.sets) and (not is_work(command) or last.done == number)
