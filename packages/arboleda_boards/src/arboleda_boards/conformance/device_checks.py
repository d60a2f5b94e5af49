"""Checks of a declared kind's board at every level: facts, verbs, halts, and orders to leave alone."""

from __future__ import annotations

from collections.abc import Callable

from arboleda.drivers import Effect, UseError, VerbCommand
from arboleda.wire.topics import Channel

from .bench import MOVING, CheckSkipped, Send, Steps, Wait
from .device_bench import DeviceBench, is_work
from .device_procedures import NO_WORK, at_rest, carry_out, lasting, lead_to
from .procedures import ANSWER_S, accepted, demand, rest, stop, unmoved

HALT_S = 1.5

MALFORMED = (
    b"",
    b"{",
    b"[1]",
    b'{"valores":{}}',
    b'{"verbo":7}',
    b'{"verbo":"\\u00e9"}',
    b'{"verbo":%(verb)b,"valores":[1]}',
    b'{"verbo":%(verb)b,"valores":{"a":null}}',
    b'{"verbo":%(verb)b,"verbo":%(verb)b}',
    b'{"verbo":%(verb)b}' + b" " * 500,
)


def works(bench: DeviceBench) -> Steps:
    """A motion or a process makes it report moving, and then standing still."""
    command = yield from lead_to(bench, is_work, NO_WORK)
    before = len(bench.reports)
    bench.beating = True
    yield bench.order(command)
    yield Wait(seconds=ANSWER_S, until=lambda: bench.last.state == MOVING)
    yield from rest(bench)
    demand(bench.moves_since(before), f"{command.verb} did not make it report moving (1)")


def facts(bench: DeviceBench) -> Steps:
    """It reports every fact of its kind, each with a value that this can be."""
    yield Wait(seconds=0.3)
    missing = [name for name in bench.kind.facts if name not in bench.facts]
    demand(not missing, f"datos has not said {', '.join(missing)}")
    for name, value in bench.facts.items():
        try:
            bench.kind.check_fact(name, value)
        except UseError as error:
            demand(False, str(error))


def verbs(bench: DeviceBench) -> Steps:
    """It carries out each of its verbs, and says within the declared time what that sets."""
    for verb in bench.kind.verbs.values():
        if verb.effect is Effect.QUERY:
            continue
        lacking = f"its kind has no way to {verb.name}"
        yield from carry_out(bench, (yield from lead_to(bench, _calls(verb.name), lacking)))


def _calls(verb: str) -> Callable[[VerbCommand], bool]:
    return lambda command: command.verb == verb


def halts(bench: DeviceBench) -> Steps:
    """`paro` 2 ends what a stop ends, and for good."""
    command = yield from lasting(bench)
    yield stop(bench, 2)
    yield from at_rest(bench, HALT_S, "paro 2")
    if command.sets and bench.holds(command.sets) and bench.last.boot_id is None:
        raise CheckSkipped(f"{command.verb} was over when paro 2 came")
    yield from unmoved(bench, bench.place, "a halt had ended its work")


def malformed(bench: DeviceBench) -> Steps:
    """Orders that are damaged in any way change nothing."""
    before = bench.place
    verb = f'"{next(iter(bench.kind.verbs))}"'.encode()
    for payload in MALFORMED:
        damaged = payload.replace(b"%(verb)b", verb)
        yield Send(channel=Channel.ORDER, payload=damaged)
        yield from unmoved(bench, before, f"the damaged order {damaged[:40]!r}")


def unknown(bench: DeviceBench) -> Steps:
    """A verb that its kind does not have, or a value beside those of a verb, changes nothing."""
    before = bench.place
    verb = next(iter(bench.kind.verbs))
    for body in ({"verbo": "no-such-verb"}, {"verbo": verb, "valores": {"no-such-value": 1}}):
        yield bench.send(Channel.ORDER, **body)
        yield from unmoved(bench, before, f"the order {body}")
    if bench.last.boot_id is not None:
        yield from accepted(bench, stop(bench, 2))
