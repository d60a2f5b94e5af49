"""Messages of a robot's publishers: which wait for news of publishers, and which count."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from arboleda_ros import speakers

TOPIC = "ra1/status"


class Bench:
    """A node whose executor does its tasks when it is told to; `heard` are the messages that counted."""

    def __init__(self) -> None:
        self.now = 0.0
        self.tasks: list[Callable[[], None]] = []
        self.heard: list[str] = []
        self.nodes = ["/mqtt_bridge"]
        node: Any = SimpleNamespace(
            executor=SimpleNamespace(create_task=self.tasks.append),
            get_publishers_info_by_topic=lambda _topic: [self._info(name) for name in self.nodes],
            resolve_topic_name=lambda topic: f"/{topic}",
        )
        self.speakers = speakers.Speakers(node, "ra1", lambda: self.now, lambda _event: None)
        self.hear = self.speakers.guarded(TOPIC, self.heard.append, lambda said: said == self.heard[-1])
        self.heard.append("first")

    def _info(self, name: str) -> Any:
        return SimpleNamespace(node_name=name[1:], node_namespace="/", endpoint_gid=name.encode())

    def matched(self) -> None:
        count = len(self.nodes)
        self.speakers.matched(TOPIC, SimpleNamespace(total_count=count, current_count=count))

    def do_tasks(self) -> None:
        while self.tasks:
            self.tasks.pop(0)()


@pytest.fixture
def bench() -> Bench:
    made = Bench()
    made.matched()
    return made


def test_news_waits_for_what_is_known_of_its_publisher_and_a_repetition_does_not(bench: Bench) -> None:
    bench.hear("first")
    assert bench.heard == ["first", "first"] and not bench.tasks
    bench.hear("second")
    assert bench.heard[-1] == "first"
    bench.do_tasks()
    assert bench.heard[-1] == "second"


def test_a_repetition_does_not_overtake_news(bench: Bench) -> None:
    bench.hear("second")
    bench.hear("first")
    bench.do_tasks()
    assert bench.heard == ["first", "second", "first"]
    bench.hear("first")
    assert bench.heard[-2:] == ["first", "first"]


def test_while_several_publish_not_even_a_repetition_counts(bench: Bench) -> None:
    bench.nodes.append("/other")
    bench.matched()
    bench.hear("first")
    bench.hear("second")
    bench.do_tasks()
    assert bench.heard == ["first"]
