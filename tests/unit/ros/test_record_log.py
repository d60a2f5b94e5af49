"""Tools for ROS 2 find in a record what they know: joints, motion states, tasks, diagnostics."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap.records import Schema
from mcap_ros2.decoder import DecoderFactory

from arboleda.model.messages import Report, Verb
from arboleda.recorder.steps import Step
from arboleda.testing.plants import shipped
from arboleda.views.diagnostics import diagnostics
from arboleda_ros import cdr, record_types
from arboleda_ros.record_log import DIAGNOSTICS, RosLog
from arboleda_ros.record_types import JOINT_STATE, STRING, UINT8

from ..recorder.recorded import Site

TEXTS = st.text(st.characters(exclude_categories=["Cs"], exclude_characters="\0"), max_size=9)


@pytest.fixture(scope="module")
def log() -> RosLog:
    """What the record of `site` has of ROS 2."""
    return RosLog(shipped())


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, log: RosLog) -> Site:
    """A plant that was stopped at work, and has ended."""
    with pytest.MonkeyPatch.context() as patch:
        made = Site(tmp_path_factory.mktemp("stopped"), patch, logs=[log])
        made.work("sis_a 0B 7", s=8.0)
        made.rig.operate(Verb.STOP, "sis_a")
        made.work(s=3.0)
        made.end()
    return made


def decoded(type: str, data: bytes) -> Any:
    schema = Schema(id=1, name=type, encoding="ros2msg", data=record_types.DEFINITIONS[type].encode())
    decode = DecoderFactory().decoder_for("cdr", schema)
    assert decode is not None
    return decode(data)


def messages_on(path: Path, topic: str) -> list[Any]:
    """The messages of a topic, decoded by a library that is not ours."""
    with path.open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        return [message for *_, message in reader.iter_decoded_messages(topics=[topic])]


def test_joints_are_told_as_they_were_reported(site: Site) -> None:
    arm = site.model.robots["ra1"]
    messages = messages_on(site.files[0], f"/{arm.twin}/joint_states")
    assert len(messages) > 20
    last = messages[-1]
    assert last.name == [f"{arm.twin}_{joint.name}" for joint in arm.joints]
    assert tuple(last.position) == site.rig.plant.dispatcher.beliefs["ra1"].q
    assert (list(last.velocity), list(last.effort)) == ([], [])
    assert 100 < last.header.stamp.sec <= site.rig.now
    mobile = messages_on(site.files[0], "/rm_sis_a/joint_states")
    assert mobile[0].name == ["rm_sis_a_x_joint", "rm_sis_a_y_joint"] and len(mobile) > 2


def test_states_are_told_where_they_change(site: Site) -> None:
    states = [message.data for message in messages_on(site.files[0], "/ra1/motion_state")]
    assert {0, 1, 4} <= set(states)
    assert all(before != after for before, after in pairwise(states))


def test_tasks_are_told_as_on_their_topic(site: Site) -> None:
    texts = [yaml.safe_load(message.data) for message in messages_on(site.files[0], "/task_status")]
    assert [each["state"] for each in texts] == [change.state.value for change in site.rig.changes]
    assert texts[-1]["reason"] == "stopped"


def test_diagnostics_are_those_of_the_last_snapshot(site: Site) -> None:
    known = {
        status.name: status for array in messages_on(site.files[0], "/diagnostics") for status in array.status
    }
    for name, hardware_id, level, message, values in diagnostics(site.seen[-1][1]):
        status = known[name]
        assert (status.hardware_id, status.level, status.message) == (hardware_id, level, message)
        assert {pair.key: pair.value for pair in status.values} == values


def test_a_file_begins_with_what_was_said_last(site: Site, log: RosLog) -> None:
    again = {topic: data for topic, _, data in filter(None, log.whole())}
    last = {topic: messages_on(site.files[0], topic)[-1] for topic in again if topic != DIAGNOSTICS}
    assert {"/ra1/motion_state", "/rm_sis_a/joint_states"} <= again.keys()
    for topic, message in last.items():
        message_read = decoded(UINT8 if topic.endswith("motion_state") else JOINT_STATE, again[topic])
        fields = [name for name in ("data", "name", "position") if hasattr(message_read, name)]
        assert [getattr(message_read, name) for name in fields] == [getattr(message, name) for name in fields]
    whole = decoded(record_types.DIAGNOSTICS, again[DIAGNOSTICS])
    assert len(whole.status) == len(site.model.robots) + len(site.model.cells)


def test_each_topic_says_how_it_is_delivered(site: Site) -> None:
    with site.files[0].open("rb") as file:
        reader = make_reader(file)
        assert reader.get_header().profile == "ros2"
        summary = reader.get_summary()
    assert summary is not None
    channels = {each.topic: each for each in summary.channels.values() if each.message_encoding == "cdr"}
    assert "/task_status" in channels and "/ra3/motion_state" in channels
    for topic, channel in channels.items():
        (qos,) = yaml.safe_load(channel.metadata["offered_qos_profiles"])
        assert (qos["reliability"], qos["history"]) == (1, 1)
        assert (qos["durability"], qos["depth"]) == ((1, 100) if topic == "/task_status" else (2, 10))
        schema = summary.schemas[channel.schema_id]
        assert schema.encoding == "ros2msg" and schema.name.count("/msg/") == 1


@given(st.lists(st.tuples(TEXTS, st.floats(allow_nan=False)), max_size=4))
def test_joints_of_any_names_are_read_back(joints: list[tuple[str, float]]) -> None:
    names, positions = [name for name, _ in joints], [position for _, position in joints]
    message_read = decoded(JOINT_STATE, cdr.JointStates(names).of(1_700_000_000_123_456_789, positions))
    assert (message_read.name, list(message_read.position)) == (names, positions)
    assert (message_read.header.stamp.sec, message_read.header.stamp.nanosec) == (1_700_000_000, 123_456_789)


STATUSES = st.tuples(TEXTS, TEXTS, st.integers(0, 3), TEXTS, st.dictionaries(TEXTS, TEXTS, max_size=3))


@given(st.lists(STATUSES, max_size=3))
def test_diagnostics_of_any_texts_are_read_back(statuses: list[cdr.Status]) -> None:
    message_read = decoded(record_types.DIAGNOSTICS, cdr.diagnostics(5, statuses))
    assert [
        (
            each.name,
            each.hardware_id,
            each.level,
            each.message,
            {pair.key: pair.value for pair in each.values},
        )
        for each in message_read.status
    ] == statuses


@given(TEXTS)
def test_a_text_is_read_back(text: str) -> None:
    assert decoded(STRING, cdr.string(text)).data == text


@pytest.mark.parametrize(
    "report",
    [
        Report(at=1.0, robot="nobody", q=(0.0,)),
        Report(at=1.0, robot="ra1", q=(0.0,)),
        Report(at=1.0, robot="rm_sis_a", node=999),
    ],
)
def test_a_report_that_means_nothing_is_passed_over(report: Report) -> None:
    assert list(RosLog(shipped()).stepped(Step(0, 1.0, (report,), (), {}))) == []
