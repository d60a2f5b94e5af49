"""The virtual arm of Universal Robots, with time moved by hand: what its clients rely on."""

from __future__ import annotations

import math
import struct

import pytest

from arboleda_drivers.ur.dashboard import GREETING
from arboleda_drivers.ur.port_data import DASHBOARD, PRIMARY, RTDE
from arboleda_drivers.ur.primary import PackageReader
from arboleda_drivers.ur.rtde import Packet, PacketReader, packed
from arboleda_drivers.ur.virtual.faults import FAULTS, SEVERING
from arboleda_drivers.ur.virtual.machine import (
    ClientData,
    Disconnect,
    Drop,
    Joined,
    Message,
    ToClient,
    VirtualUr,
)
from arboleda_drivers.ur.virtual.script import ProgramReader, ScriptError
from arboleda_drivers.virtual.faults import Faults

PORTS = (DASHBOARD, RTDE, PRIMARY)
MOVE = """def carry():
  write_output_integer_register(3, 7)
  movej([0.5, 0, 0, 0, 0, 0], a=3.0, v=1.0)
  write_output_integer_register(3, 8)
end
"""
NAMES = b"actual_q,output_int_register_3,runtime_state,robot_mode"


class Client:
    """One client of each port, under a clock that it moves."""

    def __init__(self, *on: str, running: bool = True) -> None:
        self.faults = Faults(FAULTS, on)
        self.ur = VirtualUr(self.faults, running=running)
        self.now = 0.0
        self.greeting = self._messages([Joined(client=n, port=port) for n, port in enumerate(PORTS)])

    def say(self, port: str, data: bytes) -> bytes:
        """The immediate answer to that client."""
        number = PORTS.index(port)
        out = self._messages([ClientData(client=number, port=port, data=data)])
        return b"".join(each.data for each in out if isinstance(each, ToClient) and each.client == number)

    def ask(self, line: str) -> str:
        return self.say(DASHBOARD, line.encode() + b"\n").decode().strip()

    def wait(self, s: float) -> list[Message]:
        out, end = [], self.now + s
        while self.now < end:
            self.now = min(end, max(self.ur.next_deadline, self.now + 1e-4))
            out += self._messages([])
        return out

    def begin_rtde(self, rate_hz: float = 50.0) -> None:
        for kind, payload in (
            (Packet.VERSION, b"\0\x02"),
            (Packet.OUTPUTS, struct.pack(">d", rate_hz) + NAMES),
            (Packet.START, b""),
        ):
            answer = self.say(RTDE, packed(kind, payload))
            assert PacketReader().feed(answer)[0][0] == kind

    def seen(self) -> tuple[float, int, int, int]:
        """First joint, register, state of the program and mode in the last frame within a moment."""
        data = [each.data for each in self.wait(0.05) if isinstance(each, ToClient) and each.client == 1]
        _, *numbers = struct.unpack(">B6diIi", data[-1][3:])
        return numbers[0], numbers[6], numbers[7], numbers[8]

    def _messages(self, events: list[Joined | ClientData]) -> list[Message]:
        return self.ur.step(self.now, events)


def test_it_greets_and_answers_line_by_line() -> None:
    client = Client(running=False)
    assert any(isinstance(each, ToClient) and GREETING.encode() in each.data for each in client.greeting)
    assert client.ask("robotmode") == "Robotmode: POWER_OFF"
    assert client.ask("is in remote control") == "true"
    assert client.ask("dance") == "could not understand: 'dance'"


def test_it_is_powered_and_its_brakes_are_released() -> None:
    client = Client(running=False)
    assert client.ask("power on") == "Powering on"
    client.wait(1.1)
    assert client.ask("robotmode") == "Robotmode: IDLE"
    assert client.ask("brake release") == "Brake releasing"
    client.wait(0.6)
    assert client.ask("robotmode") == "Robotmode: RUNNING"


def test_a_program_of_anybody_moves_the_arm_and_writes_registers() -> None:
    client = Client()
    client.begin_rtde()
    assert client.seen() == (0.0, 0, 1, 7)
    client.say(PRIMARY, MOVE.encode())
    joint, register, state, _ = client.seen()
    assert 0 < joint < 0.5 and (register, state) == (7, 2)
    client.wait(2.0)
    assert client.seen() == (pytest.approx(0.5), 8, 1, 7)


def test_another_program_takes_the_place_of_the_one_that_runs() -> None:
    client = Client()
    client.begin_rtde()
    client.say(PRIMARY, MOVE.encode())
    client.wait(0.3)
    client.say(PRIMARY, b"def halt():\n  stopj(4)\nend\n")
    client.wait(1.0)
    joint, register, state, _ = client.seen()
    assert 0 < joint < 0.5 and (register, state) == (7, 1)


def test_a_protective_stop_pauses_the_program_and_cannot_be_unlocked_at_once() -> None:
    client = Client("protective_stop")
    client.begin_rtde()
    client.say(PRIMARY, MOVE.encode())
    client.wait(2.0)
    client.faults.switch("protective_stop", on=False)
    assert client.ask("safetystatus") == "Safetystatus: PROTECTIVE_STOP"
    assert client.ask("programState").startswith("PAUSED")
    assert client.ask("unlock protective stop").startswith("Cannot unlock")
    client.wait(5.0)
    assert client.ask("unlock protective stop") == "Protective stop releasing"
    joint = client.seen()[0]
    assert client.seen()[0] == joint  # it waits for `play`
    assert client.ask("play") == "Starting program"
    client.wait(2.0)
    assert client.seen()[:3] == (pytest.approx(0.5), 8, 1)


def test_a_watchdog_without_its_input_ends_the_program() -> None:
    client = Client()
    client.begin_rtde()
    watched = MOVE.replace("():\n", '():\n  rtde_set_watchdog("input_int_register_24", 10, "stop")\n', 1)
    client.say(PRIMARY, watched.encode())
    client.wait(2.0)
    joint, register, state, _ = client.seen()
    assert 0 < joint < 0.5 and (register, state) == (7, 1)


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("def a():\n  fly()\nend\n", 2),
        ("def a():\n  movej()\nend\n", 2),
        ("def a():\n  movej(__import__('os'))\nend\n", 2),
        ("hello\nend\n", 1),
    ],
)
def test_a_program_that_cannot_be_run_is_told_with_its_line(text: str, line: int) -> None:
    with pytest.raises(ScriptError) as error:
        list(ProgramReader().feed(text.encode()))
    assert error.value.line == line
    (told,) = PackageReader().feed(Client().say(PRIMARY, text.encode()))
    assert f"line {line}: " in told.text


def test_what_is_no_rtde_ends_that_connection_alone() -> None:
    client = Client()
    out = client.ur.step(0.0, [ClientData(client=1, port=RTDE, data=b"\0\x03?")])
    assert out == [Drop(client=1)]
    assert client.ask("running") == "Program running: false"


def test_a_variable_that_there_is_not_is_named_and_nothing_starts() -> None:
    client = Client()
    answer = client.say(RTDE, packed(Packet.OUTPUTS, struct.pack(">d", 10) + b"timestamp,mood"))
    assert answer[3:] == b"\x01DOUBLE,NOT_FOUND"
    assert client.say(RTDE, packed(Packet.START)) == packed(Packet.START, b"\0")


@pytest.mark.parametrize("rate_hz", [0.0, -5.0, 1e9, math.inf, math.nan])
def test_any_rate_is_one_that_it_can_keep(rate_hz: float) -> None:
    client = Client()
    client.begin_rtde(rate_hz)
    assert 1 <= len([each for each in client.wait(1.5) if isinstance(each, ToClient)]) <= 800


@pytest.mark.parametrize("fault", SEVERING)
def test_what_severs_it_ends_all_connections_once(fault: str) -> None:
    client = Client()
    client.faults.switch(fault, on=True)
    assert [each for each in client.wait(1.0) if isinstance(each, Disconnect)] == [Disconnect()]
