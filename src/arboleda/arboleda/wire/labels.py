"""Numbers of one board: command id <-> (epoca, seq), and the commands accepted, finished and rejected."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from typing import TypeVar

from arboleda.model.commands import Command
from arboleda.model.facts import Value

from .payloads import Telemetry
from .strict import UINT32

K = TypeVar("K")
V = TypeVar("V")

REMEMBERED = 256  # commands per board; an open one is never that old


@dataclass(frozen=True, kw_only=True)
class IssuedCommand:
    """Command that was given a number under `epoch`; `sender` names its sender if it has no id."""

    command: Command
    epoch: int
    sender: str = ""


class Labels:
    """Numbers of commands to one board, and the commands behind them.

    - `rejected` is the last rejected command and its word, from the board or the bridge.
    - `objection` is the command that the board newly refused in its last telemetry, with the word.
    - `answered` is the last answered query of a device, with the answer.
    - `failed` is the last command that it gave up, with its word; `failed_before` those that it newly names
      beside that one.
    - `foreign` is the (epoca, seq) of an unknown sender that it has newly accepted.
    - `epoch` is the one under which commands are given now, `start` that of this bridge's begin.
    """

    def __init__(self, epoch: int) -> None:
        self.epoch = self.start = epoch
        self.accepted: str | None = None
        self.done: str | None = None
        self.rejected: tuple[str, str] | None = None
        self.answered: tuple[str, Value] | None = None
        self.failed: tuple[str, str] | None = None
        self.failed_before: list[tuple[str, str]] = []
        self.objection: tuple[IssuedCommand, str] | None = None
        self.foreign: tuple[int, int] | None = None
        self._accepted: tuple[int | None, int | None] = (None, None)  # by the board's last telemetry
        self._least = -1  # the oldest epoch whose commands the board takes, by its last telemetry
        self._seq = 0
        self._issued: OrderedDict[int, IssuedCommand] = OrderedDict()
        self._known: OrderedDict[str, None] = OrderedDict()
        self._spoken = False  # True once the board may have heard of this bridge
        self._led = False  # True if the board says this bridge is the newest it hears
        self._last_refusal: tuple[int | None, int | None, str | None] | None = None
        self._last_failures: tuple[tuple[int, str], ...] = ()

    @property
    def fenced(self) -> bool:
        """True once the board has said that it takes no commands older than this bridge's epoch."""
        return self._least >= self.epoch

    @property
    def leads(self) -> bool:
        """True while the board says that this bridge is the newest that it hears."""
        return self._led and self._least <= self.epoch

    @property
    def beaten_by(self) -> int | None:
        """The epoch of a bridge that came after this one, and is refused since; None if there is none."""
        known = self._led or self._spoken
        return self._least if known and self._least > self.epoch else None

    def rise(self) -> None:
        """Use an epoch above all that the board has heard from now on."""
        self.epoch = min(max(self._least, self.epoch) + 1, UINT32)

    def repeated(self, command_id: str) -> bool:
        """True if a command of this id came before; remembers the id. Commands without an id never repeat."""
        if command_id in self._known:
            return True
        if command_id:
            _remember(self._known, command_id, None)
        return False

    def beat(self) -> int:
        """The epoch for a heartbeat."""
        self._spoken = True
        return self.epoch

    def issue(self, command: Command, sender: str = "") -> int:
        """The next seq, given to this command."""
        self._seq += 1
        self._spoken = True
        _remember(self._issued, self._seq, IssuedCommand(command=command, epoch=self.epoch, sender=sender))
        return self._seq

    def refuse(self, command_id: str, word: str) -> None:
        """Note a command that the bridge itself rejects."""
        if command_id:
            self.rejected = (command_id, word)

    def reboot(self) -> None:
        """Forget the board's last words: after a boot all are new."""
        self.accepted = self.done = self.rejected = self.answered = self.failed = None
        self._last_refusal = None
        self._last_failures = ()
        self._least = -1

    def hear(self, message: Telemetry) -> frozenset[int]:
        """Take over the state of our commands from telemetry; returns the seqs that it reports as ended."""
        acknowledged = -1 if message.ack_epoch is None else message.ack_epoch
        self._least = max(acknowledged, -1 if message.least_epoch is None else message.least_epoch)
        begins = not self._spoken and not self._led  # later it is another one that has come after this bridge
        if begins and (acknowledged >= self.epoch or self._least > self.epoch):
            self.rise()
            self.start = self.epoch
        self._led = self._led or self._least == self.epoch
        strange = self._strange(message)
        self.foreign = None if begins else strange
        refused = self._refused(message)
        self.accepted = self._name(message, message.ack)
        self.done = self._name(message, message.done)
        done = message.done if self._ours(message, message.done) else None
        self._answered(message)
        failed = self._failed(message)
        return frozenset([seq for seq in (done, refused, *failed) if seq is not None])

    def _answered(self, message: Telemetry) -> None:
        query = self._name(message, message.answered_seq)
        self.answered = None if query is None or message.answer is None else (query, message.answer)

    def _failed(self, message: Telemetry) -> list[int]:
        """The seqs of the commands that the board abandoned; it repeats the last few in every message."""
        failures = tuple(each for each in message.failures or () if self._ours(message, each[0]))
        names = [(self._name(message, seq), word) for seq, word in failures]
        known = [(name, word) for name, word in names if name is not None]
        self.failed = known[-1] if known else None
        before = set(self._last_failures)
        news = [(self._name(message, seq), word) for seq, word in failures[:-1] if (seq, word) not in before]
        self.failed_before = [(name, word) for name, word in news if name is not None]
        self._last_failures = failures
        return [seq for seq, _ in failures]

    def _strange(self, message: Telemetry) -> tuple[int, int] | None:
        """A newly accepted number above ours, which another MQTT client must have sent; None if there is
        none.

        Before the board has heard of us, it may be one of the bridge before us, whose clock was ahead.
        """
        accepted = (message.ack_epoch, message.ack)
        before, self._accepted = self._accepted, accepted
        if message.ack_epoch is None or message.ack is None or accepted == before:
            return None
        above = (message.ack_epoch, message.ack) > (self.epoch, self._seq)
        return (message.ack_epoch, message.ack) if above else None

    def _refused(self, message: Telemetry) -> int | None:
        """The seq of ours that is newly rejected; a board repeats its last refusal in every message."""
        self.objection = None
        seq, word = message.refused_seq, message.refusal
        refusal = (message.ack_epoch, seq, word)
        if refusal == self._last_refusal:
            return None
        self._last_refusal = refusal
        if word is None or seq is None or not self._concerns_us(message, seq):
            return None
        issued = self._issued[seq]
        self.refuse(issued.command.id, word)
        self.objection = (issued, word)
        return seq

    def _concerns_us(self, message: Telemetry, refused_seq: int) -> bool:
        issued = self._issued.get(refused_seq)
        if issued is None:
            return False
        if message.refusal != "viejo":
            return message.ack_epoch == issued.epoch
        if self._least > issued.epoch:
            return True
        if message.ack_epoch != issued.epoch:
            return message.ack_epoch is not None and message.ack_epoch > issued.epoch
        # equal: it came twice (QoS 1), and the first one counts; above: a stranger's, ours is on its way
        return message.ack is not None and refused_seq < message.ack

    def _ours(self, message: Telemetry, seq: int | None) -> bool:
        """True if a number from the board was given to it by this bridge."""
        issued = self._issued.get(seq) if seq is not None else None
        return issued is not None and issued.epoch == message.ack_epoch

    def _name(self, message: Telemetry, seq: int | None) -> str | None:
        return self._issued[seq].command.id or None if seq is not None and self._ours(message, seq) else None


def _remember(table: OrderedDict[K, V], key: K, value: V) -> None:
    table[key] = value
    if len(table) > REMEMBERED:
        table.popitem(last=False)
