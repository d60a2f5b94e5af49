"""An arm behind the driver `ur`: the controller is played by hand on three sockets."""

from __future__ import annotations

import queue
import re
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from tests.patience import PATIENCE_S

from arboleda.plant_file.loader import load
from arboleda.runtime.build import App, Options, build
from arboleda_drivers.ur import primary, rtde
from arboleda_drivers.ur.arm_state import Mode, Runtime
from arboleda_drivers.ur.dashboard import GREETING
from arboleda_drivers.ur.rtde import Frame, Packet, PacketReader, packed, packed_frame

from ..contract.bench import HALT, LATCH, OTHER, WORK, Bench, Device, Ref
from ..contract.tcp_ports import Ports
from ..dobot.bench import RECIPES

DASHBOARD, RTDE, PROGRAMS = range(3)
FRAME_S = 0.02
HOME = "home"
GOALS = {
    (0.0,) * 6: HOME,
    (0.174533, 0.349066, -0.523599, 0.0, 0.087266, 0.0): WORK,
    (0.087266, 0.0, 0.0, 0.0, 0.0, 0.0): OTHER,
}
TYPES = ",".join(kind for _, kind in rtde.outputs(24)).encode()
SETUP = {
    Packet.VERSION: b"\x01",
    Packet.OUTPUTS: b"\x01" + TYPES,
    Packet.INPUTS: b"\x01INT32",
    Packet.START: b"\x01",
}
PLANT = """
name: ur
uses: [recipes.py]
cells:
  shop:
    devices:
      arm:
        kind: arm
        model: cr10a
        driver: {{ur: {{host: 127.0.0.1, port: {ports[0]}, rtde_port: {ports[1]}, script_port: {ports[2]}}}}}
    targets:
      home: {{arm: {{deg: [0, 0, 0, 0, 0, 0]}}}}
      a: {{arm: {{deg: [10, 20, -30, 0, 5, 0]}}}}
      b: {{arm: {{deg: [5, 0, 0, 0, 0, 0]}}}}
"""


class PlayedUr:
    """It answers what it is asked; moves wait for the test, but those home, which it does at once."""

    def __init__(self) -> None:
        self._orders: queue.Queue[tuple[str, Ref]] = queue.Queue()
        self._goals: dict[int, tuple[float, ...]] = {}
        self._lock = threading.RLock()
        self._began_s, self._homes = time.monotonic() - 3600, True
        self._stop_word = HALT
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
        self._quiet, self._ending = threading.Event(), threading.Event()
        self.ports = Ports(3, self._told, self._joined)
        self._thread = threading.Thread(target=self._speak, name="ur frames", daemon=True)
        self._thread.start()

    def told(self) -> tuple[str, Ref]:
        return self._orders.get(timeout=PATIENCE_S)

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

    def answers(self, ref: Ref, word: str) -> None:
        raise AssertionError("an arm is asked nothing")

    def hush(self) -> None:
        self._quiet.set()

    def boots(self) -> None:
        with self._lock:  # no frame in between shows the new boot at work
            self._began_s = time.monotonic()
            self._say(mode=Mode.POWER_OFF, runtime=Runtime.STOPPED, begun=0, done=0)

    def vanish(self) -> None:
        self._quiet.set()
        self.ports.close()
        self._started = False

    def come_back(self) -> None:
        self._homes = False  # whatever it is told to do from now on is an order
        self._stop_word = HALT  # of what was left at work; a second one is the plant's latch
        self._say(runtime=Runtime.STOPPED)
        self.ports.open()
        self._quiet.clear()

    def latches(self) -> None:
        self.rests()

    def close(self) -> None:
        self._ending.set()
        self._thread.join()
        self.ports.close()

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
        if GOALS[self._goals[number]] == HOME and self._homes:
            self.finishes(number)
        else:
            self._orders.put((GOALS[self._goals[number]], number))

    def _order_stop(self) -> None:
        self._orders.put((self._stop_word, None))
        self._stop_word = HALT if self._homes else LATCH

    def _say(self, **news: Any) -> None:
        with self._lock:
            self._said = replace(self._said, **news)
        self._frame()

    def _frame(self) -> None:
        with self._lock:
            if self._started:
                said = replace(self._said, timestamp_s=time.monotonic() - self._began_s)
                self.ports.send(RTDE, packed_frame(said, 1))

    def _speak(self) -> None:
        while not self._ending.wait(FRAME_S):
            if not self._quiet.is_set():
                self._frame()


def _open(folder: Path, state: Path) -> tuple[App, Callable[[App], Device]]:
    ur = PlayedUr()
    folder.mkdir()
    (folder / "plant.yaml").write_text(PLANT.format(ports=ur.ports.numbers), "utf-8")
    (folder / "recipes.py").write_text(RECIPES, "utf-8")
    app = build(load(folder / "plant.yaml"), ("orchestrator",), Options(state_dir=state))
    return app, lambda app: ur


BENCH = Bench(open=_open)
