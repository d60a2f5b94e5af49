"""A second try for tests of real parts: what failed runs once more, alone, in a fresh process.

`pytest -p tests.second_tries ...` does so when all other tests are over. A test that passes then leaves a row
in `second_tries.tsv`; in CI, whose checkout is thrown away, the row is printed only. The run stays red where

- a test fails again,
- its first failure is an exception of the product, and not a wait that ran out,
- more than three tests failed, or a file could not be collected.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from datetime import date
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
LEDGER = Path(__file__).with_name("second_tries.tsv")
OURS = f"{ROOT}/"
FOLDERS = ("src", "tools/bench", "tools/kills", *ROOT.glob("packages/*/src"))
PRODUCT = tuple(f"{ROOT / name}/" for name in FOLDERS)
LIBRARIES = "/site-packages/"
INSTALLED = "/site-packages/arboleda"  # as colcon installs the product
OWN_TESTS = ("/test/", "/arboleda/testing/")  # beside the product of a package; what tests are made of
MOST = 3
TRACEBACK = re.compile(r"Traceback \(most recent call last\):\n(?P<calls>(?:[ |]+.*\n)+)(?P<name>[\w.]+)")
CALL = re.compile(r'File "(?P<path>[^"]+)", line')


def pytest_configure(config: pytest.Config) -> None:
    if not hasattr(config, "workerinput"):  # the process that hears of all tests, xdist or not
        config.pluginmanager.register(SecondTries(config))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(call: pytest.CallInfo[None]) -> Iterator[None]:
    """Write into the report of a failure what is known of it in the process of the test alone."""
    report = yield
    if report.failed and call.excinfo is not None:
        report.of_product = is_of_product(call.excinfo.value)
        report.load = round(os.getloadavg()[0], 1)
    return report


def is_of_product(error: BaseException) -> bool:
    """Whether the product raised it, here or in a process whose output the message shows; no wait did."""
    return _raised_by_product(error) or any(map(_shows_product, TRACEBACK.finditer(str(error))))


def _raised_by_product(error: BaseException) -> bool:
    if is_wait(type(error)):
        return False
    calls, trace = [], error.__traceback__
    while trace is not None:
        calls.append(trace.tb_frame.f_code.co_filename)
        trace = trace.tb_next
    return _ends_in_product(calls)


def is_wait(kind: type[BaseException]) -> bool:
    """Whether the exception says that a wait ran out; pytest's own kinds say so for tests that hang."""
    return issubclass(kind, pytest.fail.Exception) or any("Timeout" in each.__name__ for each in kind.__mro__)


def _shows_product(found: re.Match[str]) -> bool:
    paths = [call["path"] for call in CALL.finditer(found["calls"])]
    return "Timeout" not in found["name"] and _ends_in_product(paths)


def _ends_in_product(paths: list[str]) -> bool:
    """Whether the innermost of our own files is one of the product; what libraries do is their caller's."""
    own = [path for path in paths if INSTALLED in path or (path.startswith(OURS) and LIBRARIES not in path)]
    if not own or any(each in own[-1] for each in OWN_TESTS):
        return False
    return own[-1].startswith(PRODUCT) or INSTALLED in own[-1]


class SecondTries:
    """The failures of one run, and what their second tries came to."""

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self._failures: dict[str, pytest.TestReport] = {}  # by test, the first of each
        self._uncollected = False

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        self._uncollected = self._uncollected or report.failed

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self._failures.setdefault(report.nodeid, report)

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> Iterator[None]:
        """Once the workers have ended and the summary is written: the second tries."""
        outcome = yield
        if self._failures and session.exitstatus == pytest.ExitCode.TESTS_FAILED and not self._uncollected:
            screen = self._config.pluginmanager.get_plugin("terminalreporter")
            screen.section("second tries", sep="!")
            if self._all_pass(screen.line):
                session.exitstatus = pytest.ExitCode.OK
        return outcome

    def _all_pass(self, say: Callable[[str], None]) -> bool:
        if len(self._failures) > MOST:
            say(f"{len(self._failures)} tests failed; more than {MOST} are not tried again")
            return False
        passed = [self._passes(test, report, say) for test, report in self._failures.items()]
        return all(passed)

    def _passes(self, test: str, report: pytest.TestReport, say: Callable[[str], None]) -> bool:
        if getattr(report, "of_product", False):
            say(f"{test}: an exception of the product is not tried again")
            return False
        say(f"{test}: tried again, alone")
        settings = [f"--override-ini={each}" for each in self._config.option.override_ini or ()]
        command = [sys.executable, "-m", "pytest", "-q", *settings, test]
        ran = subprocess.run(command, cwd=self._config.rootpath, capture_output=True, text=True, check=False)
        if ran.returncode != 0:
            say(f"{test}: FAILED again\n{ran.stdout}")
            return False
        line = row(test, report)
        say(f"{test}: PASSED at its second try; the first:\n{line}")
        if "CI" not in os.environ:
            with LEDGER.open("a", encoding="utf-8") as ledger:
                ledger.write(f"{line}\n")
        return True


def row(test: str, report: pytest.TestReport) -> str:
    """Test, date, revision, first line of the failure and load, as `second_tries.tsv` has them."""
    crash = getattr(report.longrepr, "reprcrash", None)
    words = str(crash.message if crash else report.longrepr).splitlines() or [""]
    revision = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    cells = (
        test,
        date.today().isoformat(),
        revision.stdout.strip(),
        words[0],
        str(getattr(report, "load", "")),
    )
    return "\t".join(cell.replace("\t", " ") for cell in cells)
