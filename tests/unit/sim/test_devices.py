"""The boards as one machine: presence, telemetry in time, routing, determinism."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from arboleda.model.plant_model import Link
from arboleda.wire.payloads import JointsGoal, PathGoal
from arboleda.wire.topics import Channel
from arboleda.wire.transport import Publication

BOARDS = ["ra_1", "rm_sis_a", "ra_3", "rm_sis_c"]


@pytest.fixture
def offline(make_bench):
    bench = make_bench()
    for board in BOARDS:
        bench.connect(board, up=False)
        bench.published[board].clear()
    return bench


def move(bench, seq=1, board="ra_1"):
    bench.send(board, Channel.JOINTS, JointsGoal(q_deg=(45.0, 9.0, 0.0), seq=seq, epoch=5))


def test_every_mqtt_robot_has_a_board_and_no_other(make_bench):
    assert list(make_bench().devices.boards) == BOARDS
    assert not make_bench(link=Link.ROS).devices.boards


def test_arms_and_mobiles_listen_to_their_own_commands(bench):
    assert set(bench.devices.subscriptions("ra_1")) == {
        "ra_1/juntas",
        "ra_1/efector",
        "ra_1/paro",
        "ra_1/referencia",
        "ra_1/latido",
    }
    assert set(bench.devices.subscriptions("rm_sis_a")) == {
        "rm_sis_a/camino",
        "rm_sis_a/paro",
        "rm_sis_a/referencia",
        "rm_sis_a/latido",
    }


def test_a_connection_is_announced_by_presence_and_telemetry(offline):
    offline.connect("ra_1")
    presence, telemetry = offline.published["ra_1"]
    assert presence == Publication(topic="ra_1/conexion", payload=b"1", qos=1, retain=True)
    assert (telemetry.topic, telemetry.qos, telemetry.retain) == ("ra_1/sensores", 0, False)
    assert not offline.published["rm_sis_a"]


def test_telemetry_comes_ten_times_a_second(bench):
    bench.run(10)
    for board in BOARDS:
        assert len(bench.heard(board)) == 101


def test_telemetry_periods_that_were_slept_through_are_not_made_up_for(bench):
    bench.now += 60
    bench.step()
    assert len(bench.heard("ra_1")) == 2
    assert bench.devices.next_deadline == pytest.approx(bench.now + 0.1)


def test_a_board_without_connection_is_silent_but_moves_on(offline):
    move(offline)
    offline.run(5)
    assert not offline.published["ra_1"]
    assert offline.devices.next_deadline is None
    offline.connect("ra_1")
    assert offline.last("ra_1").done == 1


def test_telemetry_is_numbered_from_each_boot(bench):
    bench.run(0.35)
    assert [said.seq for said in bench.heard("ra_1")] == [1, 2, 3, 4]
    bench.reboot("ra_1")
    assert bench.last("ra_1").seq == 1


def test_a_board_that_comes_back_speaks_when_its_neighbours_do(bench):
    bench.run(0.33)
    bench.connect("ra_1", up=False)
    bench.connect("ra_1")
    before = {board: len(bench.heard(board)) for board in BOARDS}
    bench.run(0.08)
    assert {board: len(bench.heard(board)) - before[board] for board in BOARDS} == dict.fromkeys(BOARDS, 1)
    assert bench.devices.next_deadline == pytest.approx(1000.5)


def test_what_a_board_says_again_has_the_next_number_and_nothing_else_new(bench):
    bench.run(0.25)
    first, second, third = bench.heard("ra_1")
    assert (second, third) == (replace(first, seq=2), replace(first, seq=3))
    bench.devices.boards["ra_1"].body.supplied = False
    bench.devices.boards["ra_1"].homed = False
    bench.run(0.1)
    assert (bench.last("ra_1").seq, bench.last("ra_1").homed) == (4, False)


def test_a_message_on_a_foreign_topic_is_ignored(bench):
    bench.send("rm_sis_a", Channel.JOINTS, JointsGoal(q_deg=(1.0, 1.0, 0.0), seq=1, epoch=5))
    assert bench.devices.boards["rm_sis_a"].refusals == 0
    assert len(bench.heard("rm_sis_a")) == 1


def test_boards_move_at_the_same_time(bench):
    move(bench)
    bench.send("rm_sis_a", Channel.PATH, PathGoal(nodes=(0, 3), seq=1, epoch=5))
    bench.run(2)
    assert (bench.last("ra_1").done, bench.last("rm_sis_a").done) == (1, 1)


def test_an_event_older_than_the_last_step_is_taken_as_of_now(bench):
    bench.run(1)
    bench.now -= 0.5
    move(bench)
    bench.run(3)
    assert bench.last("ra_1").done == 1


@settings(max_examples=25)
@given(naps=st.lists(st.floats(min_value=0.0001, max_value=0.9), min_size=1, max_size=12))
def test_late_steps_change_what_is_said_but_not_what_is_done(make_bench, naps):
    punctual, sleepy = make_bench(), make_bench()
    for bench in (punctual, sleepy):
        move(bench)
    for nap in naps:
        sleepy.now += nap
        sleepy.step()
    sleepy.run(5)
    punctual.run(5)
    here, there = sleepy.last("ra_1"), punctual.last("ra_1")
    assert (here.q_deg, here.state, here.ack, here.done) == (there.q_deg, there.state, there.ack, there.done)


def test_the_same_inputs_give_the_same_outputs(make_bench):
    first, second = make_bench(), make_bench()
    for bench in (first, second):
        move(bench)
        bench.run(0.7)
        bench.reboot("ra_1")
        bench.run(0.7)
    assert first.published == second.published
