"""The lines in which a plant that runs tells of tasks, acts of operators and defects."""

from __future__ import annotations

import logging

from arboleda.model.messages import (
    Journal,
    OperatorAnswer,
    Outcome,
    RevisionAnswer,
    TaskChanged,
    TaskState,
)
from arboleda.model.sentence import Phrase, Sentence

LOG = logging.getLogger(__name__)
TASKS = logging.getLogger("arboleda.tasks")
REQUESTS = logging.getLogger("arboleda.requests")  # those that were refused
OPERATORS = logging.getLogger("arboleda.operators")

IN_CELL = Phrase("act.in_cell", "{did} ({cell})")
VERB_REFUSED = Phrase("act.verb_refused", "{verb} {scope} was refused: {why}")

Durable = TaskChanged | OperatorAnswer | RevisionAnswer
"""Messages that are told once all that led to them is durable."""


def log_defect(where: str, error: Exception) -> None:
    """Log a defect: one line for people, and the whole error with its traceback for the log file."""
    LOG.error("internal error in %s (%s: %s)", where, type(error).__name__, error)
    LOG.debug("the error in %s, whole", where, exc_info=error)


def task_line(change: TaskChanged) -> str:
    """The line on a change of a task."""
    why = f"  {change.sentence}" if change.sentence else ""
    return f"{change.state.value:<9} {change.text}{why}" + (
        f" ({change.reason.value})" if change.reason else ""
    )


def act_line(act: Journal) -> Sentence:
    """The line on an operator's act or its outcome, with the cell if no sentence names it."""
    return act.sentence if act.cell in (None, act.scope) else IN_CELL(did=act.sentence, cell=act.cell)


def log_act(act: Journal) -> None:
    level = logging.WARNING if act.outcome is Outcome.FAILED else logging.INFO
    line = act_line(act)
    OPERATORS.log(level, "%s", line, extra={"sentence": line})


def log_answer(message: Durable) -> None:
    """Log each change of a task, and refusals; `change` is for screens that show it in colours, `sentence`
    for those that say it in another language."""
    if isinstance(message, RevisionAnswer):
        if message.refusal is not None:
            OPERATORS.warning("%s", message.refusal, extra={"sentence": message.refusal})
    elif isinstance(message, OperatorAnswer):
        if message.refusal is not None:
            line = VERB_REFUSED(verb=message.verb.value, scope=message.scope or "plant", why=message.refusal)
            OPERATORS.info("%s", line, extra={"sentence": line})
    elif message.state is TaskState.REFUSED:
        REQUESTS.warning("%s", task_line(message), extra={"change": message})
    else:
        level = logging.WARNING if message.state is TaskState.FAILED else logging.INFO
        TASKS.log(level, "%s", task_line(message), extra={"change": message})
