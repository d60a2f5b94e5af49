"""An arm behind the driver `ur`: the controller is played by hand on three sockets."""

from __future__ import annotations

import math
import re
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

from arboleda.testing.drivers import Bench
from arboleda.testing.drivers.bench import Ref
from arboleda_drivers.ur import primary, rtde
from arboleda_drivers.ur.arm_state import Mode, Runtime
from arboleda_drivers.ur.dashboard import GREETING
from arboleda_drivers.ur.rtde import Frame, Packet, PacketReader, packed, packed_frame

from ..contract.mover import ARM_DEG, WORDS, Opened, PlayedTcpArm, app_of, arm

DASHBOARD, RTDE, PROGRAMS = range(3)
GOALS = {
    tuple(round(math.radians(each), 6) for each in deg): word
    for deg, word in zip(ARM_DEG, WORDS, strict=True)
}
TYPES = ",".join(kind for _, kind in rtde.outputs(24)).encode()
SETUP = {
    Packet.VERSION: b"\x01",
    Packet.OUTPUTS: b"\x01" + TYPES,
    Packet.INPUTS: b"\x01INT32",
    Packet.START: b"\x01",
}


class PlayedUr(PlayedTcpArm):
    """It answers what it is asked; moves wait for the test, but those home, which it does at once."""

    def __init__(self) -> None:
        self._goals: dict[int, tuple[float, ...]] = {}
        self._began_s = time.monotonic() - 3600
        self._packets, self._started, self._text = PacketReader(), False, ""
        self._said = Frame(
            timestamp_s=0.0,
            joints=(0.0,) * 6,
            mode=Mode.RUNNING,
            safety=1,
            runtime=Runtime.STOPPED,
            outputs=0,
            slider=1.0,
            begun=0,
            done=0,
        )
        super().__init__(3, self._joined)

    def accepts(self, ref: Ref) -> None:
        self._say(runtime=Runtime.PLAYING, begun=ref)

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        at = {"joints": self._goals[ref]} if there else {}
        self._say(runtime=Runtime.STOPPED, begun=ref, done=ref, **at)

    def rejects(self, ref: Ref) -> str:
        self.ports.send(PROGRAMS, primary.packed_exception(4, "no such joints"))
        return "(program_refused line 4: no such joints)"

    def gives_up(self, ref: Ref) -> str:
        self._say(safety=3, runtime=Runtime.PAUSED)
        return "gave up (protective_stop"

    def rests(self) -> None:
        self._say(runtime=Runtime.STOPPED, safety=1)

    def boots(self) -> None:
        with self._lock:  # no frame in between shows the new boot at work
            self._began_s = time.monotonic()
            self._say(mode=Mode.POWER_OFF, runtime=Runtime.STOPPED, begun=0, done=0)

    def _forget(self) -> None:
        self._started = False

    def _joined(self, port: int) -> None:
        if port == DASHBOARD:
            self.ports.send(DASHBOARD, f"Connected: {GREETING}\n".encode())
        elif port == RTDE:
            self._packets, self._started = PacketReader(), False
        else:
            self._text = ""

    def _told(self, port: int, data: bytes) -> None:
        with self._lock:
            if port == DASHBOARD:
                for line in data.decode().splitlines():
                    self.ports.send(DASHBOARD, b"Stopped\n" if line == "stop" else b"true\n")
                    if line == "stop":
                        self._order_stop()
            elif port == RTDE:
                for kind, _ in self._packets.feed(data):
                    if kind != Packet.DATA:  # a heartbeat
                        self.ports.send(RTDE, packed(Packet(kind), SETUP[Packet(kind)]))
                        self._started = self._started or kind == Packet.START
            else:
                *programs, self._text = (self._text + data.decode()).split("\nend\n")
                for program in programs:
                    self._take(program)

    def _take(self, program: str) -> None:
        found = re.search(r"write_output_integer_register\(24, (\d+)\)", program)
        assert found is not None
        number = int(found[1])
        if "stopj" in program:
            self._order_stop()
            self._say(begun=number)
            return
        (joints,) = re.findall(r"movej\(\[([^]]*)\]", program)
        self._goals[number] = tuple(float(each) for each in joints.split(","))
        if self._is_made(GOALS[self._goals[number]], number):
            self.finishes(number)

    def _say(self, **news: Any) -> None:
        with self._lock:
            self._said = replace(self._said, **news)
        self._frame()

    def _frame(self) -> None:
        with self._lock:
            if self._started:
                said = replace(self._said, timestamp_s=time.monotonic() - self._began_s)
                self.ports.send(RTDE, packed_frame(said, 1))


def _open(folder: Path, state: Path) -> Opened:
    ur = PlayedUr()
    port, rtde_port, script_port = ur.ports.numbers
    ports = f"port: {port}, rtde_port: {rtde_port}, script_port: {script_port}"
    return app_of(folder, state, arm(f"{{ur: {{host: 127.0.0.1, {ports}}}}}"), "arm"), lambda app: ur


BENCH = Bench(open=_open, takes="arboleda_drivers.ur.rtde.frame_of")
