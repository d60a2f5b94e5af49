"""A mutant is planted and judged in a child."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from typing import Any

import pytest

from arboleda_mutation import by_tests
from arboleda_mutation.children import Children
from arboleda_mutation.planted import plant
from arboleda_mutation.sources import PACKAGE, Sources

from ..fast.mutation.sizes import CORE
from ..fast.mutation.sizes import sources as sources


def test_a_mutant_is_imported_and_no_file_is_written(sources: Sources, tmp_path: Path) -> None:
    mutant = next(each for each in sources.mutants if each.operator == "comparison")

    def look(say: object) -> dict[str, object]:
        _import_from(tmp_path / PACKAGE.parent)
        plant(mutant, sources)
        from arboleda.core import sizes  # type: ignore[attr-defined]

        return {"fits": sizes.fits(3), "shipped": sizes.fits(4)}

    ended = _in_a_child(look, tmp_path)
    assert ended.answer == {"fits": True, "shipped": False}
    written = {path.suffix for path in (tmp_path / PACKAGE).rglob("*") if path.is_file()}
    assert written == {".py"} and (tmp_path / PACKAGE / "core" / "sizes.py").read_text() == CORE


def test_a_test_sees_the_mutant_though_pytest_wants_to_rewrite_its_module(
    sources: Sources, tmp_path: Path
) -> None:
    (tmp_path / "conftest.py").write_text("import pytest\n\npytest.register_assert_rewrite('arboleda')\n")
    (tmp_path / "test_sizes.py").write_text(
        "from arboleda.core import sizes\n\ndef test_limit():\n    assert not sizes.fits(3)\n"
    )
    (tmp_path / "pytest.ini").write_text("[pytest]\naddopts = --import-mode=importlib\n")
    mutant = next(each for each in sources.mutants if each.operator == "comparison")

    def judge(say: Any) -> dict[str, Any]:
        _import_from(tmp_path / PACKAGE.parent)
        return by_tests.judge(sources, mutant, [("test_sizes.py::test_limit", 0.1)], say)

    ended = _in_a_child(judge, tmp_path)
    assert ended.answer == {"killed": True, "by": "test_sizes.py::test_limit", "ran": 1}


def test_a_child_that_dies_says_by_what_and_where(tmp_path: Path) -> None:
    def die(say: object) -> dict[str, object]:
        say({"at": "the third test"})  # type: ignore[operator]
        os.kill(os.getpid(), signal.SIGPROF)
        return {}

    ended = _in_a_child(die, tmp_path)
    assert (ended.answer, ended.signal, ended.at) == (None, signal.SIGPROF, "the third test")


def test_nothing_is_left_of_children_that_are_not_awaited(tmp_path: Path) -> None:
    noted = tmp_path / "pid"

    def wait(say: object) -> dict[str, object]:
        noted.write_text(str(os.getpid()))
        signal.pause()
        return {}

    def look(say: object) -> dict[str, object]:
        while not noted.exists() or not noted.read_text():
            pass
        return {}

    with Children[str](2, tmp_path / "log") as children:
        next(iter(children.run([("waits", wait), ("ends", look)])))
    with pytest.raises(ProcessLookupError):
        os.kill(int(noted.read_text()), 0)


def _import_from(folder: Path) -> None:
    """Have this process import `arboleda` from there, anew, and write nothing."""
    for name in [each for each in sys.modules if each.partition(".")[0] == "arboleda"]:
        del sys.modules[name]
    sys.path.insert(0, str(folder))
    sys.dont_write_bytecode = True


def _in_a_child(work: object, tmp_path: Path) -> object:
    with Children[str](1, tmp_path / "log") as children:
        (_, ended) = next(iter(children.run([("only", work)])))  # type: ignore[list-item]
    return ended


def test_a_test_that_is_slow_on_a_busy_machine_is_no_kill(tmp_path: Path) -> None:
    (tmp_path / "pytest.ini").write_text("[pytest]\ntimeout = 1000\n")
    (tmp_path / "test_slow.py").write_text(
        "from signal import ITIMER_REAL, getitimer\n\n"
        "def test_no_clock_runs():\n    assert getitimer(ITIMER_REAL) == (0.0, 0.0)\n"
    )

    def run(say: object) -> dict[str, object]:
        return {"status": by_tests._pytest(tmp_path, by_tests.ARGUMENTS, ["test_slow.py"], object())}

    ended = _in_a_child(run, tmp_path)
    assert ended.answer == {"status": 0}
