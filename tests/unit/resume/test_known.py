"""Which commands explain what a board says it has taken, and which do not."""

from __future__ import annotations

import pytest

from arboleda.model.messages import Receipt
from arboleda.resume.trail import Knowledge

BRIDGE, LATER = 1001, 1004


@pytest.mark.parametrize(
    ("before", "more", "now", "explained"),
    [
        (None, 0, None, True),
        (None, 1, Receipt(BRIDGE, 1), True),
        (None, 1, Receipt(BRIDGE, 2), False),
        (None, 1, Receipt(LATER, 1), False),  # given by a start of which nothing is left
        (Receipt(BRIDGE, 3), 0, Receipt(BRIDGE, 3), True),
        (Receipt(BRIDGE, 3), 1, Receipt(BRIDGE, 4), True),
        (Receipt(BRIDGE, 3), 1, Receipt(BRIDGE, 5), False),
        (Receipt(BRIDGE, 3), 1, Receipt(LATER, 1), False),
        (Receipt(900, 3), 1, Receipt(BRIDGE, 1), True),  # the first one by this start of the bridge
        (Receipt(900, 3), 1, Receipt(900, 4), True),  # a board that has heard a higher epoch keeps it
        (Receipt(BRIDGE, 3), 1, None, False),
    ],
)
def test_only_commands_that_were_under_way_by_the_same_bridge_explain_it(
    before: Receipt | None, more: int, now: Receipt | None, explained: bool
) -> None:
    assert Knowledge(boot=1, receipt=before, more=more, bridge=BRIDGE).explains(now) is explained
