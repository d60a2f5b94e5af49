"""Methods that this package adds to the client of a plant, against its routes and a plant in this process."""

from __future__ import annotations

import json

import pytest
from tests.client_methods import differences, left, methods_of, routes_of_package
from tests.guarded_plant import guarded
from tests.in_process import ORIGIN, Machine
from tests.in_process import machine as machine
from tests.web_plant import Plant
from tests.web_plant import plant as plant

from arboleda.client import NotFound
from arboleda.client import Plant as Client
from arboleda_proofs.client import Proofs
from arboleda_proofs.running.api import ReportsApi

ROUTES = routes_of_package("proofs")
METHODS = methods_of(Proofs)


@pytest.fixture
def client(machine: Machine, plant: Plant) -> Client:
    plant.offered[ReportsApi] = plant
    machine.listen(8080, guarded(plant).app)
    return Client(ORIGIN, patience_s=0.0)


def test_every_route_has_a_method_that_takes_and_returns_the_same() -> None:
    assert left(ROUTES, METHODS) == set()
    assert differences(ROUTES, METHODS) == []


def test_the_report_of_a_task_is_waited_for(client: Client, plant: Plant) -> None:
    said = {"sentence": "ra1 was late", "key": "late", "values": {"robot": "ra1"}}
    evidence = {"troubles": [], "last_command": None, "acts": [], "foreign": []}
    facts = {
        "task": "lot",
        "text": "",
        "cell": "sis_a",
        "ended_s": 1.0,
        "reason": "deadline",
        "failure": said,
    }
    facts["cause"] = said | {"kind": "unended", "robot": "ra1"}
    facts["evidence"] = evidence | {"absences": [{"at_s": -1.0, "seconds": 0.5}]}
    page = '<script type="application/json" id="data">{}</script>'
    plant.reports = iter([None, page.replace("{}", json.dumps({"scene": {}, "facts": facts})), page])
    report = client.report("lot")
    assert report.state == "written" and report.cause and report.cause.kind == "unended"
    assert report.evidence and report.evidence.absences[0].seconds == 0.5
    with pytest.raises(NotFound, match="an earlier version"):
        client.report("lot")
