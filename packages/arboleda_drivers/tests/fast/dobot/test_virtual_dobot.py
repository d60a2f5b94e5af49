"""The virtual Dobot, with time moved by hand: what any client of its protocol relies on, and its faults."""

from __future__ import annotations

import pytest

from arboleda_drivers.dobot.frames import Feedback, FrameReader, Mode
from arboleda_drivers.dobot.virtual.machine import (
    FAULTS,
    Answer,
    ClientText,
    Disconnect,
    Frame,
    Message,
    VirtualDobot,
)
from arboleda_drivers.virtual.faults import Faults

GOAL = (10.0, 20.0, -30.0, 0.0, 5.0, 0.0)
MOVE = "MovJ(joint={10.000000,20.000000,-30.000000,0.000000,5.000000,0.000000})"


class Client:
    """One client of a controller, under a clock that it moves."""

    def __init__(self, *on: str, enabled: bool = True) -> None:
        self.faults = Faults(FAULTS, on)
        self.dobot = VirtualDobot(self.faults, enabled=enabled, unix_s=1_700_000_000.0)
        self.now = 0.0
        self.out: list[Message] = []
        self.wait(0.1)

    def wait(self, s: float) -> None:
        until = self.now + s
        while self.now < until:
            self.now = min(until, max(self.dobot.next_deadline, self.now + 1e-6))
            self.out += self.dobot.step(self.now, [])

    def ask(self, text: str) -> str:
        """The immediate answer; empty where there is none."""
        found = self.dobot.step(self.now, [ClientText(client=1, text=text)])
        self.out += found
        return "".join(each.text for each in found if isinstance(each, Answer))

    def fed(self) -> Feedback:
        """The last frame that is sent within a moment."""
        self.out.clear()
        self.wait(0.05)
        reader = FrameReader()
        return [one for each in self.out if isinstance(each, Frame) for one in reader.feed(each.data)][-1]


def test_a_move_is_numbered_takes_its_time_and_ends_idle_at_its_goal() -> None:
    client = Client()
    assert client.ask(MOVE) == f"0,{{1}},{MOVE};"
    assert client.fed().mode is Mode.RUNNING
    client.wait(0.2)
    half_way = client.fed()
    assert half_way.mode is Mode.RUNNING and 0 < half_way.joints_deg[0] < 10
    client.wait(2.0)
    end = client.fed()
    assert (end.mode, end.command, end.joints_deg) == (Mode.IDLE, 1, GOAL)


def test_moves_are_queued() -> None:
    client = Client()
    client.ask(MOVE)
    assert client.ask("MovJ(joint={0,0,0,0,0,0},v=50)").startswith("0,{2}")
    client.wait(5.0)
    assert (client.fed().command, client.fed().joints_deg) == (2, (0.0,) * 6)


def test_a_stop_brakes_and_empties_the_queue() -> None:
    client = Client()
    client.ask(MOVE + MOVE)
    client.wait(0.3)
    assert client.ask("Stop()").startswith("0,")
    client.wait(1.0)
    end = client.fed()
    assert end.mode is Mode.IDLE and 0 < end.joints_deg[0] < 10
    client.wait(3.0)
    assert client.fed().joints_deg == end.joints_deg


def test_it_goes_on_where_it_was_paused() -> None:
    client = Client()
    client.ask(MOVE)
    client.wait(0.2)
    client.ask("Pause()")
    client.wait(1.0)
    assert client.fed().mode is Mode.PAUSED
    client.ask("Continue()")
    client.wait(3.0)
    assert (client.fed().mode, client.fed().joints_deg) == (Mode.IDLE, GOAL)


def test_it_begins_disabled_and_moves_once_it_is_enabled() -> None:
    client = Client(enabled=False)
    assert client.fed().mode is Mode.DISABLED
    assert client.ask(MOVE).startswith("-1,{},MovJ")
    client.ask("EnableRobot()")
    client.wait(1.0)
    assert client.fed().mode is Mode.IDLE


@pytest.mark.parametrize(
    ("line", "error"),
    [
        ("Nothing()", -10000),
        ("MovJ(joint={1,2})", -20000),
        ("MovJ(joint={a,0,0,0,0,0})", -30001),
        ("?", -10000),
    ],
)
def test_what_it_does_not_understand_is_refused(line: str, error: int) -> None:
    assert Client().ask(line).startswith(f"{error},{{}}")


def test_outputs_of_the_tool_are_set_and_read() -> None:
    client = Client()
    client.ask("ToolDOInstant(2,1)")
    assert client.ask("GetToolDO(2)").startswith("0,{1}") and client.ask("GetToolDO(1)").startswith("0,{0}")
    assert client.ask("GetToolDO(9)").startswith("-40001,")


def test_the_button_at_the_robot_is_an_alarm_until_it_is_released_and_cleared() -> None:
    client = Client()
    client.ask(MOVE)
    client.wait(0.2)
    client.faults.switch("stop_button", on=True)
    client.wait(1.0)
    client.ask("ClearError()")
    assert client.fed().mode is Mode.ERROR
    assert client.ask("GetErrorID()").startswith("0,{[[116],") and client.ask(MOVE).startswith("-3,")
    client.faults.switch("stop_button", on=False)
    client.ask("ClearError()")
    assert client.fed().mode is Mode.DISABLED


@pytest.mark.parametrize(
    ("fault", "mode", "answer"),
    [
        ("collision", Mode.COLLISION, "-2,"),
        ("alarm", Mode.ERROR, "-2,"),
        ("power_off", Mode.POWER_OFF, "-4,"),
        ("script", Mode.RUNNING, "-5,"),
        ("stall", Mode.RUNNING, "0,"),
        ("refuse", Mode.IDLE, "-1,"),
        ("not_tcp", Mode.IDLE, "Control Mode Is Not Tcp"),
        ("second_client", Mode.RUNNING, "0,"),
        ("no_replies", Mode.RUNNING, ""),
        ("nonsense_replies", Mode.RUNNING, "0,{oops;"),
    ],
)
def test_a_fault_shows_in_the_mode_and_in_the_answer_to_the_next_move(
    fault: str, mode: Mode, answer: str
) -> None:
    client = Client(fault)
    client.ask(MOVE)
    client.wait(0.5)
    assert client.fed().mode is mode
    assert client.ask(MOVE).startswith(answer)


def test_a_controller_that_is_off_hangs_up_and_boots() -> None:
    client = Client()
    client.ask(MOVE)
    before = client.fed()
    client.faults.switch("power_cycle", on=True)
    client.out.clear()
    client.wait(0.1)
    assert set(map(type, client.out)) == {Disconnect}
    client.faults.switch("power_cycle", on=False)
    after = client.fed()
    assert (after.mode, after.command) == (Mode.DISABLED, 0) and after.run_ms < before.run_ms


@pytest.mark.parametrize("fault", ["mute", "garbled"])
def test_the_feedback_can_fall_silent(fault: str) -> None:
    client = Client(fault)
    client.out.clear()
    client.wait(0.2)
    reader = FrameReader()
    assert [one for each in client.out if isinstance(each, Frame) for one in reader.feed(each.data)] == []


def test_frozen_feedback_is_the_same_frame_again() -> None:
    client = Client("frozen")
    client.wait(0.1)
    assert client.fed() == client.fed()


@pytest.mark.parametrize(("fault", "first"), [("lie", 0.0), ("short", 8.0)])
def test_a_move_can_end_elsewhere_and_be_called_over(fault: str, first: float) -> None:
    client = Client(fault)
    client.ask(MOVE)
    client.wait(2.0)
    end = client.fed()
    assert (end.mode, end.command, end.joints_deg[0]) == (Mode.IDLE, 1, pytest.approx(first))


def test_every_fault_has_a_sentence_and_an_unknown_one_is_named() -> None:
    assert len(FAULTS) >= 10 and all(FAULTS.values())
    with pytest.raises(ValueError, match="no fault 'mut'; there are stop_button, collision"):
        Faults(FAULTS, ["mut"])
