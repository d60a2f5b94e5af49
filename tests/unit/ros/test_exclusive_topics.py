"""The check at a start that no other node publishes what this one commands."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import pytest

from arboleda.model.errors import StartError

exclusive_topics = pytest.importorskip("arboleda_ros.exclusive_topics", reason="rclpy is not installed")

OWN, TOPIC = "/orchestrator", "ra1/joint_goals_q"
UNKNOWN = "_NODE_NAME_UNKNOWN_"


@dataclass
class Graph:
    """Clock and node: what discovery shows of publishers and nodes from one instant on."""

    publishers: dict[float, list[str]] = field(default_factory=lambda: {0.0: [OWN[1:]]})
    nodes: dict[float, list[str]] = field(default_factory=lambda: {0.0: [OWN[1:]]})
    now: float = 0.0
    asked_of: list[str] = field(default_factory=list)

    def monotonic(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds

    def get_fully_qualified_name(self) -> str:
        return OWN

    def resolve_topic_name(self, topic: str) -> str:
        return f"/{topic}"

    def get_publishers_info_by_topic(self, topic: str) -> list[Any]:
        self.asked_of.append(topic)
        if topic != TOPIC:
            return [SimpleNamespace(node_name=OWN[1:], node_namespace="/")]
        return [SimpleNamespace(node_name=name, node_namespace="/") for name in self._shown(self.publishers)]

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        return [(name, "/") for name in self._shown(self.nodes)]

    def count_publishers(self, topic: str) -> int:
        return len(self.get_publishers_info_by_topic(topic))

    def get_publisher_names_and_types_by_node(
        self, name: str, _namespace: str
    ) -> list[tuple[str, list[str]]]:
        if name not in self._shown(self.nodes):
            raise RuntimeError("there is no such node")
        return [(f"/{TOPIC}", [])] if name in self._shown(self.publishers) else []

    def _shown(self, found: dict[float, list[str]]) -> list[str]:
        return found[max(at for at in found if at <= self.now)]


def checked(graph: Graph, monkeypatch: pytest.MonkeyPatch, wait_s: float) -> float:
    """How long the check took, s."""
    monkeypatch.setattr(exclusive_topics, "time", graph)
    watch = exclusive_topics.ExclusiveTopics(graph)
    watch.topics = [TOPIC]
    watch.check(wait_s)
    return graph.now


def test_a_node_that_is_alone_waits_until_discovery_is_over(monkeypatch: pytest.MonkeyPatch) -> None:
    assert checked(Graph(), monkeypatch, 3.2) == pytest.approx(3.2, abs=0.05)


def test_it_returns_at_once_where_it_shall_not_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    assert checked(Graph(), monkeypatch, 0.0) == 0.0


def test_time_since_it_was_made_counts(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Graph()
    monkeypatch.setattr(exclusive_topics, "time", graph)
    watch = exclusive_topics.ExclusiveTopics(graph)
    graph.now = 3.0
    watch.check(3.2)
    assert graph.now == pytest.approx(3.2, abs=0.05)


@pytest.mark.parametrize("at", [0.0, 1.0])
def test_another_publisher_is_refused_as_soon_as_it_has_a_name(
    monkeypatch: pytest.MonkeyPatch, at: float
) -> None:
    graph = Graph(publishers={0.0: [OWN[1:]], at: [OWN[1:], "other_plant"]})
    with pytest.raises(StartError) as refused:
        checked(graph, monkeypatch, 3.2)
    assert str(refused.value) == (
        "another node already commands /ra1/joint_goals_q: /other_plant; stop it, "
        "or give this plant a ROS_DOMAIN_ID of its own"
    )
    assert graph.now == pytest.approx(at, abs=0.05)


def test_a_second_node_of_the_same_name_is_another_one(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(StartError, match=r"joint_goals_q: /orchestrator; stop it"):
        checked(Graph(publishers={0.0: [OWN[1:], OWN[1:]]}), monkeypatch, 3.2)


def test_a_publisher_without_a_name_gets_time_to_show_it(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Graph(publishers={0.0: [OWN[1:], UNKNOWN], 5.0: [OWN[1:], "late"]})
    with pytest.raises(StartError, match=r": /late; stop it"):
        checked(graph, monkeypatch, 3.2)
    assert graph.now == pytest.approx(5.0, abs=0.05)


def test_one_that_never_shows_it_is_refused_as_a_node_without_a_name(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Graph(publishers={0.0: [OWN[1:], UNKNOWN]})
    with pytest.raises(StartError, match=r": a node without a name; stop it"):
        checked(graph, monkeypatch, 3.2)
    assert graph.now == pytest.approx(3.2 + 3.0, abs=0.05)


def test_one_that_goes_before_it_had_a_name_is_no_other(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Graph(publishers={0.0: [OWN[1:], UNKNOWN], 4.0: [OWN[1:]]})
    assert checked(graph, monkeypatch, 3.2) == pytest.approx(4.0, abs=0.05)


def test_a_node_that_comes_late_gets_time_to_tell_what_it_publishes(monkeypatch: pytest.MonkeyPatch) -> None:
    graph = Graph(nodes={0.0: [OWN[1:]], 3.0: [OWN[1:], "newcomer"]})
    assert checked(graph, monkeypatch, 3.2) == pytest.approx(4.0, abs=0.05)
    graph = Graph(
        nodes={0.0: [OWN[1:]], 3.0: [OWN[1:], "newcomer"]},
        publishers={0.0: [OWN[1:]], 3.9: [OWN[1:], "newcomer"]},
    )
    with pytest.raises(StartError, match=r": /newcomer; stop it"):
        checked(graph, monkeypatch, 3.2)


def test_nodes_that_come_and_go_without_end_do_not_hold_a_start_for_ever(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    restless = {second / 2: [OWN[1:], f"node{second}"] for second in range(100)}
    assert checked(Graph(nodes=restless), monkeypatch, 3.2) == pytest.approx(13.2, abs=0.05)


MANY = [TOPIC, *(f"ra{number}/joint_goals_q" for number in range(2, 300))]


def watched(graph: Graph, *, looks: int) -> list[tuple[str, ...]]:
    """What a watch over MANY topics finds by a look a second, from 1 s on."""
    watch = exclusive_topics.ExclusiveTopics(graph)
    watch.topics = MANY
    for _ in range(100):
        watch.look()
    found = []
    for _ in range(looks):
        graph.now += 1.0
        graph.asked_of.clear()
        found.append(watch.look())
    return found


@pytest.mark.parametrize("tells_late_s", [0.0, 3.0])
def test_a_node_that_comes_and_publishes_is_found_at_once_or_as_it_tells(tells_late_s: float) -> None:
    graph = Graph(
        nodes={0.0: [OWN[1:]], 3.0: [OWN[1:], "newcomer"]},
        publishers={0.0: [OWN[1:]], 3.0 + tells_late_s: [OWN[1:], "newcomer"]},
    )
    found = watched(graph, looks=8)
    first = 2 + int(tells_late_s)
    assert found[:first] == [()] * first
    assert found[first:] == [("another node commands /ra1/joint_goals_q: /newcomer",)] * (8 - first)


def test_the_first_looks_are_not_at_all_topics_as_the_start_was() -> None:
    graph = Graph()
    watch = exclusive_topics.ExclusiveTopics(graph)
    watch.topics = MANY
    watch.look()
    assert len(graph.asked_of) == 5


def test_a_node_that_publishes_nothing_of_the_plant_costs_no_look_at_all_topics() -> None:
    graph = Graph(nodes={0.0: [OWN[1:]], 3.0: [OWN[1:], "listener"]})
    assert watched(graph, looks=3) == [()] * 3
    assert len(graph.asked_of) == 5


@pytest.mark.parametrize("name", [OWN[1:], UNKNOWN])
def test_for_a_node_that_nobody_can_ask_for_by_its_name_all_topics_are_looked_at(name: str) -> None:
    graph = Graph(
        nodes={0.0: [OWN[1:]], 1.0: [OWN[1:], name]}, publishers={0.0: [OWN[1:]], 1.0: [OWN[1:], name]}
    )
    assert watched(graph, looks=1) != [()]
    assert len(set(graph.asked_of)) == len(MANY)


def test_an_intruder_that_has_gone_is_forgotten_by_the_next_look() -> None:
    graph = Graph(
        nodes={0.0: [OWN[1:]], 1.0: [OWN[1:], "newcomer"], 8.0: [OWN[1:]]},
        publishers={0.0: [OWN[1:]], 1.0: [OWN[1:], "newcomer"], 8.0: [OWN[1:]]},
    )
    found = watched(graph, looks=9)
    assert found[6] != () and found[7:] == [(), ()]
