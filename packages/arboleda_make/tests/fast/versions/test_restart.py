"""Changes of a plant's files that need a restart, and the reasons."""

from __future__ import annotations

from typing import Any

import pytest

from arboleda.model.plant_files import PlantFiles
from arboleda_make.versions.changes import changes
from arboleda_make.versions.restart import needing_restart

BEFORE = """\
name: a
uses: [tend.xml, own.py]
timing: {dwell_s: 1}
zones: {mesa: {poses: [lab nest]}}
cells:
  lab:
    devices: {loader: {kind: arm}}
    targets: {nest: {loader: {deg: [1]}}}
    queue_limit: 5
"""


def told(before: str, after: str, **others: tuple[bytes, bytes]) -> tuple[str, ...]:
    assert before == after == "" or before in BEFORE
    text = BEFORE.replace(before, after) if before else BEFORE
    files = [{name: pair[side] for name, pair in others.items()} for side in (0, 1)]
    sides = [
        PlantFiles(plant="plant.yaml", contents={"plant.yaml": each.encode(), **files[side]})
        for side, each in enumerate((BEFORE, text))
    ]
    return needing_restart(changes(*sides))


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("deg: [1]", "deg: [2]"),
        ("dwell_s: 1", "dwell_s: 2"),
        ("timing: {dwell_s: 1}\n", ""),
        ("queue_limit: 5", "queue_limit: 6"),
        ("queue_limit: 5", "retry: {times: 2}"),
        ("[tend.xml, own.py]", "[tend.xml, own.py, more.xml]"),
        ("name: a\n", "name: a\nhistory_days: 3\n"),
    ],
)
def test_a_plant_that_runs_takes_it(before: str, after: str) -> None:
    assert told(before, after) == ()


@pytest.mark.parametrize(
    ("before", "after", "why"),
    [
        ("dwell_s: 1", "stale_after_s: 2", "watch their links"),
        ("timing: {dwell_s: 1}\n", "timing: {dwell_s: 1, stale_after_s: 2}\n", "watch their links"),
        ("kind: arm", "kind: scara", "a device and its driver"),
        ("queue_limit: 5", "places: {nest: {holds: 2}}", "which parts lie where"),
        ("queue_limit: 5", "needs: {}", "is checked from the start"),
        ("[lab nest]", "[lab home]", "who is in a zone"),
        ("name: a\n", "name: a\nextensions: {orders: {most: 3}}\n", "a package gets its settings"),
        ("name: a", "name: b", "reads it when it starts"),
        ("[tend.xml, own.py]", "[tend.xml]", "Python is not imported again"),
        ("cells:\n", "cells:\n  other: {queue_limit: 1}\n", "a cell joins the plant"),
    ],
)
def test_it_needs_a_restart_with_a_reason(before: str, after: str, why: str) -> None:
    assert any(why in line for line in told(before, after))


@pytest.mark.parametrize(("name", "needs"), [("tend.xml", False), ("own.py", True), ("arm.urdf", True)])
def test_of_files_trees_alone_are_taken(name: str, needs: Any) -> None:
    pair = (b"<root BTCPP_format='4'/>", b"<root BTCPP_format='4' a='b'/>")
    assert bool(told("", "", **{name: pair})) is needs


def test_a_change_of_python_is_named_without_its_content() -> None:
    sides = [
        PlantFiles(plant="plant.yaml", contents={"plant.yaml": BEFORE.encode(), "own.py": each})
        for each in (b"secret = 1", b"secret = 2")
    ]
    assert [each.words for each in changes(*sides)] == ["own.py: changed"]
