"""The table of a plant's tasks."""

from __future__ import annotations

import json
from collections.abc import Sequence

from arboleda.model.messages import TaskAnswer, TaskChanged, TaskState, outlives_power

from .rows import Rows, Statement
from .task_rows import (
    TaskQuery,
    TaskRow,
    choice_written,
    course_written,
    selection,
    to_row,
    unchecked_written,
)

MOST_MOVED = 1000  # ended tasks whose times follow the clock: of more the plant would have to wait
PRUNED = 20  # ended tasks forgotten with each new end: more than come in, and quickly done


class TaskTable:
    """The tasks of a plant, from their acceptance until they are forgotten.

    The age of an ended task is the time that the plant has run since, over all of its starts: a wall clock
    may be wrong for a while, and would have tasks of today forgotten.
    """

    def __init__(self, rows: Rows) -> None:
        self._rows = rows

    def keep(
        self,
        change: TaskChanged,
        recipe: str,
        unix_s: float,
        asked_by: str | None = None,
        answers: Sequence[TaskAnswer] = (),
        ran_s: float = 0.0,
    ) -> None:
        """Commit one change of a task; what is known already, as when it is asked for again, stays.

        `answers` and `ran_s`, the time that the plant has run so far, are kept with its end.
        """
        state, durable = change.state, outlives_power(change)
        if state is TaskState.QUEUED:
            words = (change.task, change.text, change.cell, recipe, state.value)
            row = (*words, unix_s, asked_by, choice_written(change.choice))
            columns = "id, text, cell, recipe, state, accepted_s, asked_by, choice"
            values = ", ".join("?" * len(row))
            insert = f"INSERT INTO task ({columns}) VALUES ({values}) ON CONFLICT (id) DO NOTHING"
            self._rows.write((insert, row), durable=durable)
        elif state is TaskState.RUNNING:
            begin = (
                "UPDATE task SET state = ?, started_s = ?, attempts = 1 WHERE id = ? AND started_s IS NULL"
            )
            self._rows.write((begin, (state.value, unix_s, change.task)), durable=durable)
        elif state is not TaskState.REFUSED:
            sentence_json = json.dumps(change.sentence.data(), ensure_ascii=False)
            reason = None if change.reason is None else change.reason.value
            # the clock of an earlier start, which began the task, may have been ahead
            end_s = "CASE WHEN started_s > ? THEN started_s ELSE ? END"
            end = (
                f"UPDATE task SET state = ?, reason = ?, sentence = ?, said = ?, ended_s = {end_s},"
                " answers = ?, course = ?, unchecked = ?, ran_s = ? WHERE id = ? AND ended_s IS NULL"
            )
            answers_json = (
                json.dumps([vars(each) for each in answers], ensure_ascii=False) if answers else None
            )
            how, unchecked = course_written(change.course), unchecked_written(change.unchecked)
            outcome = (state.value, reason, str(change.sentence), sentence_json, unix_s, unix_s)
            said = (*outcome, answers_json, how, unchecked, ran_s)
            self._rows.write((end, (*said, change.task)), durable=durable)

    def attempted(self, task: str, attempts: int) -> None:
        """Commit the number of times that a task was begun."""
        self._rows.write(("UPDATE task SET attempts = ? WHERE id = ?", (attempts, task)), durable=False)

    def ran_s(self) -> float:
        """The time that the plant had run when its last task ended, s."""
        ((last_s,),) = self._rows.read("SELECT max(ran_s) FROM task")
        return last_s or 0.0

    def moved(self, by_s: float, since_ran_s: float, began_s: float, until_s: float) -> Statement:
        """The statement that moves the times of open tasks, and the last that ended after `since_ran_s`.

        Only times between `began_s` and `until_s` are of the start whose clock was set.
        """
        ended = "SELECT number FROM task WHERE ran_s > ? ORDER BY ran_s DESC LIMIT ?"
        moves = ", ".join(
            f"{each} = {each} + CASE WHEN {each} BETWEEN ? AND ? THEN ? ELSE 0 END"
            for each in ("accepted_s", "started_s", "ended_s")
        )
        move = f"UPDATE task SET {moves} WHERE (ended_s IS NULL OR number IN ({ended}))"
        return move, (*(began_s, until_s, by_s) * 3, since_ran_s, MOST_MOVED)

    def forget(self, before_ran_s: float) -> None:
        """Forget the oldest tasks that ended before the plant had run for so long, at most PRUNED of them."""
        oldest = "SELECT number FROM task WHERE ran_s < ? ORDER BY ran_s, number LIMIT ?"
        delete = f"DELETE FROM task WHERE number IN ({oldest})"
        self._rows.write((delete, (before_ran_s, PRUNED)), durable=False)

    def select(self, query: TaskQuery) -> list[TaskRow]:
        """The tasks that a query asks for, the last accepted first."""
        statement, values = selection(query)
        return [to_row(row) for row in self._rows.read(statement, *values)]
