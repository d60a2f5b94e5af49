"""GRBL or grblHAL as a program of this machine, at a line; nothing of Arboleda in it.

    firmware.py PROGRAM LINE

PROGRAM is that of https://github.com/grbl/grbl-sim around https://github.com/gnea/grbl, or that of
https://github.com/grblHAL/Simulator. It says itself what its planner takes and where its steppers are. From
that is printed what press.py prints: an order begins as it is planned, and is dropped where it stands
elsewhere.
"""

from __future__ import annotations

import os
import select
import subprocess
import sys
import tempfile
import time
import tty

SETTINGS = ("$X", "$110=1500", "$111=1500", "$112=1500", "$120=200", "$121=200", "$122=200")
SET_S, BEGINS_S = 0.3, 1.5
SHUT_DOWN = b"\x06"  # it keeps its settings only if it ends by itself
STANDS_S = 0.25
Steps = tuple[int, int, int]


def terminal() -> tuple[int, str]:
    """A terminal for a log: a program writes line by line to one."""
    here, there = os.openpty()
    tty.setraw(there)
    return here, os.ttyname(there)


def prepare(program: str, folder: str) -> None:
    """Have it keep its settings in the folder."""
    quiet = [program, "-n", "-s", "/dev/null", "-b", "/dev/null"]
    process = subprocess.Popen(quiet, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, cwd=folder)
    assert process.stdin is not None
    time.sleep(BEGINS_S)
    for line in (*(f"{each}\n".encode() for each in SETTINGS), SHUT_DOWN):
        process.stdin.write(line)
        process.stdin.flush()
        time.sleep(SET_S)
    process.kill()
    process.wait()


class Lines:
    """The whole lines of a log, as steps of the three axes."""

    def __init__(self, file: int) -> None:
        self.file = file
        self._left = b""

    def read(self) -> list[Steps]:
        *lines, self._left = (self._left + os.read(self.file, 65536)).split(b"\n")
        rows = [line.decode("ascii", "replace").strip() for line in lines]
        return [self._steps(row) for row in rows if row and not row.startswith("#")]

    @staticmethod
    def _steps(row: str) -> Steps:
        words = row.replace(",", " ").split()
        x, y, z = words[1:4] if "." in words[0] else words[:3]  # with the time before them, or none
        return int(x), int(y), int(z)


class Machine:
    """What it does, by its planner and its steppers."""

    def __init__(self) -> None:
        self._planned: Steps = (0, 0, 0)  # by the count of the planner, which knows of no stop
        self._at: Steps = (0, 0, 0)
        self._goal: Steps | None = None
        self._moved_at = 0.0
        self._orders = 0

    def plan(self, planned: Steps) -> None:
        self._stop()
        way = [there - here for here, there in zip(self._planned, planned, strict=True)]
        self._planned = planned
        x, y, z = (here + each for here, each in zip(self._at, way, strict=True))
        self._goal, self._moved_at = (x, y, z), time.monotonic()
        self._orders += 1
        say("begin", self._orders)

    def move(self, at: Steps) -> None:
        if at != self._at:
            self._at, self._moved_at = at, time.monotonic()
        if at == self._goal:
            self._goal = None
            say("end", self._orders)

    def look(self) -> None:
        if time.monotonic() - self._moved_at > STANDS_S:
            self._stop()

    def _stop(self) -> None:
        if self._goal is not None:
            self._goal = None
            say("drop", self._orders)


def say(word: str, number: int) -> None:
    print(word, number, time.monotonic(), flush=True)


def main(program: str, line: str) -> None:
    with tempfile.TemporaryDirectory() as folder:
        prepare(program, folder)
        (blocks, block_log), (steps, step_log) = terminal(), terminal()
        with open(line, "r+b", buffering=0) as end:
            logs = ["-n", "-r", "0.01", "-s", step_log, "-b", block_log]
            process = subprocess.Popen([program, *logs], stdin=end, stdout=end, cwd=folder)
        planned, moved, machine = Lines(blocks), Lines(steps), Machine()
        time.sleep(BEGINS_S)
        print("ready", 0, flush=True)
        try:
            while process.poll() is None:
                ready, _, _ = select.select([sys.stdin, blocks, steps], [], [], 0.02)
                for each in moved.read() if steps in ready else ():
                    machine.move(each)
                for each in planned.read() if blocks in ready else ():
                    machine.plan(each)
                machine.look()
                if sys.stdin in ready and not sys.stdin.readline():
                    return
        finally:
            process.kill()


main(*sys.argv[1:])
