"""Looks for the bugs of the engine: the simulator alone first, then, for what it leaves, the nearest tests.

`PYTHONPATH=tools:tools/mutation:tools/drawn python -m tools.tests.mutants.planted_engine`, in the project's
folder, says of each bug who finds it. Verdicts are kept; after Ctrl-C the same command goes on. No file is
changed: a bug is planted as its module is imported, in a process of its own.
"""

from __future__ import annotations

import argparse
import ast
import json
import re
import signal
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import cache, cached_property, partial
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from arboleda_mutation import by_tests
from arboleda_mutation.book import Book, Verdict
from arboleda_mutation.children import Children, Ended, Say, Work
from arboleda_mutation.judging import FOLDERS, SIMULATOR, TESTS, warm
from arboleda_mutation.planted import plant
from arboleda_mutation.reach import Reach, Tracer
from arboleda_mutation.sources import PACKAGE, PROOFS, Sources, fingerprint

from .engine_bug import EngineBug
from .engine_bugs import ENGINE_BUGS

ROOT = Path(__file__).parents[3]
SEEDS = 25
LAYERS = ("kinds", "dispatch", "recipes", "trees", "resume", "departures", "model", "core", "wire")
OF_FILES = "bt_xml"  # the layer of arboleda_trees
TREES = Path("packages/arboleda_trees/src/arboleda_trees")
LEAST_CPU_S = 30.0  # a seed takes less than a second
Task = tuple[EngineBug, str]


class BugSources(Sources):
    """The source tree, in which a bug of a table is planted as a mutant is."""

    def mutated(self, mutant: Any) -> ast.Module:
        return ast.parse(mutant.edited(self.path(mutant.file).read_text(encoding="utf-8")))

    def path(self, file: str) -> Path:
        return self.root / TREES / file if _layer(file) == OF_FILES else super().path(file)

    def module(self, file: str) -> str:
        return f"{_package(file)}.{Path(file).stem}".removesuffix(".__init__")


def _layer(file: str) -> str:
    return file.split("/")[0]


def _package(file: str) -> str:
    """The package in which a file is a module."""
    root = TREES.name if _layer(file) == OF_FILES else "arboleda"
    return ".".join((root, *Path(file).parts[:-1]))


class Place(NamedTuple):
    """Place of a bug, as `Reach` asks for it."""

    file: str
    lines: tuple[int, int]
    function: str = "any"


def measure(seeds: int, say: Say) -> dict[str, Any]:
    """Lines that each seed reaches, with nothing planted."""
    tracer = Tracer(ROOT / PACKAGE, LAYERS, ROOT / TREES / OF_FILES)
    with tracer.running():
        from . import engine_weathers

        for seed in range(1, seeds + 1):
            engine_weathers.forget()
            with tracer.during(str(seed)):
                found = engine_weathers.found_at(seed)
            tracer.reach.failed += [str(seed)] if found else []
            say({"at": str(seed)})
    return tracer.reach.as_json()


def by_simulator(sources: BugSources, bug: EngineBug, seeds: Sequence[int], say: Say) -> dict[str, Any]:
    """Run these seeds until something is found."""
    plant(bug, sources)  # type: ignore[arg-type]
    say({"at": "the first seed"})
    signal.setitimer(signal.ITIMER_PROF, LEAST_CPU_S)
    try:
        from .engine_weathers import found_at
    except Exception as error:  # noqa: BLE001 - a plant that cannot even be built is found at once
        return {"killed": True, "by": f"{type(error).__name__} before the first seed", "ran": 0}
    for number, seed in enumerate(seeds, start=1):
        say({"at": f"seed {seed}"})
        signal.setitimer(signal.ITIMER_PROF, LEAST_CPU_S)
        if found := _found(found_at, seed):
            return {"killed": True, "by": f"seed {seed}: {found}", "ran": number}
    return {"killed": False, "by": "", "ran": len(seeds)}


def _found(found_at: Callable[[int], str], seed: int) -> str:
    try:
        return found_at(seed)
    except Exception as error:  # noqa: BLE001 - a plant that cannot be drawn or loaded is found, too
        return f"{type(error).__name__} while it is made"


def nearest(file: str) -> list[str]:
    """The tests of a file: those of its layer before others, then the scenarios; in each those that import it
    first.
    """
    layer, module, package = _layer(file), Path(file).stem, _package(file)
    room = f"{package.partition('.')[0]}.{layer}"
    named = re.compile(rf"from {re.escape(package)}(\.{module} import| import [^\n]*\b{module}\b)")
    ranks = {
        path: (path.startswith("tests/scenario/"), f"/{layer}/" not in path, not found)
        for path, text in _tests().items()
        if (found := bool(named.search(text))) or room in text or "/scenario/" in path
    }
    return sorted(ranks, key=lambda path: (ranks[path], path))


@cache
def _tests() -> dict[str, str]:
    paths = [path for folder in by_tests.TESTS for path in sorted((ROOT / folder).rglob("test_*.py"))]
    return {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in sorted(paths)}


def _worlds() -> list[Path]:
    """Folders that a run of the simulator goes by, without those that only judge it."""
    folders = [path for path in sorted((ROOT / PROOFS / "simulator").iterdir()) if path.is_dir()]
    return [path.relative_to(ROOT) for path in folders if path.name != "invariants"]


class Looking:
    """Has the book of verdicts, below `state`."""

    def __init__(self, state: Path, seeds: int, jobs: int) -> None:
        state.mkdir(parents=True, exist_ok=True)
        self._seeds = seeds
        self._jobs = jobs
        self._log = state / "engine-log.txt"
        self._reach_file = state / "engine-reach.json"
        self._sources = BugSources(ROOT)
        self.book = Book(state / "engine.jsonl")
        files = [Path(__file__).with_name(name) for name in ("engine_weathers.py", "themes.py")]
        weathers = b"".join(each.read_bytes() for each in files)
        engine = fingerprint(ROOT, (*FOLDERS[SIMULATOR], str(TREES / OF_FILES)))
        layers = [*(PACKAGE / each for each in LAYERS), TREES / OF_FILES]
        runs = fingerprint(ROOT, map(str, (*layers, *_worlds())))
        self._run_by = sha256(runs.encode() + weathers).hexdigest()[:16]
        self._of = {
            SIMULATOR: sha256(engine.encode() + weathers).hexdigest()[:16],
            TESTS: fingerprint(ROOT, (str(PACKAGE), str(TREES), *by_tests.TESTS)),
        }

    def verdict(self, bug: EngineBug, judge: str) -> Verdict | None:
        """The verdict of the book on the sources as they are."""
        return self.book.found(bug.key, judge, self._of[judge], self._seeds if judge == SIMULATOR else 0)

    def run(self, bugs: Sequence[EngineBug], judge: str) -> Iterator[tuple[EngineBug, Verdict]]:
        """Each new verdict as it comes; what the book has already is not judged again."""
        tasks = [((bug, judge), self._work(bug, judge)) for bug in bugs if self.verdict(bug, judge) is None]
        with Children[Task](self._jobs, self._log) as children:
            for (bug, _), ended in children.run(tasks):
                verdict = self._verdict(bug, judge, ended)
                self.book.add(verdict)
                yield bug, verdict

    def _work(self, bug: EngineBug, judge: str) -> Work:
        before = self.book.hint(bug.key, judge)
        if judge == TESTS:
            first = before.partition("::")[0]
            files = sorted(nearest(bug.file), key=lambda path: path != first)
            return partial(by_tests.judge_files, self._sources, bug, files)
        survived = self.book.survived(bug.key, judge, self._of[judge])
        first = before.removeprefix("seed ").partition(":")[0]
        place = Place(bug.file, bug.lines(self._sources.path(bug.file).read_text(encoding="utf-8")))
        reached = map(int, self._reach.of(place))  # type: ignore[arg-type]
        seeds = [seed for seed in reached if survived < seed <= self._seeds]
        seeds.sort(key=lambda seed: str(seed) != first)
        return partial(by_simulator, self._sources, bug, seeds)

    @cached_property
    def _reach(self) -> Reach:
        """Lines that each seed comes by; other seeds cannot find what is wrong there."""
        file, of = self._reach_file, self._run_by
        kept = json.loads(file.read_text()) if file.exists() else {}
        if kept.get("of") != of or kept["seeds"] < self._seeds:
            print("measuring which seeds come by which lines", flush=True)
            with Children[str](1, self._log) as children:
                ((_, ended),) = children.run([("reach", partial(measure, self._seeds))])
            if ended.answer is None:
                raise RuntimeError(f"nothing could be measured; {self._log} says why")
            kept = {"of": of, "seeds": self._seeds, "reach": ended.answer}
            file.write_text(json.dumps(kept))
        reach = Reach(**kept["reach"])
        if reach.failed:
            raise RuntimeError(f"these seeds find something with nothing planted: {', '.join(reach.failed)}")
        return reach

    def _verdict(self, bug: EngineBug, judge: str, ended: Ended) -> Verdict:
        answer = ended.answer
        if answer is None:  # it computed without an end, took all memory, or ended the process
            how = f"signal {ended.signal}" if ended.signal else "an end without a word"
            answer = {"killed": True, "by": f"{ended.at or 'the import'}: {how}", "ran": 0}
        asked = self._seeds if judge == SIMULATOR else 0
        return Verdict(key=bug.key, judge=judge, of=self._of[judge], asked=asked, cpu_s=ended.cpu_s, **answer)


def main(arguments: list[str] | None = None) -> int:
    """Say of each bug who finds it, and how many are found; status 1 where one survives without a reason."""
    options = _options(arguments)
    bugs = sample(options.sample, options.only)
    looking = Looking(options.state, options.seeds, options.jobs)
    warm()
    try:
        for judge in (SIMULATOR, TESTS)[: 1 if options.simulator_alone else 2]:
            left = [bug for bug in bugs if judge == SIMULATOR or not _is_found(looking, bug, SIMULATOR)]
            for number, (bug, verdict) in enumerate(looking.run(left, judge), start=1):
                word = verdict.by if verdict.killed else "NOT FOUND"
                told = f"{number:4} {judge:9} {verdict.cpu_s:6.1f} s  {bug.file}: {bug.about}  {word}"
                print(told, flush=True)
    except KeyboardInterrupt:
        print("interrupted; what was judged is kept, the same command goes on")
        return 130
    return _print_summary(looking, bugs)


def sample(size: int | None, only: str = "") -> list[EngineBug]:
    """As many of the bugs as wanted, the same every time; a larger sample has all of a smaller one."""
    found = [bug for bug in ENGINE_BUGS if only in bug.key]
    found.sort(key=lambda bug: sha256(f"{bug.file} {bug.about}".encode()).hexdigest())
    return found[:size]


def _is_found(looking: Looking, bug: EngineBug, judge: str) -> bool:
    verdict = looking.verdict(bug, judge)
    return verdict is not None and verdict.killed


def _print_summary(looking: Looking, bugs: Sequence[EngineBug]) -> int:
    """Print the table: a row for each layer, then every survivor."""
    rows: dict[str, Counter[str]] = {}
    survivors = []
    for bug in bugs:
        end = next((judge for judge in (SIMULATOR, TESTS) if _is_found(looking, bug, judge)), "survived")
        end = "argued" if end == "survived" and bug.argued else end
        rows.setdefault(bug.file.split("/")[0], Counter())[end] += 1
        survivors += [bug] if end in ("survived", "argued") else []
    rows["all"] = sum(rows.values(), Counter[str]())
    for bug in survivors:
        print(f"\n{bug.file}: {bug.about}\n- {bug.old}\n+ {bug.new}\n{bug.argued or 'survives'}")
    ends = (SIMULATOR, TESTS, "argued", "survived")
    print(f"\n{'':12}{'bugs':>6}" + "".join(f"{end:>11}" for end in ends))
    for layer, row in rows.items():
        print(f"{layer:12}{row.total():6}" + "".join(f"{row[end]:11}" for end in ends))
    return int(any(not bug.argued for bug in survivors))


def _options(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="planted_engine", description=__doc__)
    parser.add_argument("--sample", type=int, help="how many of the bugs are planted; all by default")
    parser.add_argument("--only", default="", help="only bugs that have this in their rows")
    parser.add_argument("--seeds", type=int, default=SEEDS, help="how many seeds the simulator gets for each")
    parser.add_argument("--jobs", type=int, default=2, help="how many processes judge at the same time")
    parser.add_argument("--simulator-alone", action="store_true", help="the tests do not judge")
    parser.add_argument("--state", type=Path, default=ROOT / ".mutation", help="where verdicts are kept")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main())
