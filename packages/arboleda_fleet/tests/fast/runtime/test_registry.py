"""The part that keeps the lead is needed."""

from __future__ import annotations

from arboleda_fleet import factories as standby


def test_the_part_that_keeps_the_lead_is_needed() -> None:
    (kept,) = (each for each in standby.FACTORIES if each.make is standby.lease)
    assert kept.is_needed
