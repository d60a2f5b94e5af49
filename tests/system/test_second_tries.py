"""What `tests/second_tries.py` makes of failures: runs of pytest whose tests fail as they are told."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from .. import second_tries

ROOT = Path(__file__).parents[2]
LEDGER = """
from pathlib import Path

from tests import second_tries

second_tries.LEDGER = Path(__file__).with_name("ledger.tsv")
"""
ONCE = """
def test_{0}():
    from pathlib import Path
    tried = Path(__file__).with_name("{0}")
    was = tried.exists()
    tried.touch()
    assert was, "nobody came"
"""
TWICE = """
def test_{0}():
    assert not "again"
"""
OF_PRODUCT = """
def test_{0}():
    from pathlib import Path
    tried = Path(__file__).with_name("{0}")
    if not tried.exists():
        tried.touch()
        from arboleda.model.assistants import hours
        hours("noon")
"""

pytestmark = [pytest.mark.system, pytest.mark.smoke]

Ran = subprocess.CompletedProcess[str]


@pytest.fixture
def run(tmp_path: Path) -> Callable[..., Ran]:
    """A run of pytest whose tests are made of these texts; `ledger.tsv` in its folder has its rows."""

    def go(*texts: str, **environment: str) -> Ran:
        (tmp_path / "pytest.ini").write_text("[pytest]\n")
        (tmp_path / "conftest.py").write_text(LEDGER)
        tests = [text.format(f"case_{number}") for number, text in enumerate(texts)]
        (tmp_path / "test_planted.py").write_text("\n".join(tests))
        others = {name: value for name, value in os.environ.items() if not name.startswith(("CI", "PYTEST_"))}
        return subprocess.run(
            [sys.executable, "-m", "pytest", "-p", "tests.second_tries", "-n", "2", "test_planted.py"],
            cwd=tmp_path,
            env=others | {"PYTHONPATH": f"{ROOT}:{ROOT / 'src/arboleda'}"} | environment,
            capture_output=True,
            text=True,
            check=False,
        )

    return go


def rows(folder: Path) -> list[list[str]]:
    ledger = folder / "ledger.tsv"
    return [line.split("\t") for line in ledger.read_text().splitlines()] if ledger.exists() else []


def test_a_test_that_passes_at_its_second_try_leaves_a_row(run: Callable[..., Ran], tmp_path: Path) -> None:
    ran = run(ONCE)
    assert ran.returncode == 0, ran.stdout
    [(test, _, _, words, load)] = rows(tmp_path)
    assert (test, words) == ("test_planted.py::test_case_0", "AssertionError: nobody came")
    assert float(load) >= 0
    assert f"{test}: PASSED at its second try" in ran.stdout


def test_in_ci_the_row_is_printed_only(run: Callable[..., Ran], tmp_path: Path) -> None:
    ran = run(ONCE, CI="true")
    assert ran.returncode == 0, ran.stdout
    assert rows(tmp_path) == []
    assert "AssertionError: nobody came" in ran.stdout.rpartition("PASSED at its second try")[2]


def test_a_test_that_fails_again_is_red(run: Callable[..., Ran], tmp_path: Path) -> None:
    ran = run(TWICE, ONCE)
    assert ran.returncode == 1
    assert "test_case_0: FAILED again" in ran.stdout
    assert [row[0] for row in rows(tmp_path)] == ["test_planted.py::test_case_1"]


def test_an_exception_of_the_product_is_red(run: Callable[..., Ran], tmp_path: Path) -> None:
    ran = run(OF_PRODUCT)
    assert ran.returncode == 1
    assert "test_case_0: an exception of the product is not tried again" in ran.stdout
    assert rows(tmp_path) == []


def test_more_than_three_are_red(run: Callable[..., Ran], tmp_path: Path) -> None:
    ran = run(ONCE, ONCE, ONCE, ONCE)
    assert ran.returncode == 1
    assert "4 tests failed; more than 3 are not tried again" in ran.stdout
    assert rows(tmp_path) == []


def test_what_passes_is_not_said(run: Callable[..., Ran], tmp_path: Path) -> None:
    (tmp_path / "case_0").touch()
    ran = run(ONCE)
    assert ran.returncode == 0
    assert "second tries" not in ran.stdout


@pytest.mark.parametrize("name", ["TimeoutError", "asyncio.TimeoutError", "httpx.ReadTimeout"])
def test_a_wait_that_ran_out_is_not_the_products(name: str) -> None:
    child = (
        f'Traceback (most recent call last):\n  File "{ROOT}/src/arboleda/x.py", line 1, in f\n{name}: late\n'
    )
    assert not second_tries.is_of_product(AssertionError(f"no word in:\n{child}"))


def test_an_exception_in_the_output_of_a_process_is_the_products() -> None:
    calls = (
        f'  File "{ROOT}/src/arboleda/x.py", line 1, in f\n  File "/usr/lib/python3/json.py", line 2, in g\n'
    )
    child = f"Traceback (most recent call last):\n{calls}KeyError: 'x'\n"
    assert second_tries.is_of_product(AssertionError(f"no word in:\n{child}"))


def test_a_failed_test_of_a_ros_2_package_is_not_the_products() -> None:
    child = (
        "Traceback (most recent call last):\n"
        f'  File "{ROOT}/src/arboleda_ros/test/test_x.py", line 1, in f\nAssertionError: nobody came\n'
    )
    assert not second_tries.is_of_product(AssertionError(f"no word in:\n{child}"))
