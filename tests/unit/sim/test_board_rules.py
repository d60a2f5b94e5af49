"""Which command a board obeys: numbers, refusals, stop latch, heartbeat, reboot."""

from __future__ import annotations

import pytest

from arboleda.model.commands import StopMode
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import Evidence
from arboleda.wire.payloads import Beat, EffectorGoal, HomeGoal, JointsGoal, StopGoal
from arboleda.wire.topics import Channel

BOARD = "ra_1"
EPOCH = 50


def move(bench, seq, q=(45.0, 9.0, 0.0), epoch=EPOCH, **how):
    bench.send(BOARD, Channel.JOINTS, JointsGoal(q_deg=q, seq=seq, epoch=epoch), **how)


def stop(bench, seq, mode=StopMode.HALT, epoch=EPOCH):
    bench.send(BOARD, Channel.STOP, StopGoal(mode=mode, seq=seq, epoch=epoch))


def home(bench, seq, epoch=EPOCH):
    bench.send(BOARD, Channel.HOME, HomeGoal(seq=seq, epoch=epoch))


def effector(bench, seq, on, epoch=EPOCH):
    bench.send(BOARD, Channel.EFFECTOR, EffectorGoal(on=on, seq=seq, epoch=epoch))


def beat(bench, epoch=EPOCH):
    bench.send(BOARD, Channel.BEAT, Beat(epoch=epoch))


def refusal(bench):
    said = bench.last(BOARD)
    return said.refusal, said.refused_seq


def test_power_up_is_homed_still_and_without_numbers(bench):
    said = bench.last(BOARD)
    assert (said.state, said.homed, said.effector, said.piece) == (MotionState.STOPPED, True, False, False)
    assert (said.ack_epoch, said.ack, said.done, said.refusal) == (None, None, None, None)
    assert (said.seq, said.boot_id, said.q_deg) == (1, 100, (0.0, 0.0, 0.0))


def test_an_accepted_move_is_acknowledged_moving_and_done_at_its_end(bench):
    move(bench, 7)
    said = bench.last(BOARD)
    assert (said.state, said.ack_epoch, said.ack, said.done) == (MotionState.MOVING, EPOCH, 7, None)
    bench.run(5)
    said = bench.last(BOARD)
    assert (said.state, said.ack, said.done) == (MotionState.STOPPED, 7, 7)


@pytest.mark.parametrize(
    ("epoch", "seq"), [(EPOCH, 6), (EPOCH, 0), (EPOCH - 1, 8)], ids=["lower seq", "seq 0", "lower epoch"]
)
def test_a_number_not_greater_than_the_last_is_old(bench, epoch, seq):
    move(bench, 7)
    move(bench, seq, q=(-45.0, 0.0, 0.0), epoch=epoch)
    assert refusal(bench) == ("viejo", seq)
    assert (bench.last(BOARD).ack_epoch, bench.last(BOARD).ack) == (EPOCH, 7)
    bench.run(5)
    assert bench.last(BOARD).q_deg[0] == pytest.approx(45, abs=0.01)


def test_a_second_delivery_of_the_accepted_command_is_no_refusal(bench):
    move(bench, 7)
    move(bench, 7)
    assert refusal(bench) == (None, None)
    bench.run(5)
    assert bench.last(BOARD).done == 7


def test_a_greater_epoch_begins_its_own_numbers(bench):
    move(bench, 7)
    effector(bench, 1, on=True, epoch=EPOCH + 1)
    said = bench.last(BOARD)
    assert (said.ack_epoch, said.ack, said.done) == (EPOCH + 1, 1, None)
    bench.run(5)
    assert bench.last(BOARD).done is None


def test_a_refusal_under_a_greater_epoch_counts_for_that_epoch(bench):
    move(bench, 7)
    bench.run(5)
    move(bench, 1, q=(151.0, 0.0, 0.0), epoch=EPOCH + 1)
    said = bench.last(BOARD)
    assert (said.ack_epoch, said.ack, said.done) == (EPOCH + 1, None, None)
    assert refusal(bench) == ("limite", 1)


def test_a_retained_command_is_refused_and_the_next_one_accepted(bench):
    move(bench, 1, retain=True)
    assert refusal(bench) == ("retenido", 1)
    assert bench.last(BOARD).state is MotionState.STOPPED
    move(bench, 1)
    assert bench.last(BOARD).ack == 1


def test_a_retained_command_of_another_epoch_cannot_be_taken_for_ours(bench):
    move(bench, 7)
    move(bench, 7, epoch=EPOCH - 1, retain=True)
    assert refusal(bench) == ("retenido", 0)
    assert bench.last(BOARD).state is MotionState.MOVING


@pytest.mark.parametrize(
    ("raw", "seq"),
    [
        (b'{"q1":1,"q2":1,"seq":3,"epoca":50}', 3),
        (b'{"q1":true,"q2":1,"q3":1,"seq":3,"epoca":50}', 3),
        (b'{"q1":NaN,"q2":1,"q3":1,"seq":3,"epoca":50}', 0),
        (b'{"q1":1,"q2":1,"q3":1}', 0),
        (b'{"q1":1,"q2":1,"q3":1,"seq":3}', 3),
        (b"\xff", 0),
    ],
    ids=["missing joint", "bool", "NaN", "no numbers", "no epoch", "no text"],
)
def test_a_malformed_message_is_refused_whole_and_counted(bench, raw, seq):
    bench.send(BOARD, Channel.JOINTS, raw)
    assert refusal(bench) == ("formato", seq)
    said = bench.last(BOARD)
    assert (said.state, said.ack, said.q_deg) == (MotionState.STOPPED, None, (0.0, 0.0, 0.0))
    assert bench.devices.boards[BOARD].refusals == 1


@pytest.mark.parametrize("q", [(150.1, 0, 0), (-150.1, 0, 0), (0, 135.1, 0), (0, 0, -1.0), (0, 0, 255.6)])
def test_a_goal_beyond_a_limit_is_refused(bench, q):
    move(bench, 1, q=q)
    assert refusal(bench) == ("limite", 1)


@pytest.mark.parametrize(
    "q", [(150.0, 0, 0), (-150.0, 0, 0), (0, -135.0, 0), (0, 0, 254.6479), (0, 0, 254.7)]
)
def test_a_goal_on_its_limit_or_on_its_last_motor_step_is_accepted(bench, q):
    move(bench, 1, q=q)
    assert bench.last(BOARD).ack == 1


def test_halt_ends_a_move_without_done_and_keeps_no_latch(bench):
    move(bench, 1)
    bench.run(0.4)
    stop(bench, 2)
    assert (bench.last(BOARD).ack, bench.last(BOARD).state) == (2, MotionState.MOVING)
    bench.run(3)
    said = bench.last(BOARD)
    assert (said.state, said.done) == (MotionState.STOPPED, None)
    assert 0 < said.q_deg[0] < 45
    move(bench, 3)
    bench.run(3)
    assert bench.last(BOARD).done == 3


def test_stop_latches_when_still_until_it_is_cleared(bench):
    move(bench, 1)
    bench.run(0.4)
    stop(bench, 2, StopMode.LATCH)
    assert bench.last(BOARD).state is MotionState.MOVING
    bench.run(3)
    assert bench.last(BOARD).state is MotionState.STOP_LATCHED
    for seq, act in ((3, move), (4, home)):
        act(bench, seq)
        assert refusal(bench) == ("paro", seq)
    effector(bench, 5, on=True)
    assert refusal(bench) == ("paro", 5)
    stop(bench, 6, StopMode.CLEAR)
    assert bench.last(BOARD).state is MotionState.STOPPED
    move(bench, 7)
    assert bench.last(BOARD).state is MotionState.MOVING


def test_a_latched_board_still_releases_its_effector(bench):
    effector(bench, 1, on=True)
    stop(bench, 2, StopMode.LATCH)
    effector(bench, 3, on=False)
    assert (bench.last(BOARD).ack, bench.last(BOARD).effector) == (3, False)


@pytest.mark.parametrize(("epoch", "seq"), [(EPOCH, 3), (EPOCH - 9, 900)], ids=["old seq", "old epoch"])
@pytest.mark.parametrize("mode", [StopMode.LATCH, StopMode.HALT])
def test_a_stop_is_obeyed_whatever_its_number(bench, epoch, seq, mode):
    move(bench, 7)
    bench.run(0.4)
    stop(bench, seq, mode, epoch=epoch)
    assert refusal(bench) == ("viejo", seq)
    bench.run(3)
    said = bench.last(BOARD)
    assert said.q_deg[0] < 45
    assert said.done is None
    assert said.state is (MotionState.STOP_LATCHED if mode is StopMode.LATCH else MotionState.STOPPED)


def test_a_stop_without_numbers_is_obeyed(bench):
    move(bench, 7)
    bench.run(0.4)
    stop(bench, None, epoch=None)
    bench.run(3)
    assert bench.last(BOARD).q_deg[0] < 45


def test_an_old_clear_does_not_clear(bench):
    stop(bench, 7, StopMode.LATCH)
    stop(bench, 6, StopMode.CLEAR)
    assert refusal(bench) == ("viejo", 6)
    assert bench.last(BOARD).state is MotionState.STOP_LATCHED


def test_homing_loses_the_reference_first_and_refuses_motion(bench):
    move(bench, 1)
    bench.run(3)
    home(bench, 2)
    assert (bench.last(BOARD).homed, bench.last(BOARD).state) == (False, MotionState.MOVING)
    move(bench, 3)
    assert refusal(bench) == ("ocupado", 3)
    home(bench, 4)
    assert refusal(bench) == ("ocupado", 4)
    bench.run(3)
    said = bench.last(BOARD)
    assert (said.homed, said.state, said.done, said.q_deg) == (True, MotionState.STOPPED, 2, (0.0, 0.0, 0.0))


def test_a_homing_that_is_halted_leaves_no_reference(bench):
    move(bench, 1)
    bench.run(3)
    home(bench, 2)
    bench.run(0.3)
    stop(bench, 3)
    bench.run(3)
    said = bench.last(BOARD)
    assert (said.homed, said.state, said.done) == (False, MotionState.NOT_HOMED, 1)
    move(bench, 4)
    assert refusal(bench) == ("sin_ref", 4)


def test_a_reboot_forgets_position_reference_numbers_latch_and_grip(bench):
    effector(bench, 8, on=True)
    move(bench, 9)
    bench.run(0.4)
    bench.reboot(BOARD)
    said = bench.last(BOARD)
    assert (said.state, said.homed, said.q_deg) == (MotionState.NOT_HOMED, False, (0.0, 0.0, 0.0))
    assert (said.ack_epoch, said.ack, said.effector, said.piece) == (None, None, False, False)
    assert (said.seq, said.boot_id) == (1, 104)
    move(bench, 1)
    assert refusal(bench) == ("sin_ref", 1)
    home(bench, 2)
    bench.run(1)
    assert (bench.last(BOARD).homed, bench.last(BOARD).done) == (True, 2)


def test_a_board_without_homing_trusts_its_position_after_a_reboot(make_bench):
    bench = make_bench(assume_homed=True)
    bench.reboot(BOARD)
    assert (bench.last(BOARD).homed, bench.last(BOARD).state) == (True, MotionState.STOPPED)


def test_one_second_without_a_beat_while_moving_ramps_to_a_stop(bench):
    beat(bench)
    move(bench, 1, q=(150.0, 0.0, 0.0))
    bench.run(1.01)
    assert bench.last(BOARD).state is MotionState.MOVING
    bench.run(3)
    said = bench.last(BOARD)
    assert (said.state, said.done) == (MotionState.STOPPED, None)
    assert 60 < said.q_deg[0] < 100


def test_beats_keep_a_move_going(bench):
    move(bench, 1, q=(150.0, 0.0, 0.0))
    for _ in range(4):
        beat(bench)
        bench.run(0.9)
    assert bench.last(BOARD).done == 1


def test_beats_of_the_next_bridge_do_not_keep_a_move_of_the_last_going(bench):
    beat(bench)
    move(bench, 1, q=(150.0, 0.0, 0.0))
    for _ in range(4):
        beat(bench, epoch=EPOCH + 1)
        bench.run(0.9)
    said = bench.last(BOARD)
    assert (said.state, said.done) == (MotionState.STOPPED, None)


def test_a_beat_is_enough_to_refuse_whoever_commanded_before(bench):
    move(bench, 7)
    bench.run(5)
    beat(bench, epoch=EPOCH + 1)
    bench.run(0.1)
    said = bench.last(BOARD)
    assert (said.ack_epoch, said.ack, said.done, said.least_epoch) == (EPOCH, 7, 7, EPOCH + 1)
    move(bench, 8, q=(0.0, 0.0, 0.0))
    assert refusal(bench) == ("viejo", 8)
    assert bench.last(BOARD).state is MotionState.STOPPED
    effector(bench, 1, on=True, epoch=EPOCH + 1)
    said = bench.last(BOARD)
    assert (said.ack_epoch, said.ack, said.least_epoch, said.refusal) == (EPOCH + 1, 1, None, None)


def test_a_board_that_has_heard_no_command_is_fenced_by_a_beat_too(bench):
    beat(bench)
    move(bench, 1, epoch=EPOCH - 1)
    assert refusal(bench) == ("viejo", 1)


def test_a_stop_of_whoever_commanded_before_is_obeyed(bench):
    move(bench, 1, q=(150.0, 0.0, 0.0))
    beat(bench, epoch=EPOCH + 1)
    stop(bench, 2)
    bench.run(2)
    assert bench.last(BOARD).state is MotionState.STOPPED
    assert bench.last(BOARD).done is None


@pytest.mark.parametrize("epoch", [EPOCH + 366 * 86_400 + 1, 2**32 - 1])
def test_a_beat_of_the_far_future_fences_nobody_off(bench, epoch):
    move(bench, 1)
    beat(bench, epoch=epoch)
    assert refusal(bench) == ("formato", 0)
    effector(bench, 2, on=True)
    assert bench.last(BOARD).ack == 2


@pytest.mark.parametrize(("epoch", "least"), [(4_102_444_800, 4_102_444_800), (4_102_444_801, None)])
def test_before_any_command_a_beat_may_be_of_this_century(bench, epoch, least):
    beat(bench, epoch=epoch)
    bench.run(0.1)
    assert bench.last(BOARD).least_epoch == least


def test_beats_of_an_older_epoch_do_not_count(bench):
    beat(bench)
    move(bench, 1, q=(150.0, 0.0, 0.0))
    for _ in range(4):
        bench.run(0.9)
        beat(bench, epoch=EPOCH - 1)
    assert bench.last(BOARD).done is None
    assert bench.last(BOARD).state is MotionState.STOPPED


def test_a_board_that_never_heard_a_beat_moves_on_in_silence(bench):
    move(bench, 1, q=(150.0, 0.0, 0.0))
    bench.connect(BOARD, up=False)
    bench.run(5)
    bench.connect(BOARD)
    assert bench.last(BOARD).done == 1


@pytest.mark.parametrize("evidence", [Evidence.JOINTS, Evidence.STATE])
def test_an_older_board_obeys_without_numbers_and_tells_only_joints_and_state(make_bench, evidence):
    bench = make_bench(evidence=evidence)
    move(bench, None, epoch=None)
    assert bench.last(BOARD).state is MotionState.MOVING
    bench.run(5)
    assert set(bench.published[BOARD][-1].payload.split(b'"')[1::2]) == {
        b"q1_mov",
        b"q2_mov",
        b"q3_mov",
        b"estado",
    }
    assert bench.last(BOARD).q_deg[0] == pytest.approx(45, abs=0.01)
    stop(bench, None, StopMode.LATCH, epoch=None)
    assert bench.last(BOARD).state is MotionState.STOP_LATCHED


def test_a_board_without_paro_does_not_listen_to_it(make_bench):
    bench = make_bench(has_stop=False)
    assert "ra_1/paro" not in bench.devices.subscriptions(BOARD)
    move(bench, 1)
    stop(bench, 2)
    bench.run(5)
    assert bench.last(BOARD).done == 1


FIRST = 1  # the telemetry with which the board came up


def told(bench) -> int:
    return bench.last(BOARD).seq


def test_a_command_is_taken_whose_giver_heard_the_board_a_moment_ago(bench):
    bench.run(5)
    bench.send(
        BOARD, Channel.JOINTS, JointsGoal(q_deg=(45.0, 9.0, 0.0), seq=1, epoch=EPOCH, heard=told(bench))
    )
    assert (refusal(bench), bench.last(BOARD).ack) == ((None, None), 1)


@pytest.mark.parametrize(
    ("channel", "goal"),
    [
        (Channel.JOINTS, JointsGoal(q_deg=(45.0, 9.0, 0.0), seq=1, epoch=EPOCH, heard=FIRST)),
        (Channel.EFFECTOR, EffectorGoal(on=False, seq=1, epoch=EPOCH, heard=FIRST)),
        (Channel.HOME, HomeGoal(seq=1, epoch=EPOCH, heard=FIRST)),
    ],
    ids=["a move", "letting go", "homing"],
)
def test_a_command_that_waited_for_longer_than_two_seconds_is_too_late(bench, channel, goal):
    bench.run(2.1)
    bench.send(BOARD, channel, goal)
    said = bench.last(BOARD)
    assert (refusal(bench), said.state, said.ack) == (("tarde", 1), MotionState.STOPPED, None)


def test_a_command_that_names_what_was_told_before_a_boot_is_too_late(bench):
    bench.run(5)
    heard = told(bench)
    bench.reboot(BOARD)
    bench.send(BOARD, Channel.EFFECTOR, EffectorGoal(on=True, seq=1, epoch=EPOCH, heard=heard))
    assert refusal(bench) == ("tarde", 1)


def test_a_late_command_makes_the_numbers_after_it_no_older(bench):
    bench.run(3)
    bench.send(BOARD, Channel.EFFECTOR, EffectorGoal(on=True, seq=7, epoch=EPOCH, heard=FIRST))
    bench.send(BOARD, Channel.EFFECTOR, EffectorGoal(on=True, seq=8, epoch=EPOCH, heard=told(bench)))
    assert (bench.last(BOARD).ack, bench.last(BOARD).effector) == (8, True)


def test_a_stop_is_never_too_late(bench):
    move(bench, 1)
    bench.send(BOARD, Channel.STOP, b'{"paro":2,"seq":2,"epoca":%d,"visto":0}' % EPOCH)
    assert (refusal(bench), bench.last(BOARD).ack) == ((None, None), 2)


def test_the_tokens_of_the_last_accepted_and_the_last_done_command_are_echoed(bench):
    goal = JointsGoal(q_deg=(45.0, 9.0, 0.0), seq=1, epoch=EPOCH, token="0a3f9x001a01")
    bench.send(BOARD, Channel.JOINTS, goal)
    assert (bench.last(BOARD).ack_token, bench.last(BOARD).done_token) == ("0a3f9x001a01", None)
    bench.run(5)
    bench.send(BOARD, Channel.EFFECTOR, EffectorGoal(on=True, seq=2, epoch=EPOCH, token="b"))
    assert (bench.last(BOARD).ack_token, bench.last(BOARD).done_token) == ("b", "0a3f9x001a01")


def test_a_command_without_a_token_takes_the_place_of_the_one_before(bench):
    bench.send(BOARD, Channel.EFFECTOR, EffectorGoal(on=True, seq=1, epoch=EPOCH, token="b"))
    stop(bench, 2)
    assert (bench.last(BOARD).ack, bench.last(BOARD).ack_token) == (2, None)


def test_a_refused_command_and_another_epoch_leave_no_token_of_theirs(bench):
    far = JointsGoal(q_deg=(999.0, 9.0, 0.0), seq=2, epoch=EPOCH, token="far")
    bench.send(BOARD, Channel.EFFECTOR, EffectorGoal(on=True, seq=1, epoch=EPOCH, token="b"))
    bench.send(BOARD, Channel.JOINTS, far)
    assert bench.last(BOARD).ack_token == "b"
    bench.send(BOARD, Channel.JOINTS, JointsGoal(q_deg=far.q_deg, seq=1, epoch=EPOCH + 1, token="far"))
    assert (bench.last(BOARD).ack, bench.last(BOARD).ack_token) == (None, None)
