"""No test is lost or run twice by the order that several workers share."""

from __future__ import annotations

from itertools import chain

from hypothesis import given
from hypothesis import strategies as st

from ..dealing import dealt, share

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
