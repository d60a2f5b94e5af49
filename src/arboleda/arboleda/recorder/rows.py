"""Conversion of a snapshot to rows, few of which change from one to the next, and back.

Spans are kept as the moments on the plant's clock that they are counted from or to: a moment stays, where a
span is another one at each look. Where robots are, and when they spoke, is in the rows of `motion`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from .motion import key_of
from .plain_data import value_from

Row = dict[str, Any]
Rows = dict[str, Row]
TABLES = {
    "cells": "name",
    "robots": "name",
    "tasks": "id",
    "zones": "zone",
    "acts": "number",
    "interference": "number",
    "faults": "number",
}
WHOLE = ("zones", "acts", "interference", "faults")  # whose rows are kept as they are
SPANS = {"age_s": -1, "since_s": -1, "deadline_s": 1, "left_s": 1}
DRAWN = ("homed", "reports", "going_since", "reached")  # of a robot in the twin, and in no snapshot
ELSEWHERE = ("age_s", "q", "node")  # fields of a robot that are in the rows of `motion`
PLANT, ORDER, LINKS = "plant", "order", "links"


def rows_of(snapshot: Row, drawn: Row) -> Iterator[tuple[str, Row]]:
    """The key and row of each part of a snapshot, and of the twin's positions at that moment."""
    at = snapshot["at"]
    yield PLANT, {key: value for key, value in snapshot.items() if key not in TABLES and key != "at"}
    yield ORDER, {table: [row[key] for row in snapshot[table]] for table, key in TABLES.items()}
    for cell in snapshot["cells"]:
        name, task, tree = cell["name"], cell["task"], cell["tree"]
        yield f"cells/{name}", {**cell, "task": task and task["id"], "tree": [node["path"] for node in tree]}
        for node in tree:
            yield f"tree/{name}/{node['path']}", _moments(node, at)
    for robot in snapshot["robots"]:
        yield f"robots/{robot['name']}", _robot(robot, at)
    for task in snapshot["tasks"]:
        yield f"tasks/{task['id']}", {key: value for key, value in task.items() if key != "elapsed_s"}
    for table in WHOLE:
        for row in snapshot[table]:
            yield f"{table}/{row[TABLES[table]]}", row
    for robot in drawn["robots"]:
        yield f"drawn/{robot['name']}", {key: robot[key] for key in DRAWN}
    for name, part in drawn["parts"].items():
        yield f"parts/{name}", {"part": part, "books": drawn["books"][name]}


def snapshot_of(rows: Rows, at: float) -> Row:
    """The snapshot made of these rows, with its spans as of `at` on the plant's clock."""
    order = rows[ORDER]
    tasks = {id: _task(_row(rows, f"tasks/{id}"), at) for id in order["tasks"]}
    return {
        **_row(rows, PLANT),
        "at": at,
        "cells": [_cell(rows, name, tasks, at) for name in order["cells"]],
        "robots": [_robot_at(rows, name, at) for name in order["robots"]],
        "tasks": list(tasks.values()),
        **{table: [_row(rows, f"{table}/{id}") for id in order.get(table, ())] for table in WHOLE},
    }


def positions_of(rows: Rows, at: float) -> Row:
    """The twin's positions made of these rows, as of `at`."""
    order = rows[ORDER]
    cells = {name: _row(rows, f"parts/{name}") for name in order["cells"]}
    return {
        "now": at,
        "robots": [_drawn(rows, name, at) for name in order["robots"]],
        "parts": {name: row["part"] for name, row in cells.items()},
        "books": {name: _books(row) for name, row in cells.items()},
        "zones": [_row(rows, f"zones/{name}") for name in order["zones"]],
    }


def _books(row: Row) -> Row:
    """The books of a cell; a record of version 0.1 has the numbers of its full stations."""
    stations = {f"station_{number}": 1 for number in row.get("stored", ())}
    books = row.get("books", {"places": {}, "carriers": {}})
    return {**books, "places": stations | books["places"]}


def links_of(rows: Rows) -> Row:
    """The row of the plant's links; empty if there is none yet."""
    return _row(rows, LINKS) if LINKS in rows else {}


def _moments(row: Row, at: float) -> Row:
    """The spans of a row as moments, to a tenth of a second: parts of a snapshot differ by less."""
    return {
        key: round(at + SPANS[key] * value, 1) if key in SPANS and value is not None else value
        for key, value in row.items()
    }


def _spans(row: Row, at: float) -> Row:
    return {
        key: round(SPANS[key] * (value - at), 3) if key in SPANS and value is not None else value
        for key, value in row.items()
    }


def _robot(robot: Row, at: float) -> Row:
    row = {key: value for key, value in robot.items() if key not in ELSEWHERE}
    rate = row["telemetry_hz"]
    inner = {key: row[key] and _moments(row[key], at) for key in ("command", "question")}
    return {**row, **inner, "telemetry_hz": rate and round(rate, 1)}


def _robot_at(rows: Rows, name: str, at: float) -> Row:
    row, motion = _row(rows, f"robots/{name}"), _motion(rows, name, at)
    inner = {key: row[key] and _spans(row[key], at) for key in ("command", "question")}
    heard_at = motion["heard_at"]
    age_s = None if heard_at is None else round(at - heard_at, 3)
    return {**row, **inner, "age_s": age_s, "q": motion["q"], "node": motion["node"]}


def _drawn(rows: Rows, name: str, at: float) -> Row:
    robot = _row(rows, f"robots/{name}")
    fields = {key: robot[key] for key in ("name", "online", "goal")}
    return {**fields, **_motion(rows, name, at), **_row(rows, f"drawn/{name}")}


def _motion(rows: Rows, name: str, at: float) -> Row:
    row = _row(rows, key_of(name))
    times = {key: at if key in row["fresh"] else row[key] for key in ("heard_at", "position_at")}
    return {"q": row["q"], "node": row["node"], **times}


def _cell(rows: Rows, name: str, tasks: Mapping[str, Row], at: float) -> Row:
    row = _row(rows, f"cells/{name}")
    tree = [_spans(_row(rows, f"tree/{name}/{path}"), at) for path in row["tree"]]
    return {**row, "task": row["task"] and tasks[row["task"]], "tree": tree}


def _task(row: Row, at: float) -> Row:
    started, ended = row["started_at"], row["ended_at"]
    elapsed_s = None if started is None else (at if ended is None else ended) - started
    return {**row, "elapsed_s": elapsed_s}


def _row(rows: Rows, key: str) -> Row:
    row: Row = value_from(rows[key])
    return row
