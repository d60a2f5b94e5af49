"""The whole of it: measure who reaches what, have both judges look for every mutant, keep what they say."""

from __future__ import annotations

import importlib
import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from . import by_simulator, by_tests
from .book import Book, Verdict
from .children import Children, Ended, Work
from .mutant import Mutant
from .reach import Reach
from .sources import ENGINE, PACKAGE, PROOFS, Sources, fingerprint

TESTS, SIMULATOR = JUDGES = ("tests", "simulator")
SIMULATED = ("kinds", "recipes", "views", "wire", "sim", "plant_file", "plants")
FOLDERS = {
    TESTS: (str(PACKAGE), str(PROOFS), "wire_vectors"),
    SIMULATOR: (
        "examples",
        "tools/drawn",
        *(str(PACKAGE / each) for each in (*ENGINE, *SIMULATED)),
        *(str(PROOFS / each) for each in ("simulator", "campaigns")),
    ),
}
LIBRARIES = ("fastapi", "httpx", "PIL", "py_trees", "pydantic", "rich.progress", "typer", "yaml")
Told = Callable[[str], None]
Task = tuple[Mutant, str, int]  # the mutant, the judge, how many seeds it has survived when this one is over


@dataclass(frozen=True, kw_only=True)
class Order:
    """Order of a run: `judges` look for `mutants`, the simulator with so many seeds, in `jobs` processes."""

    mutants: list[Mutant]
    judges: tuple[str, ...]
    seeds: int
    jobs: int


class Judging:
    """Has everything below `state`: the book, who reaches what, and what the children print.

    `tests` are the folders of the tests that judge.
    """

    def __init__(self, sources: Sources, state: Path, tests: tuple[str, ...] = by_tests.TESTS) -> None:
        self._sources = sources
        self._tests = tests
        self._state = state
        self._log = state / "log.txt"
        state.mkdir(parents=True, exist_ok=True)
        self.book = Book(state / "verdicts.jsonl")
        folders = {TESTS: (*FOLDERS[TESTS], *tests), SIMULATOR: FOLDERS[SIMULATOR]}
        self._of = {judge: fingerprint(sources.root, folders[judge]) for judge in JUDGES}

    def run(self, order: Order, tell: Told) -> Iterator[Verdict]:
        """Each new verdict as it comes; what the book has already is not judged again."""
        warm()
        reaches = self._reaches(order, tell)
        breadth = reaches[TESTS].breadth() if TESTS in reaches else {}
        with Children[Task](order.jobs, self._log) as children:
            for (mutant, judge, asked), ended in children.run(self._tasks(order, reaches, breadth)):
                verdict = self._verdict(mutant, judge, asked, ended)
                self.book.add(verdict)
                yield verdict

    def verdict(self, mutant: Mutant, judge: str, seeds: int) -> Verdict | None:
        """The verdict of the book on the sources as they are."""
        return self.book.found(mutant.key, judge, self._of[judge], seeds if judge == SIMULATOR else 0)

    def _tasks(
        self, order: Order, reaches: dict[str, Reach], breadth: dict[str, int]
    ) -> Iterator[tuple[Task, Work]]:
        for judge in order.judges:
            for mutant in order.mutants:
                if self.verdict(mutant, judge, order.seeds) is not None:
                    continue
                hint = self.book.hint(mutant.key, judge)
                if judge == TESTS:
                    tests = by_tests.in_order(mutant, reaches[judge], breadth, hint)
                    yield (mutant, judge, 0), partial(by_tests.judge, self._sources, mutant, tests)
                else:
                    survived = self.book.survived(mutant.key, judge, self._of[judge])
                    seeds = by_simulator.in_order(
                        mutant, reaches[judge], range(survived + 1, order.seeds + 1), hint
                    )
                    work = partial(by_simulator.judge, self._sources, mutant, seeds)
                    yield (mutant, judge, order.seeds), work

    def _verdict(self, mutant: Mutant, judge: str, asked: int, ended: Ended) -> Verdict:
        answer = ended.answer
        if answer is None:  # it computed without an end, took all memory, or ended the process
            how = f"signal {ended.signal}" if ended.signal else "an end without a word"
            answer = {"killed": True, "by": f"{ended.at or 'the import'}: {how}", "ran": 0}
        return Verdict(
            key=mutant.key, judge=judge, of=self._of[judge], asked=asked, cpu_s=ended.cpu_s, **answer
        )

    def _reaches(self, order: Order, tell: Told) -> dict[str, Reach]:
        """Lines that each judge reaches; measured at the same time where that is not known yet."""
        reaches: dict[str, Reach] = {}
        missing: dict[str, Work] = {}
        for judge in order.judges:
            path = self._reach_file(judge)
            kept = json.loads(path.read_text()) if path.exists() else {}
            if kept.get("of") == self._of[judge] and kept.get("seeds", 0) >= order.seeds:
                reaches[judge] = Reach(**kept["reach"])
                continue
            tell(f"measuring which {'tests' if judge == TESTS else 'seeds'} reach which lines")
            root = self._sources.root
            missing[judge] = (
                partial(by_tests.measure, root, self._tests)
                if judge == TESTS
                else partial(by_simulator.measure, root, order.seeds)
            )
        with Children[str](order.jobs, self._log) as children:
            for judge, ended in children.run(missing.items()):
                if ended.answer is None:
                    raise RuntimeError(f"nothing could be measured; {self._log} says why")
                reaches[judge] = reach = Reach(**ended.answer)
                if reach.failed:
                    tell(f"these fail with nothing planted, and are left out: {', '.join(reach.failed)}")
                found = {"of": self._of[judge], "seeds": order.seeds, "reach": ended.answer}
                self._reach_file(judge).write_text(json.dumps(found))
        return reaches

    def _reach_file(self, judge: str) -> Path:
        return self._state / f"reach-{judge}.json"


def warm() -> None:
    """Import what children need, but nothing that may have a bug."""
    for name in LIBRARIES:
        importlib.import_module(name)
