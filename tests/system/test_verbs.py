"""The operator's verbs at a running plant, over HTTP and ROS 2."""

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


@pytest.fixture
def quick(tmp_path: Path) -> tuple[str, ...]:
    """The shipped plant, quick but for the mobile of sis_a, which can be interrupted."""
    plant = yaml.safe_load(SHIPPED.read_text())
    plant["cells"]["sis_a"]["mobile"]["speed_mm_s"] = 40
    file = tmp_path / "plant.yaml"
    file.write_text(yaml.safe_dump(plant))
    return ("--plant", str(file), "--rate", "5")


@pytest.fixture
def at_work(arboleda: Callable[..., Any], quick: tuple[str, ...]) -> Any:
    """A plant whose mobile of sis_a is on its way."""
    up = arboleda("up", "sis_a 0B 7", "--no-ros", *quick)
    up.wait_for("sis_a: drive path 0B")
    return up


@pytest.fixture
def web(at_work: Any) -> Iterator[httpx.Client]:
    found = re.search(r"HTTP API: (http://\S+)/api/plant", at_work.output)
    assert found
    with httpx.Client(base_url=found[1], trust_env=False, timeout=PATIENCE_S) as client:
        yield client


def cell(web: httpx.Client, name: str) -> dict[str, Any]:
    return next(each for each in web.get("/api/plant").json()["cells"] if each["name"] == name)


@pytest.mark.smoke
def test_the_same_verbs_over_http(web: httpx.Client, at_work: Any) -> None:
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
    at_work.wait_for("done      sis_a 0B 7")


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
