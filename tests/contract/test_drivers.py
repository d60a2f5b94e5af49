"""What every driver does for its devices: one press, played by hand, behind each of them."""

from __future__ import annotations

import queue
import shutil
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import pytest

from arboleda.app.build import App, Options, build
from arboleda.app.config import load
from arboleda.model.messages import Reason, TaskChanged, TaskState, Verb
from arboleda.model.plant_model import PlantModel

from ..conftest import need_tool
from .drivers.peers import EXAMPLE, HALT, LATCH, LineWire, MqttWire, Press, RosWire, controller, line_of

pytestmark = pytest.mark.system

PATIENCE_S = 20.0
OPEN = (TaskState.QUEUED, TaskState.RUNNING)
DRIVERS = ("mqtt", "ros", "line_tcp")
RECIPES = """
from arboleda.recipes import recipe, work

@recipe("close")
def close(cell):
    return cell.device("press").close()

@recipe("open")
def open_(cell):
    return cell.device("press").open()

@recipe("measure")
def measure(cell):
    seen = cell.device("press").measure()
    return work(seen, cell.choose(seen, {"good": [], "bad": cell.fail("the part is out of measure")}))
"""


class Shop:
    """A plant with one press, which is reached by a driver."""

    def __init__(self, app: App) -> None:
        self.app = app
        self.press: Press
        self._changes: queue.Queue[TaskChanged] = queue.Queue()
        self._online: queue.Queue[bool] = queue.Queue()
        app.listen(self._changes.put)
        app.watch(lambda snapshot: self._online.put(snapshot["robots"][0]["online"]))

    def submit(self, recipe: str, id: str = "t1") -> None:
        self.app.submit(f"shop {recipe} #{id}").result(PATIENCE_S)

    def outcome(self, id: str = "t1") -> TaskChanged:
        """The end of a task."""
        while (change := self._changes.get(timeout=PATIENCE_S)).state in OPEN or change.task != id:
            pass
        return change

    def cancel(self) -> None:
        assert self.app.operate(Verb.CANCEL, "shop").result(PATIENCE_S).refusal is None

    def until(self, *, online: bool) -> None:
        """Wait until screens show that the press is heard, or that it is not."""
        while self._online.get(timeout=PATIENCE_S) is not online:
            pass


def plant(folder: Path, driver: str) -> PlantModel:
    """The plant of the example, with the press behind this driver."""
    shutil.copytree(EXAMPLE, folder)
    (folder / "recipes.py").write_text(RECIPES, "utf-8")
    file = folder / "plant.yaml"
    text = file.read_text("utf-8")
    old = "{line_tcp: {host: 127.0.0.1, port: 4711}}"
    assert old in text
    file.write_text(text.replace(old, driver), "utf-8")
    return load(file)


def by_mqtt(folder: Path, state: Path) -> tuple[App, Callable[[App], Press]]:
    parts = ("broker", "bridge", "orchestrator")
    app = build(plant(folder, "mqtt"), parts, Options(state_dir=state))
    return app, lambda app: Press(partial(MqttWire, app.links()["broker"]["address"]))


def by_ros(folder: Path, state: Path) -> tuple[App, Callable[[App], Press]]:
    need_tool("rclpy")
    from arboleda_ros.link import connect

    app = build(plant(folder, "ros"), ("orchestrator",), Options(state_dir=state, link=connect()))
    return app, lambda app: Press(RosWire)


def by_line(folder: Path, state: Path) -> tuple[App, Callable[[App], Press]]:
    made: list[Any] = []
    server = controller().Line(lambda order: made[0](line_of(order)))
    driver = f"{{line_tcp: {{host: 127.0.0.1, port: {server.port}}}}}"
    app = build(plant(folder, driver), ("orchestrator",), Options(state_dir=state))

    def connect(told: Callable[[Any], None]) -> LineWire:
        made.append(told)
        return LineWire(server)

    return app, lambda app: Press(connect)


WAYS = {"mqtt": by_mqtt, "ros": by_ros, "line_tcp": by_line}


@pytest.fixture(params=DRIVERS)
def shop(
    request: pytest.FixtureRequest, tmp_path: Path, ros_domain: int, quick_discovery: None
) -> Iterator[Shop]:
    """A plant that runs, and whose press is heard."""
    app, press = WAYS[request.param](tmp_path / "plant", tmp_path / "state")
    shop = Shop(app)
    app.start()
    try:
        shop.press = press(app)
        shop.until(online=True)
        yield shop
        shop.press.says(state="stopped")  # the plant waits for it to stand still
    finally:
        app.stop()
        shop.press.close()


def test_an_order_is_accepted_carried_out_and_done(shop: Shop) -> None:
    shop.submit("close")
    ref = shop.press.told("close")
    shop.press.says(accepted=ref, state="moving")
    shop.press.says(done=ref, state="stopped", guard="closed")
    assert shop.outcome().state is TaskState.DONE


def test_done_is_not_believed_while_the_facts_say_otherwise(shop: Shop) -> None:
    shop.submit("close")
    ref = shop.press.told("close")
    shop.press.says(accepted=ref, done=ref, state="stopped", guard="open")
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.NOT_REACHED)


def test_an_order_that_is_rejected_fails_with_the_word(shop: Shop) -> None:
    shop.submit("close")
    ref = shop.press.told("close")
    shop.press.says(rejected=(ref, "ocupado"))
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.REJECTED)
    assert "(ocupado)" in str(end.sentence)


def test_work_that_the_device_gives_up_fails_with_its_word(shop: Shop) -> None:
    shop.submit("close")
    ref = shop.press.told("close")
    shop.press.says(accepted=ref, state="moving")
    shop.press.says(failed=(ref, "atasco"), state="stopped")
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.DEVICE_FAULT)
    assert "gave up (atasco)" in str(end.sentence)


def test_what_is_cancelled_before_it_is_accepted_is_halted_and_never_done(shop: Shop) -> None:
    shop.submit("close")
    ref = shop.press.told("close")
    shop.cancel()
    shop.press.told(HALT)
    shop.press.says(accepted=ref, state="moving")
    shop.press.says(state="stopped")
    assert shop.outcome().state is TaskState.CANCELLED


def test_an_answer_to_an_earlier_question_is_none_to_this_one(shop: Shop) -> None:
    shop.submit("measure", "first")
    first = shop.press.told("measure")
    shop.press.says(accepted=first)
    shop.cancel()
    assert shop.outcome("first").state is TaskState.CANCELLED
    shop.submit("measure", "second")
    second = shop.press.told("measure")
    shop.press.says(answered=(first, "bad"))
    shop.press.says(accepted=second, answered=(second, "good"))
    assert shop.outcome("second").state is TaskState.DONE


def test_the_end_of_an_order_that_is_told_again_and_again_ends_no_other(shop: Shop) -> None:
    shop.submit("close", "first")
    first = shop.press.told("close")
    shop.press.says(accepted=first, done=first, guard="closed")
    assert shop.outcome("first").state is TaskState.DONE
    shop.submit("open", "second")
    second = shop.press.told("open")
    for _ in range(3):
        shop.press.says(done=first)
    shop.press.says(failed=(second, "atasco"))  # had it counted as done, this would be too late
    assert shop.outcome("second").state is TaskState.FAILED
    assert [order.word for order in shop.press.taken] == ["close", "open"]


def test_a_device_that_falls_silent_has_lost_its_link(shop: Shop) -> None:
    shop.submit("close")
    ref = shop.press.told("close")
    shop.press.says(accepted=ref, state="moving")
    shop.press.hush()
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.LINK_LOST)
    shop.until(online=False)


def test_a_device_that_boots_has_forgotten_its_work(shop: Shop) -> None:
    shop.submit("close")
    ref = shop.press.told("close")
    shop.press.says(accepted=ref, state="moving")
    shop.press.says(accepted=None, boot=2, state="stopped")
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.REBOOTED)


def test_a_device_that_comes_back_is_told_nothing_twice(shop: Shop) -> None:
    shop.submit("close")
    ref = shop.press.told("close")
    shop.press.says(accepted=ref, state="moving")
    shop.press.vanish()
    end = shop.outcome()
    assert (end.state, end.reason) == (TaskState.FAILED, Reason.LINK_LOST)
    shop.press.words = type(shop.press.words)()
    shop.press.come_back()
    shop.until(online=True)
    shop.app.operate(Verb.STOP, "shop").result(PATIENCE_S)
    after = [shop.press.orders.get(timeout=PATIENCE_S).word]
    while after[-1] != LATCH:
        after.append(shop.press.orders.get(timeout=PATIENCE_S).word)
    assert set(after) <= {HALT, LATCH}
    shop.press.says(state="latched")
