"""The contract of drivers from outside: a driver of somebody else goes through it, and its bugs are found."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest

pytestmark = pytest.mark.system

EXAMPLE = Path(__file__).parents[2] / "examples/scpi_meter"
DRIVER, DEVICE, TEST = "scpi_meter.py", "played_meter.py", "test_scpi_meter.py"
FORGETS = "self._line, self._work, self._next = line, None, None"
LINE = "self._client.shutdown(socket.SHUT_RDWR), self._show(0)"
GOES_ON, DROPS = (f"{' ' * 16}{each}\n" for each in ("self._go_on()", "self._work = None"))
AGAIN = "\n            self._go_on()"
MOST = 30  # lines of a test beside the driver and the played device


@pytest.fixture
def run(tmp_path: Path) -> Callable[..., str]:
    """What pytest says of the example, with texts of its files in the place of others."""

    def go(*words: str, changed: Iterable[tuple[str, str, str]] = ()) -> str:
        folder = tmp_path / "meter"
        shutil.copytree(EXAMPLE, folder, ignore=shutil.ignore_patterns("__pycache__"))
        for file, old, new in changed:
            text = (folder / file).read_text("utf-8")
            assert old in text
            (folder / file).write_text(text.replace(old, new), "utf-8")
        (folder / "pytest.ini").write_text("[pytest]\n", "utf-8")
        others = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST_")}
        command = [sys.executable, "-m", "pytest", "-ra", *words]
        ran = subprocess.run(command, cwd=folder, env=others, capture_output=True, text=True, check=False)
        return ran.stdout + ran.stderr

    return go


def test_a_meter_goes_through_the_contract_with_a_short_test(run: Callable[..., str]) -> None:
    written = [line for line in (EXAMPLE / TEST).read_text("utf-8").splitlines() if line]
    assert len(written) <= MOST
    said = run()
    assert "12 passed, 3 skipped" in said, said
    reasons = re.findall(r"^SKIPPED .*: (\w+=\w+|see .*)$", said, re.MULTILINE)
    assert len(reasons) == 3


@pytest.mark.parametrize(
    ("case", "changed"),
    [
        pytest.param(
            "test_reconnect",
            [(TEST, '["halt"]', "[]"), (DRIVER, 'self._write("ABOR;*CLS")', "pass")],
            id="no word for a stop",
        ),
        pytest.param(
            "test_reboot",
            [(TEST, "takes=", 'boot="line", takes='), (DEVICE, "self._show(128)", LINE)],
            id="a boot that ends the line",
        ),
        pytest.param(
            "test_late_answer",
            [(TEST, '"drops_questions": False, ', ""), (DRIVER, GOES_ON, DROPS + GOES_ON)],
            id="a question that is dropped at the meter",
        ),
    ],
)
def test_a_meter_of_another_kind_says_so(
    run: Callable[..., str], case: str, changed: list[tuple[str, str, str]]
) -> None:
    said = run("-k", case, changed=changed)
    assert "1 passed" in said, said


@pytest.mark.parametrize(
    ("case", "planted"),
    [
        pytest.param(
            "test_late_answer",
            ("answered=id,", "answered=(self._next or self._work).id,"),
            id="the end of an earlier question counts for the next one",
        ),
        pytest.param(
            "test_reconnect",
            (FORGETS, FORGETS.replace("line, None, None", "line, None, self._work") + AGAIN),
            id="an order is given again once the meter is back",
        ),
    ],
)
def test_a_planted_bug_is_found(run: Callable[..., str], case: str, planted: tuple[str, str]) -> None:
    said = run("-k", case, changed=[(DRIVER, *planted)])
    assert f"FAILED {TEST}::TestScpiMeter::{case}" in said and "1 failed" in said, said
