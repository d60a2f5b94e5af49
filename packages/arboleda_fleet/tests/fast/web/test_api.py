"""Figures of the OEE over HTTP."""

from __future__ import annotations

from arboleda_fleet.oee.api import OeeApi, OeeQuery


def test_the_oee_is_told_with_what_is_missing_of_it(web, plant):
    plant.offered[OeeApi] = plant
    (row,) = web.get("/api/oee?cell=sis_a&since=5&until=9.5").json()
    assert plant.oee_queries == [OeeQuery(cell="sis_a", since_s=5, until_s=9.5)]
    assert (row["availability"], row["quality"], row["performance"], row["oee"]) == (1.0, 0.0, None, None)
    assert row["missing"].startswith("0 of 1 tasks can be compared")
