"""Steps that checks of any board share: send and wait for an answer, wait for rest, stop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from arboleda.wire.topics import Channel

from .bench import MOVING, Bench, CheckFailed, CheckSkipped, Jostle, Send, Steps, Wait

ANSWER_S = 2.0
BACK_S = 10.0  # so long it may take to connect again
NOTHING_S = 0.4  # so long a board that does nothing is watched
LATE_S = 2.5  # a report of this age counts as old, by far
TOKEN = "0a3f97001a01"
AHEAD = 100_000  # so many reports on
WAITED = (
    "; that visto names what it told more than 2 s ago: the command waited in a broker, or in a connection "
    "that was cut. It has to remember which seq it told when; without that, what has waited moves it"
)


def demand(truth: bool, sentence: str) -> None:
    """Raise CheckFailed with this sentence, unless it is true."""
    if not truth:
        raise CheckFailed(sentence)


def rest(bench: Bench[Any]) -> Steps:
    """Wait until two new reports say that it stands still at one place."""
    count = len(bench.reports)

    def resting() -> bool:
        last = bench.reports[max(count, len(bench.reports) - 2) :]
        return len(last) == 2 and all(each.state != MOVING and each.place == last[0].place for each in last)

    rested = yield Wait(seconds=bench.patience_s, until=resting)
    demand(rested, f"it was not seen standing still within {bench.patience_s:g} s")


def numbered_reports(bench: Bench[Any]) -> Steps:
    """Hear the reports of a second, which are of one boot and numbered upwards."""
    before = len(bench.reports)
    yield Wait(seconds=1.0)
    fresh = bench.reports[before:]
    rising = [report.number for report in fresh if report.number is not None]
    demand(rising == sorted(set(rising)) and len(rising) == len(fresh), "seq of its reports does not rise")
    demand(len({report.boot_id for report in fresh}) == 1, "arranque changes without a reboot")


def answer(bench: Bench[Any], send: Send, seq: int | None = None) -> Steps:
    """Send it, and wait until the board accepts or refuses its number."""
    yield send
    number, epoch = bench.seq if seq is None else seq, bench.epoch
    count = len(bench.reports)

    def answered() -> bool:
        fresh = bench.reports[count:]
        return any(report.epoch == epoch and number in (report.ack, report.refused) for report in fresh)

    yield Wait(seconds=ANSWER_S, until=answered)


def accepted(bench: Bench[Any], send: Send) -> Steps:
    """Send a command that the board has to accept."""
    yield from answer(bench, send)
    demand(
        bench.last.ack == bench.seq and bench.last.epoch == bench.epoch,
        f"it does not accept {send.payload.decode()}; it says {_answer(bench)}",
    )


def refused(bench: Bench[Any], send: Send, word: str, seq: int | None = None, *, why: str = "") -> Steps:
    """Send a command that the board has to refuse with this word, and without moving."""
    before = bench.place
    yield from answer(bench, send, seq)
    number = bench.seq if seq is None else seq
    report = bench.last
    wrong = f"it should refuse {send.payload.decode()} with {word}; it says {_answer(bench)}"
    demand((report.refusal, report.refused) == (word, number), wrong + why)
    yield from unmoved(bench, before, send.payload.decode())


def unmoved(bench: Bench[Any], before: tuple[Any, ...], after: str) -> Steps:
    """Watch that it stays as it was."""
    moved = yield Wait(seconds=NOTHING_S, until=lambda: bench.place != before or bench.last.state == MOVING)
    demand(not moved, f"it moves after {after}")


def stop(bench: Bench[Any], mode: int, **numbers: int) -> Send:
    """`paro`: 1 stop and latch, 2 halt, 0 clear."""
    return bench.send(Channel.STOP, paro=mode, **numbers)


def settle(bench: Bench[Any]) -> Steps:
    """After a check, whatever came of it: halted, cleared, still."""
    bench.beating = False
    for mode in (2, 0):
        yield stop(bench, mode)
        yield Wait(seconds=0.05)
    yield from rest(bench)


def _answer(bench: Bench[Any]) -> str:
    rows: dict[str, Any] = {
        "epoca_ack": bench.last.epoch,
        "ack": bench.last.ack,
        "rechazo": bench.last.refusal,
        "rechazo_seq": bench.last.refused,
    }
    return (
        ", ".join(f"{key} {value}" for key, value in rows.items() if value is not None) or "nothing about it"
    )


def only_in_time(bench: Bench[Any], command: Callable[[int], Send]) -> Steps:
    """A command that names a report of long ago, or none, is refused, one that names the last is taken; a
    stop always is."""
    number = bench.last.number
    demand(number is not None, "its reports have no seq, so no command can name one")
    yield Wait(seconds=LATE_S)
    yield from refused(bench, command(number), "tarde", why=WAITED)
    yield from refused(bench, command(bench.last.number + AHEAD), "tarde")
    yield from accepted(bench, stop(bench, 2, visto=number))
    yield from accepted(bench, command(bench.last.number))


def echoes_tokens(bench: Bench[Any], command: Callable[[str], Send]) -> Steps:
    """The token of a command comes back with its number, at its end as well, and a stop leaves none."""
    yield from accepted(bench, command(TOKEN))
    if bench.last.ack_token is None:
        raise CheckSkipped("it echoes no ficha, which a board need not")
    demand(bench.last.ack_token == TOKEN, f"ficha_ack is {bench.last.ack_token}, and not {TOKEN}")
    number = bench.seq
    done = yield Wait(seconds=bench.patience_s, until=lambda: bench.last.done == number)
    echoed = bench.last.done_token
    demand(not done or echoed == TOKEN, f"hecho is {number}, and ficha_hecho is {echoed}, not {TOKEN}")
    yield from accepted(bench, stop(bench, 2))
    demand(bench.last.ack_token is None, "ack is that of paro, and ficha_ack still that of a command before")


def refused_as_retained(bench: Bench[Any], message: Send, what: str) -> Steps:
    """Have the board come back while the broker keeps a message for it, `what`, which it has to refuse."""
    yield replace(message, retain=True)
    yield Wait(seconds=0.5)
    arrivals = bench.arrivals
    yield Jostle()
    back = yield Wait(seconds=BACK_S, until=lambda: bench.arrivals > arrivals)
    yield Wait(seconds=1.0, until=lambda: bench.last.refusal == "retenido")
    refusal = bench.last.refusal
    yield Send(channel=message.channel, payload=b"", retain=True)
    yield Wait(seconds=0.3)
    if not back:
        raise CheckSkipped("its MQTT client id is not its name, so it could not be made to reconnect")
    demand(refusal == "retenido", f"it came back, heard {what} and says rechazo {refusal}")
