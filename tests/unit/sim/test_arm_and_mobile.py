"""How the virtual robots move: joints, effector and piece, grid nodes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from arboleda.model.commands import StopMode
from arboleda.model.messages import MotionState
from arboleda.sim.arm import ArmBody
from arboleda.testing import shipped
from arboleda.wire.payloads import Beat, EffectorGoal, HomeGoal, JointsGoal, PathGoal, StopGoal
from arboleda.wire.topics import Channel

ARM, SIX_AXES, CART = "ra_1", "ra_3", "rm_sis_a"
PICKUP = (45.0, 9.9, 0.0)  # 10 deg are 11 steps of 0.9 deg
EPOCH = 50


class Sender:
    """Sends commands with numbers that count up."""

    def __init__(self, bench, board):
        self.bench, self.board, self.seq = bench, board, 0

    def __call__(self, channel, goal, **fields):
        self.seq += 1
        self.bench.send(self.board, channel, goal(**fields, seq=self.seq, epoch=EPOCH))

    def move(self, *q):
        self(Channel.JOINTS, JointsGoal, q_deg=q)

    def go(self, *q):
        """Move there and arrive."""
        self.move(*q)
        self.bench.run(5)

    def drive(self, *nodes):
        self(Channel.PATH, PathGoal, nodes=nodes)

    def effector(self, on):
        self(Channel.EFFECTOR, EffectorGoal, on=on)

    def stop(self, mode=StopMode.HALT):
        self(Channel.STOP, StopGoal, mode=mode)

    def home(self):
        self(Channel.HOME, HomeGoal)


@pytest.fixture
def arm(bench):
    return Sender(bench, ARM)


@pytest.fixture
def cart(bench):
    return Sender(bench, CART)


def nodes_seen(bench):
    seen = []
    for said in bench.heard(CART):
        if not seen or seen[-1] != said.node:
            seen.append(said.node)
    return seen


def test_targets_are_rounded_to_the_nearest_motor_step(arm, bench):
    arm.go(45.0, 10.0, 50.0)
    assert bench.last(ARM).q_deg == (round(2333 * 0.01929, 4), 9.9, 50.4)
    assert bench.devices.boards[ARM].body.motors.position == (2333, 11, 56)


def test_targets_below_zero_are_rounded_alike(arm, bench):
    arm.go(-45.0, -10.0, 0.0)
    assert bench.devices.boards[ARM].body.motors.position == (-2333, -11, 0)


def test_a_move_takes_the_time_of_its_ramp(arm, bench):
    joint = bench.devices.boards[ARM].body._joints[0]
    start = bench.now
    arm.move(90.0, 0.0, 0.0)
    while bench.last(ARM).state is MotionState.MOVING:
        bench.now = bench.devices.next_deadline
        bench.step()
    assert bench.now - start == pytest.approx(joint.travel_s(joint.quantised(1.5708)), rel=0.02)


def test_six_axes_move_together_and_end_with_the_slowest(bench):
    arm = Sender(bench, SIX_AXES)
    arm.go(35.0, 10.0, -5.0, 1.0, 2.0, -3.0)
    assert bench.last(SIX_AXES).q_deg == (35.0, 10.0, -5.0, 1.0, 2.0, -3.0)
    assert bench.last(SIX_AXES).done == 1


@pytest.mark.parametrize("rate", [10, 1000, 100_000])
def test_axes_faster_than_the_board_can_step_still_arrive(rate):
    six_axes = shipped().robots["ra3"]
    fast = (
        replace(joint, speed=joint.speed * rate, acceleration=joint.acceleration * rate**2)
        for joint in six_axes.joints
    )
    body = ArmBody(replace(six_axes, joints=tuple(fast)), start=(0.0,) * 6, pickups=())
    body.start(10_000_000, JointsGoal(q_deg=(350.0, 10.0, -5.0, 0.01, 0.0, 0.0), seq=1, epoch=1))
    body.advance(body.next_change_us)
    assert body.motors.position == (35000, 1000, -500, 1, 0, 0)


def test_a_move_to_where_the_arm_stands_is_moving_once_and_then_done(arm, bench):
    arm.move(0.0, 0.0, 0.0)
    bench.run(0.01)
    states = [(said.state, said.done) for said in bench.heard(ARM)[1:]]
    assert states == [(MotionState.MOVING, None), (MotionState.STOPPED, 1)]


def test_a_new_goal_replaces_the_one_under_way(arm, bench):
    arm.move(90.0, 0.0, 0.0)
    bench.run(0.5)
    arm.go(-9.0, 0.0, 0.0)
    assert bench.last(ARM).q_deg[0] == pytest.approx(-9, abs=0.01)
    assert {said.done for said in bench.heard(ARM)} == {None, 2}


def test_the_arm_carries_a_piece_from_its_pickup_to_where_it_lets_go(arm, bench):
    seen = []
    for act in (
        lambda: arm.move(*PICKUP),
        lambda: arm.effector(True),
        lambda: arm.move(20.0, 20.0, 0.0),
        lambda: arm.effector(False),
        lambda: arm.move(0.0, 0.0, 0.0),
    ):
        act()
        bench.run(5)
        seen.append((bench.last(ARM).effector, bench.last(ARM).piece))
    assert seen == [(False, True), (True, True), (True, True), (False, False), (False, False)]


def test_an_effector_that_arrives_switched_on_grips(arm, bench):
    arm.effector(True)
    assert bench.last(ARM).piece is False
    arm.go(*PICKUP)
    arm.go(0.0, 0.0, 0.0)
    assert bench.last(ARM).piece is True


def test_an_effector_left_off_takes_nothing_along(arm, bench):
    arm.go(*PICKUP)
    arm.go(0.0, 0.0, 0.0)
    assert bench.last(ARM).piece is False


def test_a_mobile_reports_every_node_as_it_arrives(cart, bench):
    cart.drive(0, 3, 4, 7)
    bench.run(2.5)
    assert (nodes_seen(bench), bench.last(CART).state) == ([0, 3, 4], MotionState.MOVING)
    bench.run(1)
    said = bench.last(CART)
    assert (nodes_seen(bench), said.state, said.done) == ([0, 3, 4, 7], MotionState.STOPPED, 1)


def test_a_path_may_begin_next_door(cart, bench):
    cart.drive(1, 2)
    bench.run(3)
    assert nodes_seen(bench) == [0, 1, 2]


def test_a_path_to_where_the_mobile_stands_is_done(cart, bench):
    cart.drive(0)
    assert bench.last(CART).state is MotionState.MOVING
    bench.run(0.01)
    assert (bench.last(CART).state, bench.last(CART).done) == (MotionState.STOPPED, 1)


@pytest.mark.parametrize("nodes", [(4, 7), (0, 4), (0, 0), (0, 3, 9), (2, 5), (1, 2, 3)])
def test_a_path_that_leaves_the_edges_of_the_grid_is_refused(cart, bench, nodes):
    cart.drive(*nodes)
    said = bench.last(CART)
    assert (said.refusal, said.refused_seq, said.state) == ("limite", 1, MotionState.STOPPED)


def test_a_halt_stops_at_the_next_node(cart, bench):
    cart.drive(0, 3, 4, 7)
    bench.run(1.5)
    cart.stop()
    assert bench.last(CART).state is MotionState.MOVING
    bench.run(3)
    said = bench.last(CART)
    assert (said.node, said.state, said.done) == (4, MotionState.STOPPED, None)


def test_a_stop_latches_at_the_next_node(cart, bench):
    cart.drive(0, 3, 4, 7)
    cart.stop(StopMode.LATCH)
    bench.run(3)
    assert (bench.last(CART).node, bench.last(CART).state) == (3, MotionState.STOP_LATCHED)


def test_silence_stops_a_mobile_at_the_next_node(cart, bench):
    bench.send(CART, Channel.BEAT, Beat(epoch=EPOCH))
    cart.drive(0, 3, 4, 7)
    bench.run(5)
    assert bench.last(CART).node in (3, 4)
    assert bench.last(CART).done is None


def test_a_new_path_begins_where_the_edge_under_way_ends(cart, bench):
    cart.drive(0, 3, 4, 7)
    bench.run(0.5)
    cart.drive(3, 6)
    bench.run(3)
    assert (nodes_seen(bench), bench.last(CART).done) == ([0, 3, 6], 2)


def test_homing_drives_a_mobile_back_to_its_start(cart, bench):
    cart.drive(0, 3, 4, 7)
    bench.run(4)
    cart.home()
    assert bench.last(CART).homed is False
    bench.run(4)
    said = bench.last(CART)
    assert (said.node, said.homed, said.done) == (0, True, 2)


def test_a_mobile_says_nothing_of_effector_and_piece(bench):
    said = bench.last(CART)
    assert (said.effector, said.piece, said.q_deg, said.node) == (None, None, None, 0)
