"""An arm whose hardware tells of stops: a test plays its topic, and the calls that clear them."""

from __future__ import annotations

import pytest

from arboleda.drivers import Home, MotionState, Stop, StopMode
from arboleda.drivers.port import DriverError
from arboleda_drivers.joint_trajectory.machine import machine
from arboleda_drivers.joint_trajectory.settings import Settings
from arboleda_drivers.ros_action.events import CancelAll, CancelAnswer, MakeCall
from arboleda_drivers.ros_action.health import READY_S, Call, CallAnswer, Health, HealthReading
from arboleda_drivers.ros_action.health_link import HealthLink

from ..joint_trajectory.test_joint_trajectory import ARM, GO, HALT, Rig

RUNNING, PROTECTIVE_STOP, UNNAMED = 1, 3, 9
UNLOCK = Call(service="dashboard_client/unlock_protective_stop", type="std_srvs/srv/Trigger")
PLAY = Call(service="dashboard_client/play", type="std_srvs/srv/Trigger")
HEALTH = Health(
    topic="safety_mode",
    type="ur_dashboard_msgs/msg/SafetyMode",
    field="mode",
    well=(RUNNING, 2),
    words={"protective_stop": PROTECTIVE_STOP},
    clear=(UNLOCK, PLAY),
)
HOME = Home(id="9-7", robot=ARM.name)


class HealthRig(Rig):
    """The machine of an arm with health, of which nothing was heard yet."""

    def __init__(self, health: Health = HEALTH) -> None:
        super().__init__()
        self.machine = machine([ARM], Settings(health=health))
        self.said.clear()
        self.wait(0.5)

    def read(self, value: int) -> None:
        self.tell(HealthReading(value=value))

    @property
    def calls(self) -> list[Call]:
        return [each.call for each in self.said if isinstance(each, MakeCall)]


@pytest.fixture
def rig() -> HealthRig:
    rig = HealthRig()
    rig.read(RUNNING)
    rig.wait(0.5)
    return rig


def test_an_arm_is_offline_until_its_health_was_heard():
    rig = HealthRig()
    assert str(rig.last.lost) == "safety_mode has said nothing yet"
    rig.read(RUNNING)
    assert (rig.last.state, rig.last.fact("health")) == (MotionState.STOPPED, "ok")


@pytest.mark.parametrize(("value", "word"), [(PROTECTIVE_STOP, "protective_stop"), (UNNAMED, "mode 9")])
def test_a_stop_ends_the_goal_by_its_word_and_shows_as_a_fault(rig: HealthRig, value: int, word: str):
    rig.under_way()
    rig.read(value)
    assert (rig.last.failed, rig.last.failure) == (GO.id, word)
    assert rig.count(CancelAll) == 1
    rig.tell(CancelAnswer(refused=False))
    rig.wait(0.5)
    assert (rig.last.state, rig.last.fact("health")) == (MotionState.FAULT, word)


def test_no_goal_is_sent_into_a_stop(rig: HealthRig):
    rig.read(PROTECTIVE_STOP)
    rig.ask(GO)
    assert (rig.last.rejected, rig.last.refusal) == (GO.id, "protective_stop")


def test_homing_makes_the_calls_in_turn_and_ends_once_the_topic_shows_it(rig: HealthRig):
    rig.read(PROTECTIVE_STOP)
    rig.ask(HOME)
    assert (rig.last.accepted, rig.last.state, rig.last.homed) == (HOME.id, MotionState.NOT_HOMED, False)
    assert rig.calls == [UNLOCK]
    rig.tell(CallAnswer(call=UNLOCK, ok=True))
    rig.tell(CallAnswer(call=PLAY, ok=True))
    rig.wait(1.0)
    assert rig.calls == [UNLOCK, PLAY] and rig.last.done is None  # no answer proves that the arm is free
    rig.read(RUNNING)
    rig.wait(0.1)
    assert (rig.last.done, rig.last.state, rig.last.homed) == (HOME.id, MotionState.STOPPED, True)


def test_a_call_that_is_refused_fails_the_homing_by_its_text_and_ends_the_calls(rig: HealthRig):
    rig.read(PROTECTIVE_STOP)
    rig.ask(HOME)
    rig.tell(CallAnswer(call=UNLOCK, ok=False, text="5 s have to pass"))
    assert (rig.last.failed, rig.last.failure) == (HOME.id, f"{UNLOCK.name} 5 s have to pass")
    assert rig.calls == [UNLOCK] and rig.last.state is MotionState.FAULT


@pytest.mark.parametrize(
    ("answers", "failure"), [(1, f"{PLAY.name} not_answered"), (2, "still protective_stop")]
)
def test_a_stop_that_stays_fails_the_homing_in_time(rig: HealthRig, answers: int, failure: str):
    rig.read(PROTECTIVE_STOP)
    rig.ask(HOME)
    for call in (UNLOCK, PLAY)[:answers]:
        rig.tell(CallAnswer(call=call, ok=True))
    rig.wait(READY_S - 1)
    assert rig.last.failed is None
    rig.wait(2.0)
    assert (rig.last.failed, rig.last.failure) == (HOME.id, failure)


def test_an_answer_of_a_call_that_nobody_waits_for_changes_nothing(rig: HealthRig):
    rig.read(PROTECTIVE_STOP)
    rig.ask(HOME)
    rig.tell(CallAnswer(call=PLAY, ok=True))
    assert rig.calls == [UNLOCK]
    rig.ask(HALT)
    rig.tell(CallAnswer(call=UNLOCK, ok=True))
    assert rig.calls == [UNLOCK]  # a stop ends the homing, and with it the calls


def test_without_calls_homing_is_rejected_by_the_word():
    rig = HealthRig(Health(topic="t", type="std_msgs/msg/Int32", field="data", well=(RUNNING,)))
    rig.read(PROTECTIVE_STOP)
    rig.wait(0.5)
    rig.ask(HOME)
    assert (rig.last.rejected, rig.last.refusal) == (HOME.id, "data 3")
    assert rig.last.state is MotionState.FAULT


def test_a_latched_stop_shows_before_the_fault_so_that_it_can_be_cleared(rig: HealthRig):
    rig.read(PROTECTIVE_STOP)
    rig.ask(Stop(id="9-8", robot=ARM.name, mode=StopMode.LATCH))
    rig.tell(CancelAnswer(refused=False))
    rig.wait(0.5)
    assert (rig.last.state, rig.last.fact("health")) == (MotionState.STOP_LATCHED, "protective_stop")
    rig.ask(Stop(id="9-9", robot=ARM.name, mode=StopMode.CLEAR))
    assert rig.last.state is MotionState.FAULT


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        (lambda: Call(type="std_srvs/srv/Trigger"), "either a service or an action"),
        (lambda: Call(type="Trigger", service="x"), "type is Trigger; it is written as std_srvs/srv/Trigger"),
        (lambda: Call(type="std_srvs/srv/Trigger", action="x"), "franka_msgs/action/ErrorRecovery"),
        (lambda: Health(topic="t", type="std_msgs/Int32", field="f", well=(1,)), "std_msgs/msg/Int32"),
        (lambda: Health(topic="t", type="std_msgs/msg/Int32", field="f", well=()), "well is empty"),
        (
            lambda: Health(topic="t", type="a/msg/B", field="f", well=(1,), words={"ok": 2}),
            '"ok" is the word',
        ),
    ],
)
def test_settings_that_cannot_be_meant_are_refused_with_what_is_allowed(settings, sentence: str):
    with pytest.raises(ValueError, match=sentence):
        settings()


@pytest.mark.requires("rclpy")
def test_a_type_that_is_not_installed_is_told_with_what_to_install() -> None:
    unknown = Health(topic="t", type="ur_dashboard_msgs/msg/SafetyMode", field="mode", well=(1,))
    with pytest.raises(
        DriverError, match=r"package ur_dashboard_msgs, .*apt install ros-.*-ur-dashboard-msgs"
    ):
        HealthLink(None, unknown, lambda message, event: None)
