"""Which tests run: no test is lost or run twice by several workers; `--about WORD`, `--one-in N`."""

from __future__ import annotations

from itertools import chain
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ..dealing import dealt, share
from ..shared import about, one_in

GROUPS = st.lists(st.integers(1, 9), max_size=9)


@given(sizes=GROUPS, others=st.integers(0, 40), workers=st.integers(1, 6))
def test_every_test_is_dealt_once_and_groups_stay_together(
    sizes: list[int], others: int, workers: int
) -> None:
    groups = [[(group, n) for n in range(size)] for group, size in enumerate(sizes)]
    computing = [("other", n) for n in range(others)]
    order = list(dealt(groups, computing, workers))
    assert sorted(map(str, order)) == sorted(map(str, [*chain(*groups), *computing]))
    for group in groups:
        begin = order.index(group[0])
        assert order[begin : begin + len(group)] == group


@given(count=st.integers(0, 40), workers=st.integers(1, 6))
def test_the_shares_of_all_workers_are_all_items_once(count: int, workers: int) -> None:
    items = range(count)
    shares = [share(items, number, workers) for number in range(workers)]
    assert list(chain(*shares)) == list(items)
    assert max(map(len, shares)) - min(map(len, shares)) <= 1


@pytest.mark.parametrize(
    ("test", "is_wanted"),
    [
        ("packages/arboleda_drivers/tests/fast/ur/test_ur_machine.py::test_a_stop", True),
        ("packages/arboleda_drivers/tests/real/contract/test_drivers.py::test_reject[ur]", True),
        ("packages/arboleda_drivers/tests/fast/ur/test_x.py::test_y", True),
        ("tests/unit/core/test_x.py::test_what_is_measured_during_a_course", False),
        ("packages/arboleda_drivers/tests/real/contract/test_drivers.py::test_reject[dobot]", False),
    ],
)
def test_a_whole_word_in_the_name_of_file_test_or_case(test: str, is_wanted: bool) -> None:
    item: Any = SimpleNamespace(nodeid=test)
    assert about("ur", [item]) == [item] * is_wanted


def test_a_sample_has_some_of_every_file() -> None:
    items: Any = [
        SimpleNamespace(path=Path(file), nodeid=f"{file}::{number}")
        for file, tests in (("a.py", 5), ("b.py", 1), ("c.py", 3))
        for number in range(tests)
    ]
    assert [item.nodeid for item in one_in(3, items)] == ["a.py::0", "a.py::3", "b.py::0", "c.py::0"]
    assert one_in(1, items) == items
