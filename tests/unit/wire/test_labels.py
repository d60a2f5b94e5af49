"""Whose command a board has accepted."""

from __future__ import annotations

import pytest

from arboleda.model.commands import Home
from arboleda.model.messages import MotionState
from arboleda.wire.labels import Labels
from arboleda.wire.strict import UINT32
from arboleda.wire.values import Telemetry


def accepted(epoch: int, seq: int) -> Telemetry:
    return Telemetry(state=MotionState.STOPPED, q_deg=None, node=0, ack_epoch=epoch, ack=seq)


@pytest.mark.parametrize("epoch", [999, 1000, 1001, UINT32])
def test_what_a_board_has_accepted_before_our_first_command_is_nobody_elses(epoch: int) -> None:
    labels = Labels(1000)
    labels.hear(accepted(epoch, 7))
    assert labels.foreign is None


def test_a_number_above_ours_is_somebody_elses_and_told_once() -> None:
    labels = Labels(1000)
    labels.issue(Home(id="1-1", robot="ra1"))
    labels.hear(accepted(1000, 2))
    assert labels.foreign == (1000, 2)
    labels.hear(accepted(1000, 2))
    assert labels.foreign is None


def led(least_epoch: int) -> Telemetry:
    return Telemetry(state=MotionState.STOPPED, q_deg=None, node=0, least_epoch=least_epoch)


def test_a_number_of_our_epoch_before_our_first_command_is_somebody_elses() -> None:
    labels = Labels(1000)
    labels.hear(led(1000))
    labels.hear(accepted(1000, 5000))
    assert labels.foreign == (1000, 5000)


def test_what_was_given_before_a_rise_is_known_by_its_own_epoch_alone() -> None:
    labels = Labels(1000)
    seq = labels.issue(Home(id="1-1", robot="ra1"))
    labels.hear(led(1050))
    assert (labels.beaten_by, labels.epoch) == (1050, 1000)
    labels.rise()
    labels.hear(accepted(1000, seq))
    assert (labels.epoch, labels.start, labels.accepted, labels.foreign) == (1051, 1000, "1-1", None)
    labels.hear(accepted(1051, seq))
    assert labels.accepted is None


def test_a_refusal_is_new_once_and_again_after_a_reboot() -> None:
    labels = Labels(1000)
    labels.issue(Home(id="1-1", robot="ra1"))
    refusal = {"ack_epoch": 1000, "refused_seq": 1, "refusal": "paro"}
    said = Telemetry(state=MotionState.STOPPED, q_deg=None, node=0, **refusal)
    heard = []
    for _ in range(2):
        labels.hear(said)
        heard.append(labels.objection is not None)
    labels.reboot()
    labels.hear(said)
    assert [*heard, labels.objection is not None] == [True, False, True]
