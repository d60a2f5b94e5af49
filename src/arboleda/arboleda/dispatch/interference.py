"""Commands of others to the plant's robots, as bridges and ports report them."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

from arboleda.model.messages import Report
from arboleda.model.sentence import Phrase, Sentence

SHOWN = 20
MOST = 1_000_000_000  # no plant gives so many commands in one start; a bridge reads ids of ten digits
NEVER_GIVEN = Phrase(
    "foreign.never_given",
    "{robot}: its bridge took command {id}, which this plant never gave; it is halted. The log names other "
    "nodes that publish on /{robot}/command",
)
LATELY_S = 5.0  # an effect that a robot reports this long after a command may be of that command


@dataclass(frozen=True, kw_only=True)
class NumberedInterference:
    """Command of somebody else, or several between two reports; `number` grows by one with each."""

    number: int
    at: float
    robot: str
    sentence: Sentence


class Interferences:
    """The last commands of others to all robots, oldest first."""

    def __init__(self) -> None:
        self.noticed: deque[NumberedInterference] = deque(maxlen=SHOWN)
        self._counts: dict[str, tuple[int | None, int, int]] = {}  # robot -> bridge's start, refused, obeyed
        self._obeyed: dict[str, tuple[float, Sentence]] = {}
        self._count = 0
        self.accepted: dict[str, str | None] = {}  # by robot, the last command that it named as taken

    def note(self, robot: str, sentence: Sentence, at: float, *, obeyed: bool) -> None:
        self._count += 1
        if obeyed:
            self._obeyed[robot] = (at, sentence)
        self.noticed.append(NumberedInterference(number=self._count, at=at, robot=robot, sentence=sentence))

    def lately_obeyed(self, robot: str, now: float) -> Sentence | None:
        """The last command of somebody else that a robot carried out, in the last LATELY_S."""
        at, sentence = self._obeyed.get(robot, (0.0, None))
        return sentence if now <= at + LATELY_S else None

    def rise(self, report: Report) -> tuple[bool, bool]:
        """True where a report counts newly refused commands, and where it counts newly obeyed ones."""
        counts = (report.epoch, report.foreign_refused or 0, report.foreign_obeyed or 0)
        epoch, refused, obeyed = self._counts.get(report.robot, (report.epoch, 0, 0))
        if epoch != report.epoch:
            refused = obeyed = 0
        self._counts[report.robot] = counts
        return counts[1] > refused, counts[2] > obeyed

    def forged(self, report: Report, epoch: int, given: int) -> int | None:
        """The number of a command of `epoch` that a robot newly took, above the last that was given."""
        if report.accepted == self.accepted.get(report.robot):
            return None
        self.accepted[report.robot] = report.accepted
        start, _, number = (report.accepted or "").partition("-")
        is_ours = start == str(epoch) and number.isascii() and number.isdigit()
        return int(number) if is_ours and int(number) > given else None
