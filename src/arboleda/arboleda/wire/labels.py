"""Numbers of one board: command id <-> (epoca, seq), and commands accepted, done and rejected.

A seq means nothing without its epoch: each bridge counts from 1, and so does each start of this one. The
epoch may rise while commands are open, so each command remembers its own. A board repeats its last refusal
and its last failures in every message: they are news only once.
"""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from typing import TypeVar

from arboleda.model import refusals
from arboleda.model.commands import Command
from arboleda.model.facts import Value

from .payloads import Telemetry
from .strict import UINT32

K = TypeVar("K")
V = TypeVar("V")

REMEMBERED = 256  # commands per board; an open one is never that old


@dataclass(frozen=True, kw_only=True)
class IssuedCommand:
    """Command that has a number under `epoch`; `sender` names the sender of a command without an id."""

    command: Command
    epoch: int
    sender: str = ""


class Labels:
    """Numbers of commands to one board, and the commands behind them.

    - `rejected` is the last rejected command and its word, from the board or the bridge.
    - `objection` is the command that the board newly refused in its last telemetry, with the word.
    - `answered` is the last answered query of a device, with the answer.
    - `failed` is the last command that the board gave up, with the word; `failed_before` are others that its
      last telemetry newly names.
    - `foreign` is the (epoca, seq) of a newly accepted command of an unknown sender.
    - `epoch` is that of new commands, `start` the epoch with which this bridge began.
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
        self._ids: OrderedDict[str, None] = OrderedDict()
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
        """The epoch of a later bridge, since which this one is refused; None if there is none."""
        was_heard = self._led or self._spoken
        return self._least if was_heard and self._least > self.epoch else None

    def rise(self) -> None:
        """Raise the epoch above all epochs that the board has heard."""
        self.epoch = min(max(self._least, self.epoch) + 1, UINT32)

    def repeated(self, command_id: str) -> bool:
        """True if a command of this id came before; remembers the id. Without an id none repeats."""
        if command_id in self._ids:
            return True
        if command_id:
            _remember(self._ids, command_id, None)
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
        """Take the state of our commands from telemetry; returns the seqs of commands that have ended."""
        acknowledged = -1 if message.ack_epoch is None else message.ack_epoch
        self._least = max(acknowledged, -1 if message.least_epoch is None else message.least_epoch)
        begins = not self._spoken and not self._led  # a later one is another bridge
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
        """The seqs of the commands that the board gave up; every message repeats the last few of them."""
        failures = tuple(each for each in message.failures or () if self._ours(message, each[0]))
        names = [(self._name(message, seq), word) for seq, word in failures]
        with_names = [(name, word) for name, word in names if name is not None]
        self.failed = with_names[-1] if with_names else None
        before = set(self._last_failures)
        news = [(self._name(message, seq), word) for seq, word in failures[:-1] if (seq, word) not in before]
        self.failed_before = [(name, word) for name, word in news if name is not None]
        self._last_failures = failures
        return [seq for seq, _ in failures]

    def _strange(self, message: Telemetry) -> tuple[int, int] | None:
        """A newly accepted number above ours, which another MQTT client must have sent; None without one.

        Before the board has heard of us, the number may be of an earlier bridge, whose clock was ahead.
        """
        accepted = (message.ack_epoch, message.ack)
        before, self._accepted = self._accepted, accepted
        if message.ack_epoch is None or message.ack is None or accepted == before:
            return None
        above = (message.ack_epoch, message.ack) > (self.epoch, self._seq)
        return (message.ack_epoch, message.ack) if above else None

    def _refused(self, message: Telemetry) -> int | None:
        """The seq of our newly rejected command; a board repeats its last refusal in every message."""
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
        if message.refusal != refusals.OLD:
            return message.ack_epoch == issued.epoch
        if self._least > issued.epoch:
            return True
        if message.ack_epoch != issued.epoch:
            return message.ack_epoch is not None and message.ack_epoch > issued.epoch
        # An equal seq came twice (QoS 1), and the first counts. A seq above ours is of a stranger: the board
        # has not taken ours yet.
        return message.ack is not None and refused_seq < message.ack

    def _ours(self, message: Telemetry, seq: int | None) -> bool:
        """True if this bridge gave the number to a command."""
        issued = self._issued.get(seq) if seq is not None else None
        return issued is not None and issued.epoch == message.ack_epoch

    def _name(self, message: Telemetry, seq: int | None) -> str | None:
        return self._issued[seq].command.id or None if seq is not None and self._ours(message, seq) else None


def _remember(table: OrderedDict[K, V], key: K, value: V) -> None:
    table[key] = value
    if len(table) > REMEMBERED:
        table.popitem(last=False)
