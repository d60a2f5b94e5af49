"""What a virtual robot truly does beside what its board counts and says."""

from __future__ import annotations

import pytest

from arboleda.model.commands import StopMode
from arboleda.model.messages import MotionState
from arboleda.wire.payloads import EffectorGoal, HomeGoal, JointsGoal, PathGoal, StopGoal
from arboleda.wire.topics import Channel

ARM, CART = "ra_1", "rm_sis_a"


@pytest.fixture
def arm(bench):
    return bench.devices.boards[ARM]


@pytest.fixture
def cart(bench):
    return bench.devices.boards[CART]


def go(bench, seq=1, q1=18.0):
    bench.send(ARM, Channel.JOINTS, JointsGoal(q_deg=(q1, 0.0, 0.0), seq=seq, epoch=50))
    bench.run(5)


def test_a_reboot_forgets_the_position_and_moves_nothing(bench, arm):
    go(bench)
    stood = arm.body.motors.position
    bench.reboot(ARM)
    assert arm.body.motors.position == (0, 0, 0) != stood
    assert arm.body.motors.true_position == stood


def test_homing_finds_the_true_reference_whatever_was_counted(bench, arm):
    go(bench)
    bench.reboot(ARM)
    bench.send(ARM, Channel.HOME, HomeGoal(seq=2, epoch=50))
    assert arm.body.moving
    bench.run(5)
    assert arm.body.motors.position == arm.body.motors.true_position == (0, 0, 0)


def test_lost_steps_show_in_the_true_position_alone(bench, arm):
    go(bench)
    stood = arm.body.motors.position
    arm.body.motors.lose_steps(0, -7)
    assert arm.body.motors.position == stood
    assert arm.body.motors.true_position[0] == stood[0] - 7


def test_a_hand_puts_the_robot_at_its_reference_and_has_it_count_from_there(bench, arm, cart):
    go(bench)
    arm.body.motors.lose_steps(0, 5)
    arm.body.put_at_reference()
    cart.body.node, cart.body.true_node = 4, 3
    cart.body.put_at_reference()
    assert arm.body.motors.position == arm.body.motors.true_position == (0, 0, 0)
    assert cart.body.true_node == cart.body.node == 0


def test_a_stuck_effector_does_not_follow(bench, arm):
    arm.body.stuck = True
    bench.send(ARM, Channel.EFFECTOR, EffectorGoal(on=True, seq=1, epoch=50))
    assert not arm.body.effector
    assert bench.last(ARM).effector is False


def test_a_fault_ends_the_move_and_refuses_the_next_until_it_is_repaired(bench, arm):
    bench.send(ARM, Channel.JOINTS, JointsGoal(q_deg=(90.0, 0.0, 0.0), seq=1, epoch=50))
    bench.run(0.5)
    arm.fail(round(bench.now * 1e6))
    bench.run(2)
    assert bench.last(ARM).state is MotionState.FAULT
    go(bench, seq=2)
    assert bench.last(ARM).refusal == "ocupado"
    arm.repair(round(bench.now * 1e6))
    go(bench, seq=3)
    assert bench.last(ARM).done == 3


def test_a_mobile_beside_its_way_drives_the_same_edges_up_to_the_border(bench, cart):
    cart.body.true_node = 1
    bench.send(CART, Channel.PATH, PathGoal(nodes=(0, 1, 2, 5), seq=1, epoch=50))
    bench.run(20)
    assert cart.body.node == 5
    assert cart.body.true_node == 5, "right to 2, against the border, down to 5"


def test_every_command_that_is_carried_out_is_told(bench, arm):
    told = []
    arm.watch = told.append
    go(bench)
    go(bench)
    assert [goal.seq for goal in told] == [1], "the second one came twice"


def test_a_stop_that_is_told_again_does_not_drive_the_arm_further(bench, arm):
    def way(stops):
        bench.reboot(ARM)
        bench.send(ARM, Channel.HOME, HomeGoal(seq=1, epoch=50))
        bench.run(5)
        bench.send(ARM, Channel.JOINTS, JointsGoal(q_deg=(90.0, 0.0, 0.0), seq=2, epoch=50))
        bench.run(0.05)
        for number in range(stops):
            bench.send(ARM, Channel.STOP, StopGoal(mode=StopMode.HALT, seq=3 + number, epoch=50))
        bench.run(5)
        return arm.body.motors.position

    assert way(stops=5) == way(stops=1)
