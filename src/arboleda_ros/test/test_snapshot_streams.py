"""Streams of snapshots in the types of py_trees_ros, with a real plant and virtual robots."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from py_trees_ros_interfaces.msg import Behaviour, BehaviourTree, SnapshotStreamParameters
from py_trees_ros_interfaces.srv import CloseSnapshotStream, OpenSnapshotStream, ReconfigureSnapshotStream

AT = "/sis_a/tree/snapshot_streams"


@pytest.fixture(scope="module", autouse=True)
def plant(start: Callable[[], Any]) -> Any:
    return start()


@pytest.fixture
def opened(client: Any) -> Callable[..., str]:
    """`opened("mine")`: the topic of a stream, which has such a name if it may."""

    def open_one(name: str = "", period_s: float = math.inf, *, data: bool = False) -> str:
        parameters = SnapshotStreamParameters(snapshot_period=period_s, blackboard_data=data)
        asked = {"topic_name": name, "parameters": parameters}
        return str(client.call(OpenSnapshotStream, f"{AT}/open", **asked).topic_name)

    return open_one


def close(client: Any, topic: str) -> bool:
    return bool(client.call(CloseSnapshotStream, f"{AT}/close", topic_name=topic).result)


def test_a_tree_is_shown_from_its_first_step_to_its_end(
    client: Any, opened: Callable[..., str], plant: Any
) -> None:
    topic = opened(data=True)
    messages = client.hear(BehaviourTree, topic)
    client.until(lambda: messages, "no tree was shown before a task")
    assert [node.name for node in messages[0].behaviours] == ["no task yet"]
    plant.submit("sis_a 0B 7 #streamed")

    def at_work() -> Any:
        trees = [each for each in messages if each.behaviours[0].status == Behaviour.RUNNING]
        return next(
            (each for each in trees if any(node.name == "move to station 7" for node in each.behaviours)),
            None,
        )

    tree = client.until(at_work, "the tree was not shown")
    assert tree.changed
    assert ("task/id", "streamed") in [(each.key, each.value) for each in tree.blackboard_on_visited_path]
    ids = {bytes(node.own_id.uuid) for node in tree.behaviours}
    assert all(bytes(child.uuid) in ids for node in tree.behaviours for child in node.child_ids)
    client.until(lambda: not any(node.is_active for node in messages[-1].behaviours), "the tree did not end")
    counts = [each.statistics.count for each in messages]
    assert counts == list(range(1, len(counts) + 1))
    assert close(client, topic)


def test_without_a_change_a_stream_tells_by_its_period(client: Any, opened: Callable[..., str]) -> None:
    topic = opened(period_s=0.5)
    messages = client.hear(BehaviourTree, topic)
    client.until(lambda: [each for each in messages if not each.changed], "it was not told again")
    parameters = SnapshotStreamParameters(snapshot_period=math.inf)
    asked = {"topic_name": topic, "parameters": parameters}
    assert client.call(ReconfigureSnapshotStream, f"{AT}/reconfigure", **asked).result
    assert close(client, topic)


def test_a_stream_is_where_streams_are_whatever_name_is_wanted(
    client: Any, opened: Callable[..., str]
) -> None:
    topics = [opened("mine"), opened("/ra1/command"), opened("~/no such name!")]
    assert topics[:2] == [f"{AT}/mine", f"{AT}/command"]
    assert topics[2].startswith(f"{AT}/_snapshots_")
    assert [close(client, topic) for topic in topics] == [True, True, True]
    assert not close(client, topics[0])


def test_there_are_not_more_streams_than_that(client: Any, opened: Callable[..., str]) -> None:
    topics = [opened() for _ in range(21)]
    assert [bool(topic) for topic in topics] == [True] * 20 + [False]
    assert all(close(client, topic) for topic in topics[:20])
    assert opened("again") == f"{AT}/again"
    assert close(client, f"{AT}/again")
