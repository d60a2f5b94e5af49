"""Bench of an assistant: `check`, `simulate` and `prove` of one plant file, each a command in a process of
its own, one at a time and with a budget. Whoever started the server named the file, as it may name Python."""

from __future__ import annotations

import asyncio
import json
import os
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.host.limits import BEHIND
from arboleda_make.trying.processes.extract import shown

SPARE_S = 270.0  # after the budget: what is under way is ended, a mend is looked for
CHECK_S = 330.0
SIMULATE_S = 600.0
BUDGET_S = 300  # the longest one
SEEDS, CYCLES = 50, 20  # the most
MEANING = {0: "good", 1: "something broke, or a task failed where nothing had gone wrong", 2: "bad input"}
Command = Callable[[Sequence[str]], Sequence[str]]


class BenchBusy(ArboledaError):
    """Something else is tried already, or it takes too long."""


def own_command(words: Sequence[str]) -> list[str]:
    """The command line of one of Arboleda's own commands."""
    return [sys.executable, "-c", BEHIND, *words]


class Bench:
    """Bench: tries the plant of `file`; `command` makes the command line from the words after `arboleda`."""

    def __init__(self, file: Path, command: Command = own_command) -> None:
        self.file = file
        self._command = command
        self._turn = asyncio.Lock()

    async def check(self) -> dict[str, Any]:
        """The findings of `arboleda check`, and what would mend them."""
        found = await self._run(["check", str(self.file), "--mend", "--json", "-"], CHECK_S)
        return _with(found, _read("\n".join(found["lines"])))

    async def simulate(self, seeds: int, cycles: int) -> dict[str, Any]:
        """Report of `arboleda simulate` on so many seeds with faults."""
        counts = ["--seeds", str(_within(seeds, SEEDS)), "--cycles", str(_within(cycles, CYCLES))]
        return await self._run(["simulate", "--plant", str(self.file), *counts, "--jobs", "1"], SIMULATE_S)

    async def prove(self, recipes: Sequence[str], budget_s: int) -> dict[str, Any]:
        """Answer of `arboleda prove` within a budget of time, and what would mend what it finds."""
        budget = _within(budget_s, BUDGET_S)
        chosen = [word for name in recipes for word in ("--recipe", name)]
        with tempfile.TemporaryDirectory() as kept:  # beside the plant's own: nothing is shared with it
            own = ["--budget", f"{budget}s", "--jobs", "1", "--state", kept, "--mend", "--json", "-"]
            found = await self._run(["prove", *own, *chosen, "--", str(self.file)], budget + SPARE_S)
        answer = _read(found["lines"][-1] if found["lines"] else "").get("answer")
        return _with(found, {} if answer is None else shown(answer))

    async def _run(self, words: Sequence[str], within_s: float) -> dict[str, Any]:
        if self._turn.locked():
            raise BenchBusy("Something else is tried already; try this again when it has ended.")
        async with self._turn:
            process = await asyncio.create_subprocess_exec(
                *self._command(words),
                stdin=asyncio.subprocess.DEVNULL,
                stdout=asyncio.subprocess.PIPE,
                stderr=asyncio.subprocess.STDOUT,
                env={**os.environ, "COLUMNS": "200", "NO_COLOR": "1", "TERM": "dumb"},
            )
            try:
                output, _ = await asyncio.wait_for(process.communicate(), within_s)
            except asyncio.TimeoutError:
                raise BenchBusy(f"It took longer than {within_s:g} s, and was ended.") from None
            finally:
                if process.returncode is None:
                    process.kill()
                    await process.wait()
        status = process.returncode or 0
        return {
            "status": status,
            "meaning": MEANING.get(status, "it broke down"),
            "lines": output.decode("utf-8", "replace").splitlines(),
        }


def _read(line: str) -> dict[str, Any]:
    """A line of JSON; nothing where it is none."""
    try:
        found: dict[str, Any] = json.loads(line)
        return found
    except ValueError:
        return {}


def _with(found: dict[str, Any], answer: dict[str, Any]) -> dict[str, Any]:
    """The answer in place of the lines that it was written in, where there is one."""
    return {**{key: found[key] for key in ("status", "meaning")}, **answer} if answer else found


def _within(number: int, most: int) -> int:
    if not 1 <= number <= most:
        raise BenchBusy(f"{number} is too few or too many; 1 to {most} are allowed.")
    return number
