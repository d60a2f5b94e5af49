"""Reports of one board: its telemetry, refused commands, and foreign commands."""

from __future__ import annotations

from dataclasses import dataclass, replace

from arboleda.model.commands import Command
from arboleda.model.facts import Facts
from arboleda.model.messages import MotionState, Receipt, Report, Tokens
from arboleda.model.plant_model import Evidence, Robot
from arboleda.model.sentence import NOTHING, Sentence

from . import rejections
from .hop import shown
from .labels import Labels
from .link import BoardLink
from .payloads import Telemetry
from .rejections import Rejection


@dataclass(frozen=True, kw_only=True)
class Counters:
    """Counts of unused messages, refused or overtaken (`old`); `last` is the sentence of the last refusal."""

    refused: int = 0
    old: int = 0
    last: Sentence = NOTHING


@dataclass(frozen=True, kw_only=True)
class ForeignCommandCount:
    """Counts of foreign commands while a plant commands; `last` is the sentence on the last one."""

    refused: int = 0
    obeyed: int = 0
    last: Sentence = NOTHING


class BoardReports:
    """Writes the reports of one board. `plant` is the epoch of the plant that the bridge has heard."""

    def __init__(self, robot: Robot, labels: Labels, link: BoardLink) -> None:
        self.plant: int | None = None
        self.counters = Counters()
        self._robot = robot
        self._labels = labels
        self._link = link
        self._foreign = ForeignCommandCount()

    def no_link(self, at: float, **fields: object) -> Report:
        """A report that the board has no link."""
        return self.report(at, state=MotionState.NO_LINK, **fields)

    def word(self, at: float) -> Report:
        """A report on commands only."""
        return self.report(at, state=None if self._link.up else MotionState.NO_LINK)

    def report(self, at: float, **fields: object) -> Report:
        """A report with these fields, and with those that every report has."""
        rejected, word = self._labels.rejected or (None, None)
        foreign = self._foreign
        return Report(
            at=at,
            robot=self._robot.name,
            epoch=self._labels.start,
            plant=self.plant,
            boot_id=self._boot_id,
            rejected=rejected,
            refusal=word,
            foreign_refused=foreign.refused or None,
            foreign_obeyed=foreign.obeyed or None,
            foreign=foreign.last or None,
            **fields,  # type: ignore[arg-type]
        )

    def of_telemetry(
        self, at: float, message: Telemetry, q: tuple[float, ...] | None, facts: Facts | None
    ) -> Report:
        """The report of telemetry: state, place, and the commands that the board names."""
        answered, answer = self._labels.answered or (None, None)
        failed, failure = self._labels.failed or (None, None)
        return self.report(
            at,
            state=message.state,
            accepted=self._labels.accepted,
            done=self._labels.done,
            q=q,
            node=message.node,
            homed=message.homed,
            effector=message.effector,
            piece=message.piece,
            facts=facts,
            answered=answered,
            answer=answer,
            failed=failed,
            failure=failure,
            receipt=_receipt(message),
            tokens=_tokens(message),
            number=message.seq,
        )

    def earlier_failures(self, at: float) -> list[Report]:
        """A report of each newly abandoned command except the last, which the usual report names."""
        return [
            replace(self.word(at), failed=command_id, failure=word)
            for command_id, word in self._labels.failed_before
        ]

    def rejection(self, at: float, command: Command, word: str, sender: str, *, by_board: bool) -> Rejection:
        return Rejection(
            at=at,
            robot=self._robot.name,
            command=shown(command),
            id=command.id,
            reason=word,
            sentence=rejections.refused(self._robot, command, word, sender, by_board=by_board),
        )

    def count_foreign(self, sentence: Sentence, *, refused: bool) -> None:
        before = self._foreign
        self._foreign = ForeignCommandCount(
            refused=before.refused + refused, obeyed=before.obeyed + (not refused), last=sentence
        )

    def count(self, sentence: Sentence) -> None:
        """Count a refused message, with the sentence of its refusal."""
        self.counters = replace(self.counters, refused=self.counters.refused + 1, last=sentence)

    @property
    def _boot_id(self) -> int | None:
        counted = self._robot.evidence is Evidence.JOINTS
        return self._link.returns if counted else self._link.boot_id

    def count_old(self) -> None:
        """Count a message that a newer one has overtaken."""
        self.counters = replace(self.counters, old=self.counters.old + 1)


def _receipt(message: Telemetry) -> Receipt | None:
    if message.ack_epoch is None or message.ack is None:
        return None
    return Receipt(message.ack_epoch, message.ack, message.done)


def _tokens(message: Telemetry) -> Tokens | None:
    if message.ack_token is None and message.done_token is None:
        return None
    return Tokens(message.ack_token, message.done_token)
