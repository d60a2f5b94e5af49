"""The advice: from whatever state a cell is in, its first line leads on, until the cell works again."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from typing import Any

import pytest
from tests.following import advised, follow, works
from tests.lengths import sample
from tests.scenario.test_advice import TASK, at, cell, stop

from arboleda.core import reasons
from arboleda.model.advice import Advice, Hand, sentence
from arboleda.model.messages import OperatorRequest, Reason, Verb
from arboleda.model.plant_model import Evidence
from arboleda.rig import faults
from arboleda.testing import Rig
from arboleda.wire.transport import Publication
from arboleda_proofs.testing import Witness

Stage = Callable[..., tuple[Rig, Witness]]


def first(rig: Rig, name: str = "sis_a") -> Advice:
    return rig.plant.advice(name)[0]


def reboot(rig: Rig) -> None:
    at(rig, "move to pick-up")
    rig.crash("ra_1")


def reboot_held(rig: Rig) -> None:
    at(rig, "move to pick-up")
    rig.operate(Verb.HOLD, "sis_a")
    rig.wait(2.0)
    rig.crash("ra_1")


def both_reboot(rig: Rig) -> None:
    rig.crash("ra_1")
    rig.crash("rm_sis_a")


def lose(rig: Rig) -> None:
    at(rig, "move to station 7")
    rig.power_off("ra_1")


def alarm(rig: Rig) -> None:
    at(rig, "move to station 7")
    rig.boards["ra_1"].fail(round(rig.now * 1e6))


def stopped_by_others(rig: Rig) -> None:
    at(rig, "move to station 7")
    rig.inject(Publication(topic="ra_1/paro", payload=b'{"paro":1,"seq":1,"epoca":1}'))


def stop_and_reboot(rig: Rig) -> None:
    stop(rig)
    rig.crash("ra_1")


def stop_of_one_in_fault(rig: Rig) -> None:
    alarm(rig)
    rig.operate(Verb.STOP)


def hold(rig: Rig) -> None:
    at(rig, "move to station 7")
    rig.operate(Verb.HOLD, "sis_a")


def let_go(rig: Rig) -> None:
    hold(rig)
    rig.wait(2.0)
    rig.operate(Verb.RELEASE, "sis_a")


TROUBLES: dict[str, Callable[[Rig], None]] = {
    each.__name__.replace("_", " "): each
    for each in (
        reboot,
        reboot_held,
        both_reboot,
        lose,
        alarm,
        stopped_by_others,
        stop,
        stop_and_reboot,
        stop_of_one_in_fault,
        hold,
        let_go,
    )
}


@pytest.mark.sampled(11)
@pytest.mark.parametrize(("trouble", "evidence"), sample(product(TROUBLES, Evidence), every=2))
def test_the_first_advice_leads_to_a_working_cell(stage: Stage, evidence: Evidence, trouble: str) -> None:
    rig, witness = stage(evidence)
    TROUBLES[trouble](rig)
    rig.wait(20.0)
    follow(rig, "sis_a")
    rig.submit("sis_a 0B 1")
    assert rig.wait(60.0, until=lambda: works(rig, "sis_a")), reasons.of_waiting(cell(rig))
    assert witness.false_successes == []


def test_after_a_reboot_in_mid_move_home_comes_first(stage: Stage) -> None:
    rig, _ = stage()
    reboot(rig)
    rig.wait(10.0)
    assert advised(rig, "sis_a") == ["home ra1", "retry sis_a", "abandon sis_a"]
    said = "sis_a is held (ra1 was not homed); home ra1, then retry sis_a or abandon sis_a"
    assert str(reasons.of_hold(cell(rig))) == said
    assert (first(rig).moves, str(first(rig).why)) == (("ra1",), "ra1 is not homed")
    assert follow(rig, "sis_a") == ["home ra1", "retry sis_a", "resume sis_a"]


def test_a_held_task_whose_arm_is_to_be_homed_can_only_be_abandoned(stage: Stage) -> None:
    rig, _ = stage()
    reboot_held(rig)
    rig.wait(2.0)
    assert advised(rig, "sis_a") == ["home ra1", "abandon sis_a"]


def test_what_is_lost_is_brought_back_first_and_what_is_back_is_not_said_to_be_lost(stage: Stage) -> None:
    rig, _ = stage()
    lose(rig)
    rig.wait(10.0)
    assert advised(rig, "sis_a")[0] == "bring ra1 back"
    assert str(first(rig).why) == "ra1 is offline"
    rig.power_on("ra_1")
    rig.wait(2.0)
    assert str(reasons.of_hold(cell(rig))).startswith("sis_a is held (ra1 was lost); home ra1, then ")
    assert "is offline" not in str(reasons.of_hold(cell(rig)))


def test_a_fault_is_repaired_first(stage: Stage) -> None:
    rig, _ = stage()
    alarm(rig)
    rig.wait(10.0)
    assert (first(rig).do, first(rig).scope) == (Hand.REPAIR, "ra1")
    rig.operate(Verb.STOP)
    rig.wait(10.0)
    assert advised(rig, "sis_a")[:3] == ["repair ra1", "clear sis_a", "reset sis_a"]
    assert str(rig.plant.advice("sis_a")[1].refusal) == "ra1 is not still yet"


def test_what_comes_later_says_why_not_yet(stage: Stage) -> None:
    rig, _ = stage()
    rig.operate(Verb.STOP)
    rig.wait(2.0)
    clear, reset, resume = rig.plant.advice("sis_a")
    assert [each.do for each in (clear, reset, resume)] == [Verb.CLEAR, Verb.RESET, Verb.RESUME]
    assert clear.refusal is None
    assert str(reset.refusal) == "sis_a is not cleared after its stop yet; clear sis_a first"
    assert "only a held cell or a paused queue can be resumed" in str(resume.refusal)


def test_what_somebody_else_stopped_is_stopped_and_cleared(stage: Stage) -> None:
    rig, _ = stage()
    rig.inject(Publication(topic="ra_1/paro", payload=b'{"paro":1,"seq":1,"epoca":1}'))
    rig.wait(2.0)
    assert str(cell(rig).not_ready) == "ra1 is stopped (latched)"
    assert advised(rig, "sis_a") == ["stop sis_a", "clear sis_a", "reset sis_a"]


@pytest.mark.parametrize("trouble", [None, reboot], ids=["working", "waiting"])
def test_there_is_no_advice_where_only_time_is_needed(stage: Stage, trouble: Any) -> None:
    rig, _ = stage()
    if trouble:
        trouble(rig)
        rig.wait(10.0)
        assert rig.operate(Verb.HOME, "ra1") is None
        rig.wait(0.2)
        assert str(reasons.of_hold(cell(rig))).endswith("; ra1 is still homing")
    else:
        rig.submit(TASK)
    assert rig.plant.advice("sis_a") == ()


def test_what_an_advice_moves_and_drops_is_said(stage: Stage) -> None:
    rig, _ = stage()
    hold(rig)
    rig.wait(2.0)
    resume, abandon = rig.plant.advice("sis_a")
    assert (resume.do, resume.moves, resume.drops) == (Verb.RESUME, ("ra1", "rm_sis_a"), ())
    assert (abandon.do, abandon.moves, abandon.instead) == (Verb.ABANDON, ("ra1",), True)


def test_a_part_that_a_failed_recovery_left_may_be_dropped_instead(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to station 7")
    truth, rig.carry = rig.carry, faults.says("ra_1", estado=2)
    assert rig.wait(20.0, until=lambda: cell(rig).task is None)
    rig.carry = truth
    rig.wait(2.0)
    retry, release, abandon = rig.plant.advice("sis_a")
    assert (retry.do, retry.moves, retry.drops) == (Verb.RETRY, ("ra1",), ())
    assert (release.do, release.moves, release.drops) == (Verb.RELEASE, (), ("ra1",))
    assert (abandon.do, abandon.moves, str(abandon.refusal)) == (
        Verb.ABANDON,
        (),
        "ra1 may hold a part; release ra1 first",
    )
    assert str(sentence((retry, release, abandon))) == "retry sis_a or release ra1, then abandon sis_a"


def test_a_cell_is_held_by_a_part_that_its_arm_may_hold(stage: Stage) -> None:
    rig, _ = stage()
    at(rig, "move to station 7")
    assert rig.operate(Verb.STOP, "sis_a") is None
    rig.wait(2.0)
    assert [rig.operate(verb, "sis_a") for verb in (Verb.CLEAR, Verb.RESET)] == [None, None]
    rig.wait(2.0)
    assert "ra1 may hold a part, its effector is on" in str(reasons.of_hold(cell(rig)))


def test_an_idle_cell_that_cannot_work_says_why(stage: Stage) -> None:
    rig, _ = stage()
    assert (cell(rig).not_ready, rig.plant.advice("sis_a")) == (None, ())
    rig.power_off("rm_sis_a")
    rig.wait(2.0)
    assert str(cell(rig).not_ready) == "rm_sis_a is offline"
    assert advised(rig, "sis_a") == ["bring rm_sis_a back"]


def test_a_queue_that_is_paused_is_resumed(stage: Stage) -> None:
    rig, _ = stage()
    for verb in (Verb.STOP, Verb.CLEAR, Verb.RESET):
        rig.operate(verb, "sis_a")
        rig.wait(2.0)
    assert str(cell(rig).not_ready) == "the queue of sis_a is paused; resume sis_a starts it"
    assert (advised(rig, "sis_a"), first(rig).moves) == (["resume sis_a"], ())
    rig.submit(TASK)
    assert first(rig).moves == ("ra1", "rm_sis_a")
    rig.power_off("ra_1")
    rig.wait(2.0)
    assert str(cell(rig).not_ready) == "ra1 is offline", "to resume would start nothing"


def test_a_home_of_a_robot_that_is_being_homed_is_refused(stage: Stage) -> None:
    rig, _ = stage()
    reboot(rig)
    rig.wait(10.0)
    assert rig.operate(Verb.HOME, "ra1") is None
    rig.wait(0.2)
    assert rig.operate(Verb.HOME, "ra1") == "ra1 is still homing"


def test_nobody_says_by_hand_that_a_robot_is_homed_which_says_that_it_is_not(stage: Stage) -> None:
    rig, _ = stage(Evidence.JOINTS)
    reboot(rig)
    rig.wait(10.0)
    said = "ra1 says that it is not homed; home ra1 at its own controls first"
    assert rig.operate(Verb.HOME, "ra1", by_hand=True) == said
    assert rig.operate(Verb.HOME, "ra1") == said
    assert advised(rig, "sis_a")[0] == "home ra1 at its own controls"
    rig.manual.put_at_reference("ra1")
    rig.wait(2.0)
    assert advised(rig, "sis_a")[0] in ("home ra1 --by-hand", "retry sis_a")


def test_to_ask_whether_a_verb_is_refused_does_nothing(stage: Stage) -> None:
    rig, _ = stage()
    hold(rig)
    rig.wait(2.0)
    before, sent = rig.snapshot(), len(rig.sent)
    request = OperatorRequest(at=rig.now, verb=Verb.STOP, scope="sis_a")
    assert rig.plant.refusal(request) is None
    assert (rig.snapshot(), len(rig.sent)) == (before, sent)
    assert cell(rig).trouble is None or cell(rig).trouble.reason is not Reason.STOPPED
