"""Ends of the tasks, by the plant's history and by the true deeds of the boards. Pure."""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from arboleda.model.messages import Reason, Verb
from arboleda.store.task_rows import TaskRow

from .deeds import ALONE, PICK_UP, STATION, Deed, Did
from .people import Said

BY_HAND_S = 2.0  # so soon after an operator had an effector opened, its part is let go for that


@dataclass(frozen=True, kw_only=True)
class Kill:
    """One start of the plant and its end by -9; Unix times. `running`: the ids that it left at work.

    Its boards were there from `joined_at` on: what they did before, the plant before it had told them.
    """

    started_at: float
    joined_at: float
    killed_at: float = float("inf")
    running: frozenset[str] = frozenset()


@dataclass(kw_only=True)
class Verdict:
    """A sentence for each task that was lost, deed that was doubled, part that was dropped, untimely move.

    `by_hand`: parts let go as an operator was advised to; `put_back`: onto the mobile robot; `after`: what
    became of the tasks that kills left at work.
    """

    lost: list[str] = field(default_factory=list)
    doubled: list[str] = field(default_factory=list)
    dropped: list[str] = field(default_factory=list)
    moved: list[str] = field(default_factory=list)
    by_hand: int = 0
    put_back: int = 0
    after: dict[str, int] = field(default_factory=dict)

    @property
    def wrong(self) -> dict[str, list[str]]:
        """The sentences, by what they are about."""
        kinds = {"lost": self.lost, "doubled": self.doubled, "dropped": self.dropped}
        return {**kinds, "moved by itself": self.moved}

    @property
    def ok(self) -> bool:
        return not any(self.wrong.values())


WENT_ON, HELD, FAILED, AGAIN = "went on", "held", "failed", "killed again"


def judge(
    rows: Sequence[TaskRow],
    deeds: Sequence[Deed],
    kills: Sequence[Kill],
    acts: Sequence[Said],
    *,
    accepted: Mapping[str, str],
    ends: Mapping[str, str],
    last: Kill,
) -> Verdict:
    """Hold the history against the customers' books and the boards' deeds.

    `last`: the start after the last kill, which was not killed.
    """
    verdict, known = Verdict(), {row.id: row for row in rows}
    for id, text in accepted.items():
        verdict.lost += _lost(id, text, known.get(id), ends.get(id))
    _follow_parts(verdict, rows, deeds, acts)
    _follow_moves(verdict, rows, [*kills, last][1:], deeds, acts)
    for number, kill in enumerate(kills):
        until = kills[number + 1].killed_at if number + 1 < len(kills) else float("inf")
        again = kills[number + 1].running if number + 1 < len(kills) else frozenset()
        for id in kill.running:
            became = _became(known.get(id), kill.killed_at, until, acts, again=id in again)
            verdict.after[became] = verdict.after.get(became, 0) + 1
    return verdict


def _lost(id: str, text: str, row: TaskRow | None, end: str | None) -> list[str]:
    if row is None:
        return [f"{id} ({text}) was accepted and is not in the history"]
    if row.text != text:
        return [f"{id} was accepted as '{text}' and kept as '{row.text}'"]
    if row.ended_s is None:
        return [f"{id} ({text}) was accepted and never ended: it is {row.state}"]
    if end is not None and end != row.state:
        return [f"{id} ({text}) was said to be {end} and was kept as {row.state}"]
    return []


def _follow_parts(
    verdict: Verdict, rows: Sequence[TaskRow], deeds: Sequence[Deed], acts: Sequence[Said]
) -> None:
    """Follow each part that an arm took up to where it let it go."""
    picks: Counter[str] = Counter()
    places: Counter[str] = Counter()
    carried: dict[str, str] = {}  # by robot, the task whose part it took up last
    for deed in deeds:
        row = _at_work(rows, deed)
        if deed.did is Did.PICKED:
            if row is None or not deed.what.startswith(PICK_UP) or deed.what.endswith(ALONE):
                verdict.doubled.append(f"{deed.robot} took up a part at {deed.what}: {_whose(row)}")
            else:
                picks[row.id] += 1
                carried[deed.robot] = row.id
        elif deed.did is Did.LET_GO:
            if row is not None and deed.what == _station(row):
                places[row.id] += 1
            elif deed.what.startswith(PICK_UP) and not deed.what.endswith(ALONE):
                verdict.put_back += 1
                picks[carried.pop(deed.robot, "")] -= 1
            elif _by_hand(deed, acts):
                verdict.by_hand += 1
            else:
                verdict.dropped.append(f"{deed.robot} let a part go at {deed.what}: {_whose(row)}")
    for row in rows:
        for what, done in (("took up", picks[row.id]), ("set down", places[row.id])):
            if done > 1:
                verdict.doubled.append(f"{row.id} ({row.text}): the arm {what} {done} parts")
            if row.state == "done" and not done:
                verdict.lost.append(f"{row.id} ({row.text}) is kept as done, and the arm {what} no part")


def _follow_moves(
    verdict: Verdict,
    rows: Sequence[TaskRow],
    starts: Sequence[Kill],
    deeds: Sequence[Deed],
    acts: Sequence[Said],
) -> None:
    """A robot is told something only for a verb said of its cell since the start, or a task taken since."""
    moves = sorted((deed for deed in deeds if deed.did is Did.WAS_TOLD), key=_at)
    for start in starts:
        began = start.started_at
        since, until = (bisect_left(moves, at, key=_at) for at in (start.joined_at, start.killed_at))
        for deed in moves[since:until]:
            row = _at_work(rows, deed)
            is_accepted_since = row is not None and row.accepted_s >= began
            if not is_accepted_since and not any(
                began <= each.at <= deed.at and each.cell == deed.cell for each in acts
            ):
                verdict.moved.append(
                    f"{deed.robot} was told a {deed.what} before anybody let {deed.cell} go on"
                )


def _became(row: TaskRow | None, killed_at: float, until: float, acts: Sequence[Said], *, again: bool) -> str:
    """The end of a task that a kill left at work, as far as it got before the next kill."""
    if row is None:
        return "lost"
    end = until if row.ended_s is None else min(row.ended_s, until)
    verbs = {each.verb for each in acts if each.cell == row.cell and killed_at < each.at <= end}
    if (
        row.reason == Reason.INTERRUPTED.value
        and row.ended_s is not None
        and row.ended_s <= until
        and not verbs
    ):
        return FAILED
    if verbs - {Verb.RESUME.value}:
        return HELD
    return AGAIN if again else WENT_ON if row.state == "done" else FAILED


def _at_work(rows: Iterable[TaskRow], deed: Deed) -> TaskRow | None:
    """The task of the cell that was at work then."""
    for row in rows:
        ended_s = float("inf") if row.ended_s is None else row.ended_s
        if row.cell == deed.cell and row.started_s is not None and row.started_s <= deed.at <= ended_s:
            return row
    return None


def _at(deed: Deed) -> float:
    return deed.at


def _whose(row: TaskRow | None) -> str:
    return f"at work was {row.id} ({row.text})" if row else "no task was at work"


def _station(row: TaskRow) -> str:
    return STATION + row.text.split()[2]


def _by_hand(deed: Deed, acts: Sequence[Said]) -> bool:
    return any(each.cell == deed.cell and each.drops and 0 <= deed.at - each.at < BY_HAND_S for each in acts)
