"""While several nodes publish what a robot reports, nothing of that is believed."""

from __future__ import annotations

import pytest

from arboleda_ros.speaker import HOLD_S, NAMELESS_S, Speaker

TOPIC = "/ra1/status"
BRIDGE, STRANGER = "/mqtt_bridge", "/forger"


@pytest.fixture
def speaker() -> Speaker:
    return Speaker("ra1")


@pytest.mark.parametrize("nodes", [[], [BRIDGE], [BRIDGE, BRIDGE], [None]])
def test_one_node_is_believed_also_where_it_was_started_again(speaker, nodes) -> None:
    assert speaker.publishers(1.0, TOPIC, nodes) is None
    assert speaker.believed(1.0)


def test_of_two_nodes_neither_is_believed_and_both_are_named_once(speaker) -> None:
    told = speaker.publishers(1.0, TOPIC, [BRIDGE, STRANGER])
    assert str(told) == (
        "ra1: more than one node publishes on /ra1/status (/forger and /mqtt_bridge); nothing that it "
        "reports is believed until one is left"
    )
    assert speaker.publishers(2.0, TOPIC, [BRIDGE, STRANGER]) is None
    assert not speaker.believed(2.0)


def test_what_a_node_that_is_gone_has_left_is_not_believed(speaker) -> None:
    speaker.publishers(1.0, TOPIC, [BRIDGE, STRANGER])
    assert speaker.publishers(2.0, TOPIC, [BRIDGE]) is None
    assert not speaker.believed(2.0 + HOLD_S - 0.01)
    assert speaker.believed(2.0 + HOLD_S)


def test_each_time_is_told(speaker) -> None:
    for at in (1.0, 3.0):
        assert speaker.publishers(at, TOPIC, [BRIDGE, STRANGER]) is not None
        speaker.publishers(at + 1.0, TOPIC, [BRIDGE])


def test_a_node_without_a_name_yet_is_not_believed_and_named_once_it_has_one(speaker) -> None:
    assert speaker.publishers(1.0, TOPIC, [BRIDGE, None]) is None
    assert not speaker.believed(1.0)
    assert "/forger" in str(speaker.publishers(1.1, TOPIC, [BRIDGE, STRANGER]))


def test_a_bridge_that_starts_again_is_no_stranger_while_it_has_no_name(speaker) -> None:
    speaker.publishers(1.0, TOPIC, [BRIDGE, None])
    assert speaker.publishers(1.1, TOPIC, [BRIDGE, BRIDGE]) is None
    assert speaker.believed(1.1 + HOLD_S)


def test_a_node_that_never_has_a_name_is_told_of(speaker) -> None:
    speaker.publishers(1.0, TOPIC, [BRIDGE, None])
    told = speaker.publishers(1.0 + NAMELESS_S, TOPIC, [BRIDGE, None])
    assert "(/mqtt_bridge and a node without a name)" in str(told)


@pytest.mark.parametrize("named", [False, True])
def test_a_node_that_came_and_went_is_told_of(speaker, named: bool) -> None:
    if named:
        told = speaker.came_and_went(1.0, TOPIC)
    else:
        speaker.publishers(1.0, TOPIC, [BRIDGE, None])
        told = speaker.publishers(1.1, TOPIC, [BRIDGE])
    assert "(a node that is gone)" in str(told)
    assert not speaker.believed(1.2)


def test_other_topics_of_the_robot_stay_contested(speaker) -> None:
    speaker.publishers(1.0, TOPIC, [BRIDGE, STRANGER])
    speaker.publishers(1.0, "/ra1/joint_states", [BRIDGE, STRANGER])
    speaker.publishers(2.0, TOPIC, [BRIDGE])
    assert not speaker.believed(9.0)
