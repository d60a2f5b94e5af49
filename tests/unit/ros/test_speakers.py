"""Messages of a robot's publishers: which count, by what the middleware knows of publishers by then."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from std_msgs.msg import UInt8

from arboleda.model.messages import MotionState, Uncontested
from arboleda_ros import speakers
from arboleda_ros.speaker import HOLD_S

TOPIC = "ra1/status"


class Timer:
    """A timer of rclpy that runs, or is cancelled."""

    def __init__(self, period_s: float, call: Callable[[], None]) -> None:
        self.period_s, self.call, self.runs = period_s, call, True

    def cancel(self) -> None:
        self.runs = False

    def reset(self) -> None:
        self.runs = True

    def is_canceled(self) -> bool:
        return not self.runs


class Bench:
    """A node whose middleware knows of publishers at once; its executor is told by `matched`. `heard` are the
    messages that counted."""

    def __init__(self) -> None:
        self.now = 0.0
        self.heard: list[str] = []
        self.nodes = ["/mqtt_bridge"]
        self.ever = 1
        self.unshown = 0
        self.events: list[Any] = []
        self.looks = 0
        self.timer: Any = None
        node: Any = SimpleNamespace(
            create_timer=self._timer,
            get_publishers_info_by_topic=self._publishers,
            resolve_topic_name=lambda topic: f"/{topic}",
        )
        self.speakers = speakers.Speakers(node, "ra1", lambda: self.now, self.events.append)
        self.hear = self.speakers.guarded(TOPIC, self.heard.append)
        self.speakers.watch(TOPIC, self._counts)

    def wait(self, seconds: float) -> None:
        """Let time pass with no message of anybody: only the timer calls, where it runs."""
        until = self.now + seconds
        while self.timer.runs and self.now + self.timer.period_s <= until:
            self.now += self.timer.period_s
            self.timer.call()
        self.now = until

    def leave(self, node: str) -> None:
        """A publisher is gone, and the executor comes to that event."""
        self.nodes.remove(node)
        self.matched()

    def _timer(self, period_s: float, call: Callable[[], None], clock: Any) -> Any:
        self.timer = Timer(period_s, call)
        return self.timer

    def matched(self) -> None:
        """The executor comes to the event that publishers came or went."""
        self.speakers.matched(TOPIC, self._counts())

    def come(self, node: str, *, shown: bool = True) -> None:
        """A publisher is matched; whether the graph shows it already."""
        self.nodes.append(node)
        self.ever += 1
        self.unshown += not shown

    def _counts(self) -> Any:
        return SimpleNamespace(total_count=self.ever, current_count=len(self.nodes))

    def _publishers(self, _topic: str) -> list[Any]:
        self.looks += 1
        return [self._info(name) for name in self.nodes[: len(self.nodes) - self.unshown]]

    def _info(self, name: str) -> Any:
        return SimpleNamespace(node_name=name[1:], node_namespace="/", endpoint_gid=name.encode())


@pytest.fixture
def bench() -> Bench:
    made = Bench()
    made.matched()
    return made


def test_a_message_of_the_one_publisher_counts_at_once_and_asks_the_graph_for_nothing(bench: Bench) -> None:
    before = bench.looks
    bench.hear("first")
    bench.hear("second")
    assert bench.heard == ["first", "second"]
    assert bench.looks == before


def test_a_message_does_not_count_before_what_is_known_of_its_publisher(bench: Bench) -> None:
    bench.come("/other")
    bench.hear("first")
    assert bench.heard == []
    assert any("/other" in str(event) for event in bench.events)


def test_a_message_of_a_publisher_that_has_taken_the_place_of_another_is_news_as_well(bench: Bench) -> None:
    bench.nodes.clear()
    bench.come("/other")
    before = bench.looks
    bench.hear("first")
    assert bench.looks > before


def test_a_publisher_that_came_and_went_unseen_leaves_nothing_that_counts(bench: Bench) -> None:
    bench.ever += 1
    bench.hear("first")
    assert bench.heard == []


def test_the_event_that_comes_after_its_message_is_no_news_any_more(bench: Bench) -> None:
    bench.come("/other")
    bench.hear("first")
    said = len(bench.events)
    bench.matched()
    assert len(bench.events) == said


def test_while_several_publish_no_message_counts(bench: Bench) -> None:
    bench.come("/other")
    bench.matched()
    bench.hear("first")
    bench.hear("second")
    assert bench.heard == []


def test_a_publisher_that_is_matched_before_the_graph_shows_it_is_not_believed(bench: Bench) -> None:
    bench.come("/other", shown=False)
    bench.hear("second")
    assert bench.heard == []


def test_the_plant_is_told_that_reports_count_again_though_the_robot_says_nothing(bench: Bench) -> None:
    bench.come("/other")
    bench.matched()
    bench.wait(5.0)
    assert not [event for event in bench.events if isinstance(event, Uncontested)]
    bench.leave("/other")
    bench.wait(HOLD_S + bench.timer.period_s)
    assert isinstance(bench.events[-1], Uncontested)
    told = len(bench.events)
    bench.wait(5.0)
    bench.hear("later")
    assert len(bench.events) == told
    assert not bench.timer.runs


def test_what_was_said_while_several_published_is_told_once_only_one_is_left(bench: Bench) -> None:
    bench.come("/other")
    for state in (0, 2, 2, 77, 255):
        bench.hear(UInt8(data=state))
    bench.leave("/other")
    bench.wait(HOLD_S + bench.timer.period_s)
    assert bench.heard == []
    assert bench.events[-1].said == (MotionState.STOPPED, MotionState.FAULT)
    bench.come("/other")
    bench.matched()
    bench.leave("/other")
    bench.wait(HOLD_S + bench.timer.period_s)
    assert bench.events[-1] == Uncontested(at=bench.events[-1].at, robot="ra1")


def test_what_a_driver_says_that_was_started_anew_counts_once_its_name_is_known(bench: Bench) -> None:
    bench.come("/mqtt_bridge", shown=False)
    for state in (1, 2):
        bench.hear(UInt8(data=state))
    assert bench.heard == []
    bench.unshown = 0
    bench.wait(HOLD_S + 2 * bench.timer.period_s)
    assert [each.data for each in bench.heard] == [1, 2]
    assert bench.events == []
    bench.now += 7200.0
    bench.come("/other")
    bench.matched()
    bench.leave("/other")
    bench.wait(HOLD_S + bench.timer.period_s)
    assert (len(bench.heard), bench.events[-1].said) == (2, ())


@pytest.mark.parametrize("is_named", [True, False])
def test_what_may_be_a_strangers_is_not_taken_for_the_robots_once_that_is_known(
    bench: Bench, is_named: bool
) -> None:
    bench.come("/mqtt_bridge", shown=False)
    bench.hear(UInt8(data=2))
    bench.unshown = 0
    if is_named:
        bench.come("/other")
        bench.matched()
        bench.leave("/other")
    else:
        bench.ever += 1  # one came and went
    bench.hear(UInt8(data=0))
    bench.wait(HOLD_S + 2 * bench.timer.period_s)
    assert bench.heard == []
    assert bench.events[-1].said == (MotionState.STOPPED, MotionState.FAULT)


def test_of_a_publisher_that_came_and_went_nothing_is_left_either(bench: Bench) -> None:
    bench.ever += 1
    bench.matched()
    bench.wait(HOLD_S + bench.timer.period_s)
    assert isinstance(bench.events[-1], Uncontested)


def test_a_message_that_counts_again_comes_after_the_word_that_it_does(bench: Bench) -> None:
    bench.come("/other")
    bench.matched()
    bench.leave("/other")
    bench.now += HOLD_S
    bench.hear("first")
    assert isinstance(bench.events[-1], Uncontested) and bench.heard == ["first"]
