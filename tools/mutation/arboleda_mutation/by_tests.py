"""The first judge: unit and scenario tests, the most telling first, until one fails."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import hypothesis
import pytest

from .children import Say
from .mutant import Mutant
from .planted import plant
from .reach import Reach, Tracer
from .sources import MUTATED, PACKAGE, Sources

TESTS = (
    "tests/unit",
    "tests/scenario",
    "tools/tests/fast",
    "packages/arboleda_proofs/tests/fast",
    "packages/arboleda_trees/tests/fast",
)
LEAST_CPU_S, TIMES = 20.0, 10.0  # what computes longer, and so much longer than it did, hangs
# pytest would load a package that has a plugin by itself, to rewrite its asserts, and so without the mutant
ARGUMENTS = (
    *("-q", "-x", "--no-header", "--assert=plain", "--timeout=0"),
    *("-p", "no:cacheprovider", "-p", "no:xdist"),
)


def measure(root: Path, folders: Sequence[str], say: Say) -> dict[str, Any]:
    """The lines that each test reaches, with nothing planted."""
    tracer = Tracer(root / PACKAGE, MUTATED)
    watcher = _Measuring(tracer, say)
    with tracer.running():
        _pytest(root, [each for each in ARGUMENTS if each != "-x"], folders, watcher)
    return tracer.reach.as_json()


def judge(sources: Sources, mutant: Mutant, tests: list[tuple[str, float]], say: Say) -> dict[str, Any]:
    """Run these tests, each with how long it took when nothing was planted, until one fails."""
    plant(mutant, sources)
    files = list(dict.fromkeys(name.partition("::")[0] for name, _ in tests))
    return _judged(sources.root, files, _Judging(dict(tests), say))


def judge_files(sources: Sources, mutant: Mutant, files: Sequence[str], say: Say) -> dict[str, Any]:
    """Run all tests of these files, the first file first, until one fails."""
    plant(mutant, sources)
    return _judged(sources.root, files, _Judging({}, say))


def in_order(mutant: Mutant, reach: Reach, breadth: dict[str, int], before: str) -> list[tuple[str, float]]:
    """The tests that come by a mutant: who killed it before, then who is quick and reaches little.

    All, where none is seen to: tables are read at import, and some tests have a process of their own.
    """
    names = [name for name in reach.of(mutant) or reach.names if name not in reach.failed]
    times = dict(zip(reach.names, reach.cpu_s, strict=True))
    names.sort(key=lambda name: (name != before, (times[name] + 0.01) * breadth[name]))
    return [(name, times[name]) for name in names]


def _judged(root: Path, files: Sequence[str], watcher: _Judging) -> dict[str, Any]:
    status = _pytest(root, ARGUMENTS, files, watcher)
    killer = watcher.failed or ("the tests cannot be collected" if status not in (0, 5) else "")
    return {"killed": bool(killer), "by": killer, "ran": watcher.ran}


def _pytest(root: Path, arguments: Sequence[str], files: Sequence[str], plugin: object) -> int:
    os.chdir(root)
    sys.path.insert(0, str(root))
    return int(pytest.main([*arguments, *files], plugins=[plugin]))


class _Watching:
    """Examples are drawn the same every time, kept nowhere, and not made smaller."""

    def pytest_sessionstart(self) -> None:
        phases = (hypothesis.Phase.explicit, hypothesis.Phase.generate)
        hypothesis.settings.register_profile(
            "mutants", hypothesis.settings.default, derandomize=True, database=None, phases=phases
        )
        hypothesis.settings.load_profile("mutants")


class _Measuring(_Watching):
    def __init__(self, tracer: Tracer, say: Say) -> None:
        self._tracer = tracer
        self._say = say

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        began = time.process_time()
        with self._tracer.during(item.nodeid):
            result = yield
        self._tracer.reach.cpu_s.append(round(time.process_time() - began, 3))
        self._say({"at": item.nodeid})
        return result

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self._tracer.reach.failed.append(report.nodeid)


class _Judging(_Watching):
    """Runs `tests`, by name with the s that each took, in order; all that there are, where none is named."""

    def __init__(self, tests: dict[str, float], say: Say) -> None:
        self._tests = tests
        self._order = {name: number for number, name in enumerate(tests)}
        self._say = say
        self.failed = ""
        self.ran = 0

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        if self._order:
            chosen = [item for item in items if item.nodeid in self._order]
            items[:] = sorted(chosen, key=lambda item: self._order[item.nodeid])

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed:
            self.failed = self.failed or report.nodeid

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        self._say({"at": item.nodeid})
        self.ran += 1
        # the signal ends this process, whatever catches exceptions
        signal.setitimer(signal.ITIMER_PROF, max(LEAST_CPU_S, TIMES * self._tests.get(item.nodeid, 0.0)))
        try:
            return (yield)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.failed = self.failed or report.nodeid
