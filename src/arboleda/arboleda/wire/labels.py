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
        self._accepted: tuple[int | None, int | None] = (None, None)  # as the board said it last
        self._least = -1  # the oldest epoch whose commands count for the board, as it said last
        self._seq = 0
        self._issued: OrderedDict[int, IssuedCommand] = OrderedDict()
        self._known: OrderedDict[str, None] = OrderedDict()
        self._spoken = False  # True once the board may have heard of this bridge
        self._led = False  # True if the board says this bridge is the newest it hears
        self._heard_refusal: tuple[int | None, int | None, str | None] | None = None
        self._heard_failures: tuple[tuple[int, str], ...] = ()

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
        self._heard_refusal = None
        self._heard_failures = ()
        self._least = -1

    def hear(self, said: Telemetry) -> frozenset[int]:
        """Take over the state of our commands from telemetry; returns the seqs that it reports as ended."""
        acknowledged = -1 if said.ack_epoch is None else said.ack_epoch
        self._least = max(acknowledged, -1 if said.least_epoch is None else said.least_epoch)
        begins = not self._spoken and not self._led  # later it is another one that has come after this bridge
        if begins and (acknowledged >= self.epoch or self._least > self.epoch):
            self.rise()
            self.start = self.epoch
        self._led = self._led or self._least == self.epoch
        strange = self._strange(said)
        self.foreign = None if begins else strange
        refused = self._refused(said)
        self.accepted = self._name(said, said.ack)
        self.done = self._name(said, said.done)
        done = said.done if self._is_ours(said, said.done) else None
        self._answered(said)
        failed = self._given_up(said)
        return frozenset([seq for seq in (done, refused, *failed) if seq is not None])

    def _answered(self, said: Telemetry) -> None:
        query = self._name(said, said.answered_seq)
        self.answered = None if query is None or said.answer is None else (query, said.answer)

    def _given_up(self, said: Telemetry) -> list[int]:
        """The seqs of the commands that the board abandoned; it repeats the last few in every message."""
        failures = tuple(each for each in said.failures or () if self._is_ours(said, each[0]))
        names = [(self._name(said, seq), word) for seq, word in failures]
        known = [(name, word) for name, word in names if name is not None]
        self.failed = known[-1] if known else None
        before = set(self._heard_failures)
        news = [(self._name(said, seq), word) for seq, word in failures[:-1] if (seq, word) not in before]
        self.failed_before = [(name, word) for name, word in news if name is not None]
        self._heard_failures = failures
        return [seq for seq, _ in failures]

    def _strange(self, said: Telemetry) -> tuple[int, int] | None:
        """A newly accepted number above ours, which another MQTT client must have sent; None if there is
        none.

        Before the board has heard of us, it may be one of the bridge before us, whose clock was ahead.
        """
        accepted = (said.ack_epoch, said.ack)
        before, self._accepted = self._accepted, accepted
        if said.ack_epoch is None or said.ack is None or accepted == before:
            return None
        above = (said.ack_epoch, said.ack) > (self.epoch, self._seq)
        return (said.ack_epoch, said.ack) if above else None

    def _refused(self, said: Telemetry) -> int | None:
        """The seq of ours that is newly rejected; a board repeats its last refusal in every message."""
        self.objection = None
        heard = (said.ack_epoch, said.refused_seq, said.refusal)
        if heard == self._heard_refusal:
            return None
        self._heard_refusal = heard
        if said.refusal is None or said.refused_seq is None or not self._concerns_us(said, said.refused_seq):
            return None
        issued = self._issued[said.refused_seq]
        self.refuse(issued.command.id, said.refusal)
        self.objection = (issued, said.refusal)
        return said.refused_seq

    def _concerns_us(self, said: Telemetry, refused_seq: int) -> bool:
        issued = self._issued.get(refused_seq)
        if issued is None:
            return False
        if said.refusal != "viejo":
            return said.ack_epoch == issued.epoch
        if self._least > issued.epoch:
            return True
        if said.ack_epoch != issued.epoch:
            return said.ack_epoch is not None and said.ack_epoch > issued.epoch
        # equal: it came twice (QoS 1), and the first one counts; above: a stranger's, ours is on its way
        return said.ack is not None and refused_seq < said.ack

    def _is_ours(self, said: Telemetry, seq: int | None) -> bool:
        """True if a number from the board was given to it by this bridge."""
        issued = self._issued.get(seq) if seq is not None else None
        return issued is not None and issued.epoch == said.ack_epoch

    def _name(self, said: Telemetry, seq: int | None) -> str | None:
        return self._issued[seq].command.id or None if seq is not None and self._is_ours(said, seq) else None


def _remember(table: OrderedDict[K, V], key: K, value: V) -> None:
    table[key] = value
    if len(table) > REMEMBERED:
        table.popitem(last=False)
