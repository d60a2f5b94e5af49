"""Checks of declared kinds' boards with command numbers only: prove the outcome of each order."""

from __future__ import annotations

from arboleda.drivers import Effect, VerbCommand
from arboleda.wire.topics import Channel

from .bench import LATCHED, MOVING, CheckFailed, CheckSkipped, Send, Steps, Wait
from .device_bench import DeviceBench, commands, is_work
from .device_procedures import LEAST_S, NO_VERB, NO_WORK, at_rest, carry_out, lasting, lead_to, named
from .number_checks import SILENCE_S
from .procedures import (
    ANSWER_S,
    accepted,
    answer,
    demand,
    echoes_tokens,
    numbered_reports,
    only_in_time,
    refused,
    refused_as_retained,
    stop,
    unmoved,
)

HALT_S = 1.5


def numbers(bench: DeviceBench) -> Steps:
    """Work is acknowledged by its number, and done by the same number once it has ended."""
    command = yield from lead_to(bench, is_work, NO_WORK)
    bench.beating = True
    yield from accepted(bench, bench.order(command))
    number = bench.seq
    done = yield Wait(seconds=command.at_most_s + ANSWER_S, until=lambda: bench.last.done == number)
    demand(done, f"{named(command)} has no hecho within {command.at_most_s:g} s")
    demand(bench.holds(command.sets), f"it says hecho for {named(command)}, and what that sets is not so")
    demand(bench.last.ack == number, "ack has changed without a command")


def telling(bench: DeviceBench) -> Steps:
    """Reports are numbered upwards in one boot, which `arranque` names."""
    yield from numbered_reports(bench)


def duplicate(bench: DeviceBench) -> Steps:
    """One of the last eight orders once more (QoS 1 may deliver twice) is neither refused nor done again."""
    command = yield from lead_to(bench, is_work, NO_WORK)
    yield from carry_out(bench, command)
    copy, number = bench.order(command, seq=bench.seq), bench.seq
    for _ in range(3):
        yield from accepted(bench, stop(bench, 2))
    before = bench.place
    yield copy
    yield from unmoved(bench, before, "the same order came twice")
    demand(bench.last.refused != number, f"it refuses the second delivery with {bench.last.refusal}")
    demand(bench.last.done == number, "the second delivery took its hecho away")


def old(bench: DeviceBench) -> Steps:
    """A number below the last one that it never accepted is refused with viejo."""
    bench.seq += 1
    missed = bench.seq
    yield from accepted(bench, stop(bench, 2))
    command = yield from lead_to(bench, _any, NO_VERB)
    bench.seq = max(bench.seq, missed)
    yield from refused(bench, bench.order(command, seq=missed), "viejo", missed)


def old_epoch(bench: DeviceBench) -> Steps:
    """A lower epoca is refused with viejo, whatever its seq."""
    yield from accepted(bench, stop(bench, 2))
    command = yield from lead_to(bench, _any, NO_VERB)
    number = bench.seq + 100
    yield from refused(bench, bench.order(command, seq=number, epoch=bench.epoch - 1), "viejo", number)


def new_epoch(bench: DeviceBench) -> Steps:
    """A higher epoca begins numbers of its own, and the old ones disappear."""
    command = yield from lead_to(bench, is_work, NO_WORK)
    yield from carry_out(bench, command)
    bench.epoch, bench.seq = bench.epoch + 1, 0
    yield from accepted(bench, stop(bench, 2))
    demand(bench.last.done is None, f"hecho {bench.last.done} of the older epoca is still there")


def stamped(bench: DeviceBench) -> Steps:
    """An order without seq and epoca is refused with formato."""
    before, command = bench.place, (yield from lead_to(bench, _any, NO_VERB))
    yield from accepted(bench, stop(bench, 2))
    before = bench.place
    order = bench.order(command, seq=0)
    bare = order.payload.partition(b', "seq"')[0] + b"}"
    yield Send(channel=order.channel, payload=bare)
    answered = yield Wait(seconds=1.0, until=lambda: bench.last.refusal == "formato")
    demand(answered, f"{bare.decode()} without numbers is not refused with formato")
    yield from unmoved(bench, before, "an order without numbers")


def late(bench: DeviceBench) -> Steps:
    """An order that names in visto what it told over 2 s ago is refused with tarde; paro never is."""
    command = yield from lead_to(bench, _any, NO_VERB)
    yield from only_in_time(bench, lambda visto: bench.order(command, visto=visto))


def token(bench: DeviceBench) -> Steps:
    """The ficha of an order is echoed with ack and with hecho, and by no number of another command."""
    command = yield from lead_to(bench, _any, NO_VERB)
    yield from echoes_tokens(bench, lambda ficha: bench.order(command, ficha=ficha))


def words(bench: DeviceBench) -> Steps:
    """Damaged commands, unknown verbs and unknown values are refused with formato."""
    yield Send(channel=Channel.STOP, payload=b'{"paro":3}')
    answered = yield Wait(seconds=1.0, until=lambda: bench.last.refusal == "formato")
    demand(answered, 'it does not refuse {"paro":3} with formato')
    yield from refused(bench, bench.send(Channel.ORDER, verbo="no-such-verb"), "formato")
    for verb in bench.kind.verbs.values():
        command = next(commands(bench.kind, verb))
        values = {**dict(command.values), "no-such-value": 1}
        yield from refused(bench, bench.send(Channel.ORDER, verbo=verb.name, valores=values), "formato")


def needs(bench: DeviceBench) -> Steps:
    """An order whose condition is not so is refused with condicion."""
    command = next((each for each in _every(bench) if each.needs and not bench.holds(each.needs)), None)
    if command is None:
        row = bench.way(lambda command: any(_breaks(command, other) for other in _every(bench)))
        if row is None:
            raise CheckSkipped("nothing that its verbs need can be made not so")
        for step in row:
            yield from carry_out(bench, step)
        command = next((each for each in _every(bench) if each.needs and not bench.holds(each.needs)), None)
        if command is None:
            raise CheckFailed("it does not say what its verb has set")
    yield from refused(bench, bench.order(command), "condicion")


def busy(bench: DeviceBench) -> Steps:
    """A second motion or process is refused with ocupado while one goes on."""
    yield from lasting(bench)
    other = next((each for each in _every(bench) if is_work(each) and bench.holds(each.needs)), None)
    if other is None:
        raise CheckSkipped("no other work is possible meanwhile")
    yield from answer(bench, bench.order(other))
    if bench.last.state != MOVING:
        raise CheckSkipped("its work was over before it could be seen")
    demand(
        bench.last.refusal == "ocupado", f"a second work is refused with {bench.last.refusal}, not ocupado"
    )


def queries(bench: DeviceBench) -> Steps:
    """Each query is answered by its number, with one of the declared answers."""
    verbs = [each for each in _every(bench) if each.definition.effect is Effect.QUERY]
    if not verbs:
        raise CheckSkipped("its kind has no query")
    for command in verbs:
        lacking = f"its kind has no way to {command.verb}"
        yield from lead_to(bench, lambda each, wanted=command: each == wanted, lacking)  # type: ignore[misc]
        yield from carry_out(bench, command)
        answer = bench.last.answer
        type = command.definition.answer_type
        demand(
            type.takes(answer), f"it answers {named(command)} with {answer!r}; its kind has {type.allowed()}"
        )


def retained(bench: DeviceBench) -> Steps:
    """An order that a broker has kept for the board is refused with retenido when it comes back."""
    command = yield from lead_to(bench, _any, NO_VERB)
    yield from accepted(bench, stop(bench, 2))
    # the number of the stop: heard while it is connected, the order is a copy and does nothing
    order, before = bench.order(command, seq=bench.seq), bench.place
    yield from refused_as_retained(bench, order, "a retained order")
    yield from unmoved(bench, before, "a retained order")


def halted(bench: DeviceBench) -> Steps:
    """Halted work never appears as done."""
    command = yield from lasting(bench)
    number = bench.seq
    yield from accepted(bench, stop(bench, 2))
    yield from at_rest(bench, HALT_S, "paro 2")
    yield Wait(seconds=command.takes_s)
    demand(bench.last.done != number, f"it says hecho for {named(command)}, which paro 2 has ended")


def stop_from_anybody(bench: DeviceBench) -> Steps:
    """`paro` 2 is obeyed whatever its numbers are."""
    command = yield from lasting(bench)
    number = bench.seq
    yield stop(bench, 2, seq=1, epoch=1)
    yield from at_rest(bench, HALT_S, "a paro 2 with old numbers")
    yield Wait(seconds=command.takes_s)
    demand(bench.last.done != number, "it went on to its end: a halt with old numbers has to be obeyed too")


def latch(bench: DeviceBench) -> Steps:
    """`paro` 1 stops and latches: until `paro` 0 no work begins; clearing moves nothing."""
    command = yield from lasting(bench)
    yield from accepted(bench, stop(bench, 1))
    yield from at_rest(bench, HALT_S, "paro 1")
    demand(bench.last.state == LATCHED, f"after paro 1 its estado is {bench.last.state}, not {LATCHED}")
    yield from refused(bench, bench.order(command), "paro")
    before = bench.place
    yield from accepted(bench, stop(bench, 0))
    yield from unmoved(bench, before, "paro 0")
    demand(bench.last.state == 0, f"after paro 0 its estado is {bench.last.state}, not 0")


def silence(bench: DeviceBench) -> Steps:
    """Once it has heard a beat, 1 s without beat or command ends what halts, in fallos as silencio."""
    yield from lasting(bench, SILENCE_S + LEAST_S)
    number = bench.seq
    bench.beating = False
    yield from at_rest(bench, SILENCE_S + HALT_S, "the last beat")
    demand(bench.last.done != number, "it says hecho for work that silence has ended")
    demand((number, "silencio") in bench.last.failures, f"fallos is {bench.last.failures}, without silencio")


def _any(command: VerbCommand) -> bool:
    return command.definition.effect is not Effect.QUERY


def _every(bench: DeviceBench) -> list[VerbCommand]:
    return [command for verb in bench.kind.verbs.values() for command in commands(bench.kind, verb)]


def _breaks(command: VerbCommand, other: VerbCommand) -> bool:
    sets = dict(command.sets)
    return any(sets.get(name, value) != value for name, value in other.needs)
