"""Trial of recipes and kinds in a process of its own: a fork where one is safe, else another Python.

So a recipe that never ends, or that ends Python, is a problem of its file.
"""

from __future__ import annotations

import faulthandler
import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from arboleda.host import abilities, forks
from arboleda.host.forks import Fork
from arboleda.host.limits import ProcessorAlarm, ended_by_alarm
from arboleda.model.plant_model import Cell
from arboleda.model.recipe import Recipe
from arboleda.recipes.authoring import WrittenRecipe

from . import drivers, extensions, own_kinds, own_recipes
from .devices import CELLS, is_of_devices
from .document import Document
from .problems import MarkedProblem
from .python_uses import PythonUses, SourceSpot, unwatched

LONGEST_S = 10.0  # of processor time for the import of a file, and for each build of a recipe
WAITS = 4.0  # times as long it may take by the clock, on a busy machine or waiting for something
HAS_PROCESSES = abilities.PROCESSES  # in a browser's tab the page can end its worker instead
STUCK_S = 60.0  # by then the watch of the other process has hung as well
SLOW = f"nothing came of it for {STUCK_S:g} s; try again when this machine has less to do"
PATH = "import sys, json; sys.path[:] = json.loads(sys.argv[1]); "
START = PATH + "from arboleda.plant_file import recipe_trial; recipe_trial.main(sys.argv[2])"
FRAME = re.compile(r'^  File "(.*)", line (\d+) in ', re.MULTILINE)
PLANT, REQUEST, RESULT, PHASE, STACK = "plant", "request.json", "result.json", "phase.json", "stack.txt"


@dataclass
class TrialResult:
    """Result of a trial: problems of the plant file (`here`) and of other files, and the offers of each cell.

    `missed` has by cell and recipe why the cell does not offer the recipe. `unused` has by recipe sentences
    on steps that it makes and never does.
    """

    here: list[MarkedProblem] = field(default_factory=list)
    elsewhere: list[str] = field(default_factory=list)
    offers: dict[str, list[str]] = field(default_factory=dict)
    missed: dict[str, dict[str, str]] = field(default_factory=dict)
    unused: dict[str, list[str]] = field(default_factory=dict)


@dataclass
class PlantPython:
    """The Python of a plant, and the names of the recipes that each cell offers; see `TrialResult`."""

    document: Document
    used: PythonUses = field(default_factory=PythonUses)
    offers: dict[str, list[str]] = field(default_factory=dict)
    missed: dict[str, dict[str, str]] = field(default_factory=dict)
    unused: dict[str, list[str]] = field(default_factory=dict)

    def offered(self, cells: Sequence[Cell]) -> dict[str, tuple[Recipe, ...]]:
        """By cell, the plant's own recipes that the cell offers."""
        names = {cell.name: self.offers.get(cell.name, []) for cell in cells}
        rows = {name: [self._tried(each) for each in offers] for name, offers in names.items()}
        beside = {cell.name: cell.recipes for cell in cells}  # recipes of the short form
        return {
            name: _marked(self.document, name, each, beside[name], self.used.source)
            for name, each in rows.items()
            if each
        }

    def _tried(self, name: str) -> Recipe:
        """The recipe with the unused steps that its trial noted."""
        recipe = self.used.recipes[name]
        unused = tuple(self.unused.get(name, ()))
        return replace(recipe, unused=unused) if isinstance(recipe, WrittenRecipe) else recipe


def brought(document: Document, content: bytes, *, apart: bool = True) -> PlantPython:
    """The Python that a plant file uses, once a trial has passed; else none of it, with the problems kept.

    `apart`: the trial is in another process, where there can be one.
    """
    places = [(*CELLS, name) for name in document.keys(CELLS)]
    of_devices = [place for place in places if is_of_devices(document, place)]
    words = own_recipes.listed(document) if document.has(own_recipes.SECTION) else ()
    if not document.has(own_recipes.SECTION):
        for place in [each for each in of_devices if not document.has((*each, "handover"))]:
            how = 'name a file that has one at the top of this one: "uses: [recipes.py]"'
            document.problem(place, f"offers no recipe; {how}", at=place)
    has_packages = any(drivers.named(document)) or any(extensions.named(document))
    if not (words or own_kinds.needs_python(document) or has_packages):
        return PlantPython(document)
    result = verdict(document.name, document.folder, content, apart=apart)
    document.keep_all(result.here, result.elsewhere)
    if any(document.problems):
        return PlantPython(document, PythonUses(is_whole=False, may_import=False))
    used = own_recipes.imported(document, words, unwatched)
    if any(document.problems):  # a file may do another thing the second time
        return PlantPython(document, used)
    has_effect = of_devices or used.recipes or any(drivers.named(document))
    if words and not has_effect:
        document.problem(own_recipes.SECTION, "brings no recipe, so this has no effect; delete it")
    return PlantPython(document, used, result.offers, result.missed, result.unused)


def _marked(
    document: Document, cell: str, recipes: Sequence[Recipe], beside: Sequence[Recipe], source: str
) -> tuple[Recipe, ...]:
    """The recipes of a cell with their source; the default one of tasks is marked.

    The default is the recipe that the cell names, or the only recipe of the cell.
    """
    default = document.value((*CELLS, cell, "default_recipe"))
    alone = len(recipes) == 1 and not beside
    return tuple(replace(each, is_default=each.name == default or alone, source=source) for each in recipes)


def verdict(name: str, beside: Path | None, content: bytes, *, apart: bool = True) -> TrialResult:
    """The result of trying the recipes that a plant file uses, in another process, if there can be one."""
    if not (apart and HAS_PROCESSES):
        from .recipe_check import trial  # which the plant's own process does not need

        return trial(name, content, beside, unwatched)
    with TemporaryDirectory(prefix="arboleda-") as made:
        folder = Path(made)
        (folder / PLANT).write_bytes(content)
        limits = {"longest_s": LONGEST_S, "by_clock_s": WAITS * LONGEST_S}
        request = {"name": name, "folder": None if beside is None else str(beside), **limits}
        (folder / REQUEST).write_text(json.dumps(request), "utf-8")
        status = _run(folder)
        if (folder / RESULT).exists():
            result = json.loads((folder / RESULT).read_text("utf-8"))
            return TrialResult(**result)
        return TrialResult(elsewhere=[broken_off(folder, status)])


def main(name: str) -> None:
    """Run as the other process: import, build, write down the result, end."""
    from .recipe_check import trial  # which the plant's own process does not need

    folder = Path(name)
    request = json.loads((folder / REQUEST).read_text("utf-8"))
    beside = None if request["folder"] is None else Path(request["folder"])
    with watching(folder, request["longest_s"], request["by_clock_s"]) as watch:
        result = trial(request["name"], (folder / PLANT).read_bytes(), beside, watch)
    _write_whole(folder / RESULT, vars(result))
    os._exit(0)  # whatever threads the files have started


def _write_whole(path: Path, data: dict[str, Any]) -> None:
    """Write a file so that a reader finds it whole, or its former content, whenever this process ends."""
    half = path.with_suffix(".half")
    half.write_text(json.dumps(data), "utf-8")
    half.replace(path)


@contextmanager
def watching(folder: Path, longest_s: float, by_clock_s: float) -> Iterator[Any]:
    """A watch that ends this process if one piece of work takes too long, and notes the line that it was at.

    Too long is more than `longest_s` of the processor's time, or `by_clock_s` by the clock.
    """
    with open(folder / STACK, "w", encoding="utf-8") as stack:
        alarm = ProcessorAlarm(stack)

        def watch(spot: SourceSpot, doing: str) -> None:
            _write_whole(folder / PHASE, {**vars(spot), "doing": doing})
            alarm.set(longest_s)
            faulthandler.dump_traceback_later(by_clock_s, exit=True, file=stack)

        try:
            yield watch
        finally:
            faulthandler.cancel_dump_traceback_later()
            alarm.close()


def _run(folder: Path) -> int | None:
    with _begun(folder) as process:
        try:
            return _ended(process, folder / PHASE)
        finally:
            process.kill()


def _begun(folder: Path) -> Fork | subprocess.Popen[bytes]:
    """The other process: a fork, which has loaded all that it needs, or where none is safe another Python."""
    if forks.can_fork():
        return Fork(partial(main, str(folder)))
    command = [sys.executable, "-I", "-c", START, json.dumps(sys.path), str(folder)]
    null = subprocess.DEVNULL
    return subprocess.Popen(command, stdin=null, stdout=null, stderr=null)


def _ended(process: Fork | subprocess.Popen[bytes], phase: Path) -> int | None:
    """The exit status of the process; None if it neither ends nor begins another piece of work for long."""
    before: float | None = None
    while True:
        try:
            return process.wait(STUCK_S)
        except subprocess.TimeoutExpired:
            now = phase.stat().st_mtime if phase.exists() else None
            if now == before:
                return None
            before = now


def broken_off(folder: Path, status: int | None) -> str:
    """The reason why the other process gave no result, and where; `status` is None if it was given up."""
    if not (folder / PHASE).exists():
        ended = SLOW if status is None else f"Python ended with status {status}"
        return f"the recipes could not be tried: {ended}"
    phase = json.loads((folder / PHASE).read_text("utf-8"))
    spot = SourceSpot(file=phase["file"], line=phase["line"])
    stack = (folder / STACK).read_text("utf-8", "replace")
    if not stack:
        late = f"takes more than {STUCK_S:g} s"
        ended = late if status is None else f"ends Python, with status {status}"
        return spot.problem(f"{phase['doing']} {ended}")
    beside = Path(spot.file).absolute().parent
    for file, line in FRAME.findall(stack):
        if Path(file).parent == beside:  # the innermost comes first
            spot = SourceSpot(file=str(Path(spot.file).parent / Path(file).name), line=int(line))
            break
    by_clock = f"{WAITS * LONGEST_S:g} s"
    limit = f"{LONGEST_S:g} s of processor time" if ended_by_alarm(status) else by_clock
    return spot.problem(f"{phase['doing']} takes more than {limit}; this is where it was then")
