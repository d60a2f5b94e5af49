"""`arboleda simulate` as a process: the same on every interpreter and clock, and gone when told to go."""

from __future__ import annotations

import json
import os
import pickle
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from tests.patience import PATIENCE_S
from tests.system.conftest import paths

from arboleda_proofs.campaigns.request import Request

pytestmark = pytest.mark.system

ROOT = Path(__file__).parents[5]
SUPPORTED = ("3.10", "3.11", "3.12")
PURE = ("py_trees", "pydot", "pyparsing")  # all that a simulation imports besides Arboleda, and no binary
SEEDS = (1, 2)
ONE_SEED_EACH = """
import pickle, sys
setting = pickle.load(open(sys.argv[1], "rb"))
print(*(setting.run(seed).digest for seed in {seeds}))
"""
CLOCKS_THAT_RAISE = """
import threading, time
def no(*args, **options):
    raise RuntimeError("a simulation looked at a clock, slept or started a thread")
for name in ("time", "time_ns", "monotonic", "monotonic_ns", "perf_counter", "perf_counter_ns", "sleep"):
    setattr(time, name, no)
threading.Thread.start = no
"""
CLOCKS_THAT_JUMP = """
import itertools, time
jumps = itertools.cycle((0.0, 1e9, -1e9, 5e-9, 3600.0))
for name in ("time", "monotonic", "perf_counter"):
    setattr(time, name, lambda: next(jumps))
"""


@pytest.fixture
def setting(tmp_path: Path) -> Path:
    """The shipped and the shared plant with many faults, as any interpreter can read it."""
    file = tmp_path / "setting"
    file.write_bytes(pickle.dumps(Request(cycles=4, faults="many").setting, protocol=4))
    return file


def digests(setting: Path, python: str = sys.executable, before: str = "", **environ: str) -> str:
    """Those of SEEDS, from a process of its own, in which `before` happens once everything is imported."""
    load, run = ONE_SEED_EACH.format(seeds=SEEDS).rsplit("print", 1)
    code = f"{load}{before}\nprint{run}"
    env = {**os.environ, "PYTHONPATH": paths(), **environ}
    result = subprocess.run(
        [python, "-c", code, setting], env=env, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr
    return result.stdout


def others() -> list[str]:
    """Every supported Python that is on the PATH or stands beside this one."""
    beside = Path(sys.base_prefix).parent
    found: dict[str, None] = {}
    for version in SUPPORTED:
        installed = [str(path) for path in sorted(beside.glob(f"{version}*/bin/python{version}"))]
        for python in (shutil.which(f"python{version}"), *installed):
            if python and runs(python, version):
                found[python] = None
    return list(found)


def runs(python: str, version: str) -> bool:
    """True if it is the version in its name, which a shim may not be."""
    ask = "import sys; print(*sys.version_info[:2], sep='.')"
    said = subprocess.run([python, "-c", ask], capture_output=True, text=True, check=False)
    return said.returncode == 0 and said.stdout.strip() == version


def test_hash_seeds_clocks_and_interpreters_make_no_difference(setting: Path, tmp_path: Path) -> None:
    first = digests(setting, PYTHONHASHSEED="0")
    assert len(set(first.split())) == len(SEEDS)
    assert digests(setting, PYTHONHASHSEED="4711", before=CLOCKS_THAT_RAISE) == first
    assert digests(setting, PYTHONHASHSEED="random", before=CLOCKS_THAT_JUMP) == first
    for name in PURE:
        spec = find_spec(name)
        assert spec is not None and spec.submodule_search_locations
        (tmp_path / name).symlink_to(spec.submodule_search_locations[0])
    sources = [ROOT / "src/arboleda", ROOT / "packages/arboleda_proofs/src"]
    pure = {"PYTHONPATH": os.pathsep.join(map(str, (*sources, tmp_path)))}
    pythons = (sys.executable, *others())
    said = {python: digests(setting, python, **pure) for python in pythons}
    assert said == dict.fromkeys(pythons, first)


MAIN = """
import os; print(os.getpid())
from arboleda_proofs.campaigns import screen; screen.EVERY_S = 0.5  # a line says that it runs
from arboleda.cli.main import main; main()
"""


@pytest.fixture
def simulate(start: Callable[..., Any]) -> Callable[..., Any]:
    """`simulate("--seeds", "4")`: the command in a process of its own, which says its number first."""

    def go(*words: str) -> Any:
        return start(sys.executable, "-c", MAIN, "simulate", *words, env={"PYTHONPATH": paths()})

    return go


@pytest.mark.smoke
def test_workers_find_what_one_process_finds(simulate: Callable[..., Any], tmp_path: Path) -> None:
    rows = []
    for jobs in ("1", "3"):
        file = tmp_path / f"{jobs}.json"
        words = ("--seeds", "4", "--cycles", "2", "--faults", "few", "--jobs", jobs, "--json", str(file))
        run = simulate(*words)
        assert run.wait() in (0, 1), run.output
        assert "4 seeds (1 to 4)" in run.output and "\x1b" not in run.output
        rows.append([(row["seed"], row["digest"]) for row in json.loads(file.read_text())["seeds"]])
    assert rows[0] == rows[1] and len(rows[0]) == 4


def workers_of(parent: int) -> list[int]:
    """The processes that a process started."""
    pids = [int(path.name) for path in Path("/proc").iterdir() if path.name.isdigit()]
    return [pid for pid in pids if stat(pid)[1:2] == [str(parent)]]


def stat(pid: int) -> list[str]:
    """State, parent and more of a process; empty where there is none."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return []


def gone(pids: list[int]) -> bool:
    """True if they all end within some seconds."""
    until = time.monotonic() + PATIENCE_S
    while any(alive(pid) for pid in pids) and time.monotonic() < until:
        time.sleep(0.05)
    return not any(alive(pid) for pid in pids)


def alive(pid: int) -> bool:
    return stat(pid)[:1] not in ([], ["Z"])


@pytest.fixture
def endless(simulate: Callable[..., Any]) -> Iterator[tuple[Any, list[int]]]:
    """A command that goes on until it is told to end, and its number and those of its two workers."""
    run = simulate("--until-failure", "--faults", "none", "--cycles", "1", "--jobs", "2")
    run.wait_for("simulating: ")
    pids = [int(run.lines[0]), *workers_of(int(run.lines[0]))]
    assert len(pids) == 3
    yield run, pids
    assert gone(pids)


def test_workers_leave_ctrl_c_to_the_command(endless: tuple[Any, list[int]]) -> None:
    run, pids = endless
    os.killpg(pids[0], signal.SIGINT)  # as a terminal sends it
    assert run.wait() == 130, run.output
    assert "interrupted; so far:" in run.output and "Traceback" not in run.output


def test_no_worker_outlives_a_command_that_is_killed(endless: tuple[Any, list[int]]) -> None:
    _, pids = endless
    os.kill(pids[0], signal.SIGKILL)


def test_a_worker_that_is_killed_ends_it_with_a_sentence(endless: tuple[Any, list[int]]) -> None:
    run, pids = endless
    os.kill(pids[1], signal.SIGKILL)
    assert run.wait() == 1
    assert "arboleda: a worker process was killed; fewer --jobs need less memory" in run.output
    assert "Traceback" not in run.output
