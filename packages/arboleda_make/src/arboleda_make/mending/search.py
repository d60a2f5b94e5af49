"""Search of a mend: likely changes of a plant's files, each tried until one leaves nothing that is wrong.

A change is proposed only after the plant was checked with it, and run without faults: less is wrong then, and
nothing that is worse. What is likely is read off the names that the findings say, the devices
of their cell and the rules of the plant; the rules themselves and what a recipe is to end with stay.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from arboleda.extension import ArboledaError
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import Cell, PlantModel
from arboleda.plant_check.findings import Checked, PlantFinding, Source, checked
from arboleda.plant_check.mend import Mend, Texts, edit_of, edited
from arboleda.plant_file.draft import shaded
from arboleda.plant_file.yaml_marks import YamlFault, parse
from arboleda_proofs.campaigns.plants import Plant
from arboleda_proofs.campaigns.proof.calm import calm_run, run_findings
from arboleda_proofs.campaigns.proof.scenario import Scenario, scenarios

from .candidate import Candidate
from .clues import Clues, clues_of, words_of
from .plant_edits import plant_candidates
from .python_edits import python_candidates
from .python_source import PythonSource
from .tree_edits import tree_candidates
from .word_edits import word_candidates

MOST_TRIED = 80  # candidates
RUNS = 2  # tasks of a recipe that are run with a candidate
PYTHON, TREES = ".py", ".xml"


@dataclass(frozen=True, kw_only=True)
class Sight:
    """Sight of a plant: what is found of it."""

    findings: tuple[PlantFinding, ...]

    def count(self, source: Source) -> int:
        return sum(each.source is source for each in self.findings)

    @property
    def rank(self) -> tuple[int, int, int]:
        """The fewer the better, the worst first."""
        return self.count(Source.PROBLEM), self.count(Source.WARNING), self.count(Source.RUN)


@dataclass(kw_only=True)
class Search:
    """Search: tries changes of the plant file `file` and of the files that it uses; `tried` counts them.

    It ends after `within_s`, with what it has by then.
    """

    file: Path
    found: Sequence[PlantFinding]  # what is wrong, the worst first
    most: int = MOST_TRIED
    within_s: float = math.inf
    tried: int = 0
    texts: Texts = field(init=False)

    def __post_init__(self) -> None:
        self.texts = texts_of(self.file)

    def mend(self) -> Mend | None:
        """The first change that leaves nothing wrong, or of those tried the one that leaves least; None where
        none of them makes anything better.
        """
        if not self.found or self.file.name not in self.texts:
            return None
        before = Sight(findings=tuple(self.found))
        best: tuple[Candidate, Sight] | None = None
        ends_at = time.monotonic() + self.within_s
        for candidate in self._candidates():
            if self.tried >= self.most or time.monotonic() >= ends_at:
                break
            self.tried += 1
            after = self._sight(candidate, before)
            if after is None or after.rank >= (best[1] if best else before).rank:
                continue
            best = candidate, after
            if not after.findings:
                break
        return None if best is None else self._mend(*best, before)

    def _candidates(self) -> Iterator[Candidate]:
        model = checked(self.file, apart=False).model
        clues = clues_of(self.found, model)
        every = [*self._likely(model, clues)]
        known: set[object] = set()
        for each in sorted(every, key=lambda candidate: -candidate.score):
            if each.cuts not in known:
                known.add(each.cuts)
                yield each

    def _likely(self, model: PlantModel | None, clues: Clues) -> Iterator[Candidate]:
        yield from word_candidates(self.texts, clues)
        yield from plant_candidates(self.file.name, self.texts[self.file.name], model, clues)
        cells = () if model is None else _cells(model, clues)
        for name, text in self.texts.items():
            if name.endswith(TREES):
                yield from tree_candidates(name, text, cells, clues)
        for source in sources(self.texts):
            yield from python_candidates(source, cells, clues)

    def _sight(self, candidate: Candidate, before: Sight) -> Sight | None:
        """The findings with a candidate; None where it does not fit."""
        try:
            texts = edited(self.texts, [edit_of(self.texts, each) for each in candidate.cuts])
        except ArboledaError:
            return None
        contents = {name: text.encode() for name, text in texts.items()}
        with shaded(PlantFiles(plant=self.file.name, contents=contents), self.file) as shade:
            look = checked(shade.plant_file, apart=False)
            if look.model is None or any(each.source is Source.WARNING for each in look.findings):
                return Sight(findings=look.findings)
            return Sight(findings=tuple(self._runs(look, before)))

    def _runs(self, look: Checked, before: Sight) -> Iterator[PlantFinding]:
        """The findings of runs without faults: of the tasks that failed, or of the recipes that are named."""
        assert look.model is not None
        model = Plant(declared=look.model).model
        for scenario in _scenarios(model, before.findings):
            yield from run_findings(calm_run(model, scenario))

    def _mend(self, candidate: Candidate, after: Sight, before: Sight) -> Mend:
        left = {each.sentence for each in after.findings}
        edits = tuple(edit_of(self.texts, each) for each in candidate.cuts)
        return Mend(
            sentence=f"{edits[0].file}:{edits[0].line}: {candidate.sentence}",
            edits=edits,
            mends=tuple(each.sentence for each in before.findings if each.sentence not in left),
            left=len(after.findings),
        )


def texts_of(file: Path) -> dict[str, str]:
    """The texts of a plant file, of trees that it uses, and of Python in folders of what it uses, by name.

    What is no text is left out.
    """
    folder, found = file.parent, _text(file, file.name)
    for word in _used(found.get(file.name, "")):
        there = folder / word
        beside = [there] if word.endswith(TREES) else sorted(there.parent.glob(f"*{PYTHON}"))
        for each in [path for path in beside if path.is_file()]:
            found |= _text(each, each.relative_to(folder).as_posix())
    return found


def sources(texts: Texts) -> Iterator[PythonSource]:
    """The files in Python among them that can be read."""
    for name in [each for each in texts if each.endswith(PYTHON)]:
        with suppress(SyntaxError, ValueError):
            yield PythonSource(name, texts[name])


def _text(file: Path, name: str) -> dict[str, str]:
    """The text of a file by its name; nothing where it has none."""
    try:
        return {name: file.read_text("utf-8")}
    except (OSError, UnicodeDecodeError):
        return {}


def _used(text: str) -> Sequence[str]:
    """The files that a plant file uses which lie in its folder or below."""
    try:
        words = parse(text.encode())[0].children["uses"].value
    except (YamlFault, KeyError):
        return ()
    listed = words if isinstance(words, list) else ()
    return [each for each in map(str, listed) if each.endswith((PYTHON, TREES)) and ".." not in each]


def _cells(model: PlantModel, clues: Clues) -> Sequence[Cell]:
    named = [each for each in model.cells if each.name in words_of(clues.text)]
    return named or model.cells


def _scenarios(model: PlantModel, findings: Iterable[PlantFinding]) -> Iterator[Scenario]:
    """The tasks of runs that found something; else some of each recipe that findings name, or of any."""
    listed = list(findings)
    text = "\n".join(each.sentence for each in listed)
    tasks = {each.task for each in listed if each.task}
    for name in [each.name for cell in model.cells for each in cell.recipes]:
        many: Mapping[str, Scenario] = {each.name: each for each in scenarios(model, [name])}
        bare = {task.partition(" (")[0] for task in tasks}
        if tasks:
            yield from (each for each in many.values() if each.task in bare)
        elif name in text.split() or not any(each in text.split() for each in _recipes(model)):
            yield from [*many.values()][:RUNS]


def _recipes(model: PlantModel) -> Iterator[str]:
    yield from (each.name for cell in model.cells for each in cell.recipes)


def mend_of(file: Path, findings: tuple[PlantFinding, ...], *, within_s: float = math.inf) -> Mend | None:
    """A mend for findings of a plant, looked for so long; None where nothing that was tried is better."""
    return Search(file=file, found=findings, within_s=within_s).mend()
