"""The operator's verbs on every surface of a running plant: command line, HTTP, ROS 2."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import httpx
import pytest
import yaml

from ..patience import PATIENCE_S
from .conftest import SHIPPED

pytestmark = pytest.mark.system


def eventually(holds: Callable[[], Any], otherwise: str) -> Any:
    """The first true value of `holds`."""
    until = time.monotonic() + PATIENCE_S
    while not (value := holds()):
        assert time.monotonic() < until, otherwise
        time.sleep(0.05)
    return value


class Operator:
    """Somebody at a terminal; `up` is the plant."""

    def __init__(self, typed: Callable[..., tuple[int, str]], up: Any) -> None:
        self.ask = typed
        self.up = up

    def done(self, *words: str) -> str:
        """A command that the plant does at once, or as soon as its robots stand still."""

        def tried() -> str | None:
            status, said = self.ask(*words)
            return said if status == 0 else None

        return eventually(tried, f"arboleda {' '.join(words)} was refused to the end")


def plant_at(folder: Path, speed_mm_s: float) -> tuple[str, ...]:
    """The shipped plant, quick but for the mobile of sis_a, which can be interrupted."""
    plant = yaml.safe_load(SHIPPED.read_text())
    plant["cells"]["sis_a"]["mobile"]["speed_mm_s"] = speed_mm_s
    file = folder / "plant.yaml"
    file.write_text(yaml.safe_dump(plant))
    return ("--plant", str(file), "--rate", "5")


@pytest.fixture
def at_work(arboleda: Callable[..., Any], typed: Callable[..., tuple[int, str]]) -> Callable[..., Operator]:
    """With a plant at work: the mobile of sis_a is on its way."""

    def go(plant: tuple[str, ...]) -> Operator:
        up = arboleda("up", "sis_a 0B 7", "--no-ros", *plant)
        up.wait_for("sis_a: drive path 0B")
        return Operator(typed, up)

    return go


@pytest.fixture
def quick(tmp_path: Path) -> tuple[str, ...]:
    return plant_at(tmp_path, 40)


@pytest.fixture
def operator(at_work: Callable[..., Operator], quick: tuple[str, ...]) -> Operator:
    return at_work(quick)


def test_stop_clear_reset_and_work_again(at_work: Callable[..., Operator], tmp_path: Path) -> None:
    operator = at_work(plant_at(tmp_path, 10))  # slow: the stop comes before the arm has a part
    assert operator.ask("stop") == (0, "sent: stop (software), the whole plant")
    operator.up.wait_for("(stopped)")
    assert "failed    sis_a 0B 7" in operator.up.output
    refused, why = operator.ask("reset")
    assert refused == 2 and why.startswith("arboleda: ")
    assert "latched" in operator.ask("status")[1]
    assert operator.ask("submit", "sis_b 1C 3")[0] == 0
    operator.done("clear")
    operator.done("reset")
    operator.done("resume")
    operator.up.wait_for("done      sis_b 1C 3")
    assert operator.ask("submit", "sis_a 0B 7")[0] == 0
    operator.up.wait_for("done      sis_a 0B 7")
    assert "Traceback" not in operator.up.output


def test_a_stopped_cell_leaves_the_others_alone(at_work: Callable[..., Operator], tmp_path: Path) -> None:
    operator = at_work(plant_at(tmp_path, 1))  # it drives for longer than two commands take
    assert operator.ask("submit", "sis_b 1C 3")[0] == 0
    assert operator.ask("stop", "sis_a")[0] == 0
    operator.up.wait_for("failed    sis_a 0B 7")
    operator.up.wait_for("done      sis_b 1C 3")


def test_hold_and_resume_end_in_done(operator: Operator) -> None:
    assert operator.ask("hold", "sis_a")[0] == 0
    eventually(lambda: "held" in operator.ask("status")[1], "the cell was not held")
    operator.done("resume", "sis_a")
    operator.up.wait_for("done      sis_a 0B 7")


def test_cancel_ends_the_task_and_the_cell_works_on(operator: Operator) -> None:
    assert operator.ask("cancel", "sis_a")[0] == 0
    operator.up.wait_for("cancelled sis_a 0B 7")
    assert operator.ask("submit", "sis_a 0B 3")[0] == 0
    operator.up.wait_for("done      sis_a 0B 3")


def test_what_cannot_be_done_is_refused_with_a_sentence(operator: Operator) -> None:
    for *words, named in (
        ("stop", "sis_z"),
        ("cancel", "lot99"),
        ("override", "--yes", "nowhere"),
        ("retry", "sis_b"),
        ("abandon", "sis_b"),
        ("resume", "ra9"),
    ):
        status, said = operator.ask(*words, named)
        assert status == 2 and said.startswith("arboleda: ") and named in said, (words, said)
    operator.up.wait_for("done      sis_a 0B 7")


def test_without_a_plant_no_verb_works(arboleda: Callable[..., Any]) -> None:
    asked = arboleda("stop")
    assert asked.wait() == 1 and "No plant is running" in asked.output


@pytest.fixture
def web(operator: Operator) -> Iterator[httpx.Client]:
    found = re.search(r"HTTP API: (http://\S+)/api/plant", operator.up.output)
    assert found
    with httpx.Client(base_url=found[1], trust_env=False, timeout=PATIENCE_S) as client:
        yield client


def cell(web: httpx.Client, name: str) -> dict[str, Any]:
    return next(each for each in web.get("/api/plant").json()["cells"] if each["name"] == name)


@pytest.mark.smoke
def test_the_same_verbs_over_http(web: httpx.Client, operator: Operator) -> None:
    held = web.post("/api/cells/sis_a/hold")
    assert held.status_code == 200
    number = held.json()["act"]
    assert held.json() == {"verb": "hold", "scope": "sis_a", "act": number, "outcome": "done"}
    assert web.get(f"/api/acts/{number}").json()["sentence"] == "hold sis_a"
    eventually(lambda: cell(web, "sis_a")["state"] == "held", "the cell was not held")
    assert web.post("/api/cells/sis_a/resume").status_code == 200
    assert web.post("/api/tasks", json={"text": "sis_b 1C 3 #lot1"}).status_code == 202
    assert web.post("/api/cells/lot1/cancel").status_code == 200
    eventually(lambda: web.get("/api/tasks/lot1").json()["state"] == "cancelled", "lot1 was not cancelled")
    refused = web.post("/api/cells/sis_z/stop")
    assert refused.status_code == 409 and "sis_z" in refused.json()["sentence"]
    assert web.post("/api/plant/halt").status_code == 422
    operator.up.wait_for("done      sis_a 0B 7")


@pytest.mark.smoke
def test_a_stop_over_http_reaches_every_robot(web: httpx.Client) -> None:
    assert web.post("/api/plant/stop").status_code == 200

    def latched() -> bool:
        return {robot["state"] for robot in web.get("/api/plant").json()["robots"]} == {4}

    def aborted() -> bool:
        return {each["state"] for each in web.get("/api/plant").json()["cells"]} == {"aborted"}

    eventually(latched, "not every robot is latched")
    eventually(aborted, "not every cell is aborted")


@pytest.mark.requires("rclpy")
@pytest.mark.smoke
def test_the_plant_is_operated_by_services_of_ros_2(
    arboleda: Callable[..., Any], quick: tuple[str, ...], quick_discovery: None, observer: Any
) -> None:
    from std_msgs.msg import String, UInt8
    from std_srvs.srv import Trigger

    def call(verb: str) -> Any:
        client = observer.node.create_client(Trigger, f"/plant/{verb}")
        observer.wait(client.service_is_ready, f"no service /plant/{verb}")
        answer = client.call_async(Trigger.Request())
        observer.wait(answer.done, f"/plant/{verb} does not answer")
        return answer.result()

    def done(verb: str) -> None:
        observer.wait(lambda: call(verb).success, f"/plant/{verb} was refused to the end")

    up = arboleda("up", *quick)
    observer.listen(String, "/task_status")
    observer.listen(UInt8, "/ra1/stop_cmd", "/rm_sis_a/stop_cmd", "/ra1/motion_state")
    requests = observer.publisher(String, "/task_request")
    observer.wait(lambda: observer.heard["/ra1/motion_state"], "ra1 is not heard")
    requests.publish(String(data="sis_a 0B 7"))
    up.wait_for("sis_a: drive path 0B")

    assert call("stop").success
    codes = observer.heard["/ra1/motion_state"]
    observer.wait(lambda: codes[-1].data == 4, "ra1 is not latched")

    def stopped(topic: str) -> bool:
        return 1 in {message.data for message in observer.heard[topic]}

    def last() -> dict[str, Any]:
        return dict(json.loads(observer.heard["/task_status"][-1].data))

    for topic in ("/ra1/stop_cmd", "/rm_sis_a/stop_cmd"):
        observer.wait(lambda topic=topic: stopped(topic), f"no stop on {topic}")
    observer.wait(lambda: last()["state"] == "failed", "the task did not fail")
    assert last()["reason"] == "stopped"
    early = call("reset")
    assert not early.success and early.message
    done("clear")
    observer.wait(lambda: codes[-1].data == 0, "the latch of ra1 was not cleared")
    done("reset")
    done("resume")
    requests.publish(String(data="sis_a 0B 7"))
    up.wait_for("done      sis_a 0B 7")
    assert up.interrupt() == 0, up.output
