"""The sample, the order of its judges, and the book."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda_mutation import argued, by_tests
from arboleda_mutation.book import Book, Verdict
from arboleda_mutation.reach import Reach
from arboleda_mutation.report import Row, totals
from arboleda_mutation.sources import Sources

from .sizes import sources as sources


def test_a_seed_draws_the_same_sample_and_a_larger_one_has_all_of_it(sources: Sources) -> None:
    small, large = sources.sample(2, seed=1), sources.sample(3, seed=1)
    assert large[:2] == small == sources.sample(2, seed=1)
    assert [each.key for each in sources.sample(9, seed=2)] != [
        each.key for each in sources.sample(9, seed=1)
    ]


def test_who_comes_by_the_line_is_asked_and_the_killer_first(sources: Sources) -> None:
    mutant = next(each for each in sources.mutants if each.function == "fits")
    bits = {"1": "0", "5": "7", "6": "b"}  # the statement is in line 6
    names, lines = ["a", "b", "c", "d"], {mutant.file: bits, f"{mutant.file}@import": {"2": "0"}}
    reach = Reach(names=names, cpu_s=[0.1, 3.0, 0.1, 0.4], failed=[], lines=lines)
    breadth = reach.breadth()
    assert by_tests.in_order(mutant, reach, breadth, "") == [("a", 0.1), ("d", 0.4), ("b", 3.0)]
    assert by_tests.in_order(mutant, reach, breadth, "b")[0] == ("b", 3.0)


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


@pytest.mark.long
def test_every_argued_survivor_is_a_mutant_of_the_code_as_it_is() -> None:
    shipped = Sources(Path(__file__).parents[4])
    reasons = argued.reasons()
    assert argued.gone(reasons, shipped.mutants) == []
    assert all(len(reason) > 20 for reason in reasons.values())
