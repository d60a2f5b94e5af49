from __future__ import annotations

import json
from typing import Any, ClassVar

import pytest
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.model.messages import MotionState, OperatorRequest, Verb
from arboleda.model.plant_model import Evidence
from arboleda.model.sentence import in_json
from arboleda.testing import Rig, shipped
from arboleda.testing.storage_layout import StorageLayout
from arboleda.views import tree_view, view

from ..core.conftest import Hand


@pytest.fixture
def rig() -> Rig:
    rig = Rig(shipped())
    rig.wait(0.5)
    return rig


def row(snapshot: dict[str, Any], name: str) -> dict[str, Any]:
    return next(node for node in snapshot["cells"][0]["tree"] if str(node["name"]) == name)


def robot(snapshot: dict[str, Any], name: str) -> dict[str, Any]:
    return next(robot for robot in snapshot["robots"] if robot["name"] == name)


def test_a_snapshot_is_plain_json(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    assert json.loads(json.dumps(rig.snapshot(), default=in_json))["plant"] == "arboleda"


def test_a_node_says_its_kind(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    kinds = {str(node["name"]): node["kind"] for node in rig.snapshot()["cells"][0]["tree"]}
    assert kinds["storage"] == "selector" and kinds["main"] == "sequence"
    assert kinds["move to pick-up"] == "command" and kinds["dwell"] == "dwell" and kinds["settle"] == "await"
    assert kinds["holds nothing"] == "condition" and kinds["announce"] == "notice"


def test_a_running_command_says_what_it_was_sent_with_and_how_long_it_has_left(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    rig.wait(0.25)
    move = row(rig.snapshot(), "move to pick-up")
    assert (
        move["parameters"]["robot"] == "ra1"
        and move["parameters"]["q"] == StorageLayout(rig.plant.model.cells[0]).pickup.q
    )
    assert move["since_s"] == pytest.approx(0.25, abs=0.06)
    assert move["since_s"] + move["deadline_s"] == pytest.approx(10.0)  # timeout_s of an arm


def test_a_task_that_failed_says_in_which_leaf(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.submit("sis_a 0B 3")
    rig.wait_for("sis_a", "drive path 0B")
    path = row(rig.snapshot(), "drive path 0B")["path"]
    rig.lost = lambda publication: publication.topic == "rm_sis_a/sensores"
    rig.wait(9.0)
    assert [task["failed_in"] for task in rig.snapshot()["tasks"]] == [path, None]


def test_a_dwell_says_how_long_it_has_left(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait(0.12)
    dwell = row(rig.snapshot(), "dwell")
    assert dwell["since_s"] > 0 and dwell["since_s"] + dwell["deadline_s"] == pytest.approx(0.2)


def test_a_dwell_that_is_held_after_its_time_has_none_left(rig: Rig) -> None:
    """The plant was frozen, and the first that it hears then is that it shall hold."""
    rig.submit("sis_a 0B 7")
    rig.wait(0.1)
    rig.plant.step(rig.now + 1.0, [OperatorRequest(verb=Verb.HOLD, scope="sis_a", at=rig.now)])
    dwell = row(rig.snapshot(), "dwell")
    assert dwell["since_s"] > 1.0 and dwell["deadline_s"] == 0.0


def test_a_node_that_does_not_run_has_no_times(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rest = [node for node in rig.snapshot()["cells"][0]["tree"] if node["status"] != "RUNNING"]
    assert {(node["since_s"], node["deadline_s"]) for node in rest} == {(None, None)}


def test_a_failed_node_keeps_its_sentence(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "drive path 0B")
    rig.lost = lambda publication: publication.topic == "rm_sis_a/sensores"
    assert rig.wait(9.0, until=lambda: str(rig.snapshot()["cells"][0]["step"]).startswith("recovery"))
    assert "no telemetry" in str(row(rig.snapshot(), "drive path 0B")["failure"])


def test_a_node_of_a_users_own_is_described_by_its_docstring() -> None:
    class Polish(Behaviour):
        """Polish the part.

        Twice.
        """

        parameters: ClassVar = {"cloth": 3}

        def update(self) -> Status:
            return Status.RUNNING

    (polish,) = tree_view.rows(Polish("polish"), now=0.0)
    assert (polish["kind"], polish["description"], polish["parameters"]) == (
        "step",
        "Polish the part.",
        {"cloth": "3"},
    )


def test_a_robot_says_its_last_command_and_what_became_of_it(rig: Rig) -> None:
    assert robot(rig.snapshot(), "ra1")["command"] is None
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    mobile, arm = (robot(rig.snapshot(), name)["command"] for name in ("rm_sis_a", "ra1"))
    assert (str(mobile["what"]), mobile["state"]) == ("driving path 0B", "done")
    assert (str(arm["what"]), arm["state"], arm["age_s"]) == ("moving to pick-up", "running", 0.0)


def test_a_robot_says_how_often_it_reports(rig: Rig) -> None:
    assert robot(rig.snapshot(), "ra1")["telemetry_hz"] is None
    rig.wait(5.0)
    assert robot(rig.snapshot(), "ra1")["telemetry_hz"] == pytest.approx(10.0, abs=0.5)
    rig.lost = lambda publication: publication.topic == "ra_1/sensores"
    rig.wait(5.0)
    assert robot(rig.snapshot(), "ra1")["telemetry_hz"] is None


def test_refused_commands_are_counted_with_the_last_reason() -> None:
    plant = Hand(shipped(evidence=Evidence.IDS))
    plant.awake()
    plant.submit("sis_a 0B 7")
    plant.wait(0.2)
    command = robot(view.snapshot(plant.plant), "rm_sis_a")["command"]["id"]
    plant.tell("rm_sis_a", state=MotionState.STOPPED, rejected=command, refusal="ocupado")
    rejected = robot(view.snapshot(plant.plant), "rm_sis_a")["rejected"]
    assert rejected["count"] == 1 and "ocupado" in str(rejected["last"])
    assert robot(view.snapshot(plant.plant), "ra1")["rejected"] == {"count": 0, "last": None}


def test_a_cell_says_which_verbs_would_be_refused_now(rig: Rig) -> None:
    def refused() -> set[str]:
        return set(rig.snapshot()["cells"][0]["refused"])

    of_nobody = {"clear", "reset", "hold", "retry", "unload", "home_by_hand", "release_by_hand"}
    assert refused() == of_nobody | {"resume", "cancel", "abandon"}
    rig.submit("sis_a 0B 7")
    rig.wait(1.0)
    rig.operate(Verb.HOLD, "sis_a")
    rig.wait(2.0)
    assert refused() == of_nobody


def test_a_robot_says_that_it_stands_still_after_a_stop(rig: Rig) -> None:
    rig.submit("sis_a 0B 7")
    rig.wait_for("sis_a", "move to pick-up")
    rig.wait(0.2)
    rig.operate(Verb.STOP)
    assert not robot(rig.snapshot(), "ra1")["still"]
    rig.wait(2.0)
    assert robot(rig.snapshot(), "ra1")["still"]


def test_what_operators_did_is_numbered(rig: Rig) -> None:
    rig.operate(Verb.STOP)
    rig.wait(1.0)
    rig.operate(Verb.CLEAR, "sis_a")
    rig.operate(Verb.RESUME, "sis_b")  # refused: not an act
    acts = rig.snapshot()["acts"]
    assert [(act["number"], str(act["sentence"])) for act in acts] == [(1, "stop plant"), (2, "clear sis_a")]


def test_the_layout_says_what_the_plant_file_says() -> None:
    layout = view.layout(shipped())
    cell = layout["cells"][0]
    assert (cell["name"], cell["arm"], cell["mobile"], cell["stations"]) == ("sis_a", "ra1", "rm_sis_a", 9)
    assert cell["paths"]["0B"] == [0, 3, 4, 7] and cell["grid"] == {"rows": 3, "columns": 3}
