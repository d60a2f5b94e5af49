"""The sample, the planting, the children and the book."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from typing import Any

import pytest

from arboleda_mutation import argued, by_tests
from arboleda_mutation.book import Book, Verdict
from arboleda_mutation.children import Children
from arboleda_mutation.planted import plant
from arboleda_mutation.reach import Reach
from arboleda_mutation.report import Row, totals
from arboleda_mutation.sources import PACKAGE, Sources

CORE = """
LIMIT = 3


def fits(number):
    return number < LIMIT
"""


@pytest.fixture
def sources(tmp_path: Path) -> Sources:
    """A tree with one file of the core."""
    file = tmp_path / PACKAGE / "core" / "sizes.py"
    file.parent.mkdir(parents=True)
    for folder in (file.parent, file.parents[1]):
        (folder / "__init__.py").touch()
    file.write_text(CORE)
    return Sources(tmp_path)


def test_a_seed_draws_the_same_sample_and_a_larger_one_has_all_of_it(sources: Sources) -> None:
    small, large = sources.sample(2, seed=1), sources.sample(3, seed=1)
    assert large[:2] == small == sources.sample(2, seed=1)
    assert [each.key for each in sources.sample(9, seed=2)] != [
        each.key for each in sources.sample(9, seed=1)
    ]


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


def test_who_comes_by_the_line_is_asked_and_the_killer_first(sources: Sources) -> None:
    mutant = next(each for each in sources.mutants if each.function == "fits")
    bits = {"1": "0", "5": "7", "6": "b"}  # the statement is in line 6
    names, lines = ["a", "b", "c", "d"], {mutant.file: bits, f"{mutant.file}@import": {"2": "0"}}
    reach = Reach(names=names, cpu_s=[0.1, 3.0, 0.1, 0.4], failed=[], lines=lines)
    breadth = reach.breadth()
    assert by_tests.in_order(mutant, reach, breadth, "") == [("a", 0.1), ("d", 0.4), ("b", 3.0)]
    assert by_tests.in_order(mutant, reach, breadth, "b")[0] == ("b", 3.0)


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


def test_what_is_carried_out_at_import_concerns_everybody_in_the_file(sources: Sources) -> None:
    mutant = next(each for each in sources.mutants if not each.function)
    lines = {mutant.file: {"6": "5"}, f"{mutant.file}@import": {"2": "0"}}
    assert Reach(names=["a", "b", "c"], cpu_s=[0.0] * 3, lines=lines).of(mutant) == ["a", "c"]


def test_every_test_is_asked_about_what_none_is_seen_to_come_by(sources: Sources) -> None:
    mutant = next(each for each in sources.mutants if not each.function)
    lines = {mutant.file: {}, f"{mutant.file}@import": {"2": "0"}}
    reach = Reach(names=["a", "b", "c"], cpu_s=[0.3, 0.1, 0.2], failed=["c"], lines=lines)
    asked = by_tests.in_order(mutant, reach, {"a": 1, "b": 1, "c": 1}, "")
    assert asked == [("b", 0.1), ("a", 0.3)]


def _verdict(**said: object) -> Verdict:
    whole = {"key": "k", "judge": "simulator", "of": "now", "killed": False, "by": "", "ran": 25, "asked": 25}
    return Verdict(**{**whole, "cpu_s": 1.0, **said})  # type: ignore[arg-type]


def test_a_book_goes_on_where_it_was_and_only_hints_on_other_sources(tmp_path: Path) -> None:
    Book(tmp_path / "book").add(_verdict())
    book = Book(tmp_path / "book")
    assert book.found("k", "simulator", "now", 25) == _verdict()
    assert book.found("k", "simulator", "now", 100) is None
    assert book.survived("k", "simulator", "now") == 25
    book.add(_verdict(killed=True, by="seed 3: x"))
    assert book.found("k", "simulator", "now", 100) is not None
    assert book.found("k", "simulator", "later", 25) is None
    assert book.hint("k", "simulator") == "seed 3: x"


def test_totals_count_each_mutant_once(sources: Sources) -> None:
    mutant, kill, live = sources.mutants[0], _verdict(killed=True), _verdict()
    rows = [
        Row(mutant=mutant, tests=tests, simulator=simulator, reason=reason)
        for tests, simulator, reason in (
            (kill, kill, None),
            (kill, live, None),
            (live, kill, None),
            (live, live, "nobody can tell"),
            (live, live, None),
        )
    ]
    found = totals(rows)
    assert [found[end] for end in ("both", "tests", "simulator", "argued", "survived")] == [1] * 5
    assert (found["killed_percent"], found["killed_or_argued_percent"]) == (60.0, 80.0)
    assert found["by_simulator_alone_percent"] == 40.0


def test_every_argued_survivor_is_a_mutant_of_the_code_as_it_is() -> None:
    shipped = Sources(Path(__file__).parents[3])
    reasons = argued.reasons()
    assert argued.gone(reasons, shipped.mutants) == []
    assert all(len(reason) > 20 for reason in reasons.values())
