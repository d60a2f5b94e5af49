"""Figures of the OEE over HTTP."""

from __future__ import annotations

import pytest
from tests.client_methods import routes_of_package
from tests.unit.web.test_who_may import assert_for, of_package

from arboleda_fleet.oee.api import OeeApi, OeeQuery


def test_the_oee_is_told_with_what_is_missing_of_it(web, plant):
    plant.offered[OeeApi] = plant
    (row,) = web.get("/api/oee?cell=sis_a&since=5&until=9.5").json()
    assert plant.oee_queries == [OeeQuery(cell="sis_a", since_s=5, until_s=9.5)]
    assert (row["availability"], row["quality"], row["performance"], row["oee"]) == (1.0, 0.0, None, None)
    assert row["missing"].startswith("0 of 1 tasks can be compared")


@pytest.mark.parametrize(
    ("query", "sentence"),
    [
        ("since=monday", "'since' is 'monday': input should be a valid number"),
        ("since=nan", "'since' is 'nan': input should be a finite number"),
        ("state=done", "'state' is nothing to ask for; there are cell, since, until."),
    ],
)
def test_a_wrong_time_of_the_oee_is_refused(web, plant, query, sentence):
    answer = web.get(f"/api/oee?{query}")
    assert answer.status_code == 422 and answer.json()["sentence"].startswith(sentence)
    assert plant.oee_queries == []


def test_there_is_no_other_route_and_everybody_may_ask_it(tmp_path, monkeypatch):
    assert set(routes_of_package("fleet")) == {"GET /api/oee"}
    assert_for(of_package("arboleda_fleet", tmp_path, monkeypatch))
