"""Process in which a work is judged, so that Python in it that never ends, or ends Python, is a finding."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

from arboleda.host import limits
from arboleda.host.signals import kill_group
from arboleda.plant_file.recipe_trial import PATH
from arboleda_proofs.campaigns import flight
from arboleda_proofs.campaigns.plants import Plant

from .exercise import Text, exercise
from .judge import Again, Finding, Judge, Verdict
from .work import Work

START = PATH + "from arboleda_class.exercises import judge_process; judge_process.main()"
CPU_S = 30  # of the process and of each fork
CLOCK_S = 240.0  # of all of it, on a busy machine
CAN_BE_JUDGED: Text = {"en": "The work can be judged", "es": "El trabajo se puede evaluar"}
NO_VERDICT = (
    "there is no verdict: it took more than {seconds} s, or ended Python. Does a loop in it never end?"
)


def judged(work: Work, *, story: Path | None = None) -> Verdict:
    """The verdict on a work, from a process of its own."""
    if work.trouble:
        return _cannot(work.trouble)
    request = {
        "exercise": work.exercise,
        "files": {name: each.decode("utf-8", "surrogateescape") for name, each in work.files.items()},
        "story": None if story is None else str(story.absolute()),
    }
    output = _output(json.dumps(request).encode())
    try:
        found = json.loads(output.splitlines()[-1])
        findings = [
            Finding(says=each["says"], evidence=each["seen"], story=tuple(each["story"]))
            for each in found["findings"]
        ]
        return Verdict(questions=found["asked"], runs=found["runs"], findings=findings)
    except (ValueError, LookupError, TypeError):
        return _cannot(NO_VERDICT.format(seconds=CPU_S))


def main() -> None:
    """Run as the other process: read the work, answer on the last line, end."""
    limits.limit_processor(CPU_S)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, which ends this
    request: dict[str, Any] = json.load(sys.stdin)
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)  # what a student's Python prints is no answer
    files = {name: text.encode("utf-8", "surrogateescape") for name, text in request["files"].items()}
    play = None if request["story"] is None else partial(_record, Path(request["story"]))
    verdict = Judge(exercise(request["exercise"]), files).judge(play=play)
    print(f"\n{json.dumps(verdict.plain)}", file=answers, flush=True)
    os._exit(0)  # whatever threads the student's Python has started


def _record(story: Path, plant: Plant, again: Again) -> None:
    """Record in a file what is not so in the plant of a student."""
    with flight.recorded(story, plant) as flown:
        again(flown.make_plant)


def _cannot(why: str) -> Verdict:
    return Verdict(findings=[Finding(says=CAN_BE_JUDGED, evidence=why)])


def _output(request: bytes) -> bytes:
    """Answer of the process; nothing, and it is ended with all that it has started, if it takes too long."""
    command = [sys.executable, "-I", "-c", START, json.dumps(sys.path)]
    pipe = subprocess.PIPE
    with subprocess.Popen(
        command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL, start_new_session=True
    ) as run:
        try:
            return run.communicate(request, CLOCK_S)[0]
        except (OSError, subprocess.TimeoutExpired):
            return b""
        finally:
            kill_group(run.pid)
