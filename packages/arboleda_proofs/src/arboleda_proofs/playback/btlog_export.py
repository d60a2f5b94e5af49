"""A task of a record as `.btlog`, for viewers of BehaviorTree.CPP."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from arboleda.drivers import plain
from arboleda.extension import ConfigError
from arboleda.host.packages import extra
from arboleda.model.messages import ENDED, TaskState
from arboleda.model.packages import TREES
from arboleda.recorder.reader import Record

from .cell_history import followed
from .views import Views

LATER_NS = 2 * 10**9  # screens see a change a little later
Change = tuple[int, dict[str, Any]]
OVER = {state.value for state in ENDED}


def write(record: Record, task: str, output: Path) -> int:
    """Write a task's `.btlog` and return its size; ConfigError if the record has no tree of such a task."""
    changes = list(_changes(record, task))
    if not changes:
        raise ConfigError((f"{plain(task, 80)}: {record.paths[0]} has no such task",))
    moments = list(_moments(record, changes))
    if not any(rows for _, rows in moments):
        raise ConfigError((f"{plain(task, 80)}: it did not run in {record.paths[0]}",))
    content: bytes = extra("btlog_content", TREES, str(output))(
        moments, has_succeeded=changes[-1][1]["state"] == TaskState.DONE.value
    )
    try:
        with open(output, "xb") as file:
            file.write(content)
    except FileExistsError:
        raise ConfigError((f"{output} is there already: name another file",)) from None
    except OSError as error:
        raise ConfigError((f"{output}: cannot be written: {error.strerror}",)) from error
    return len(content)


def _moments(record: Record, changes: Sequence[Change]) -> Iterator[tuple[int, Sequence[dict[str, Any]]]]:
    """The task's tree at each of its changes, and once more without rows at its end."""
    views, was_mine = Views(record), False
    (began_ns, first), (ended_ns, last) = changes[0], changes[-1]
    until_ns = ended_ns + LATER_NS if last["state"] in OVER else views.ended_ns
    for look in followed(views, first["cell"], began_ns - LATER_NS, until_ns):
        is_mine = look.cell["task"] is not None and look.cell["task"]["id"] == first["task"]
        if is_mine or was_mine:
            yield look.unix_ns // 1000, look.cell["tree"] if is_mine else []
        was_mine = is_mine


def _changes(record: Record, task: str) -> Iterator[Change]:
    """The changes of a task, each with its time."""
    word = f'"task":{json.dumps(task)}'.encode()
    for unix_ns, data in record.raw():
        if b'"TaskChanged"' in data and word in data:
            for row in json.loads(data)["messages"]:
                if row["type"] == "TaskChanged" and row["task"] == task:
                    yield unix_ns, row
