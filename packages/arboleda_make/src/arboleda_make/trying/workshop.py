"""Workshop: the draft as a plant, in a process of its own that takes no time from a plant that runs."""

from __future__ import annotations

import json
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from arboleda.extension import ArboledaError
from arboleda.model.plant_files import PlantFiles
from arboleda.plant_file.recipe_trial import PATH
from arboleda_make.drafts.api import DraftRefused
from arboleda_make.editing.operations import Operation

START = PATH + "from arboleda_make.trying import workshop_process; workshop_process.main()"
PATIENCE_S = 120.0  # of one answer
NO_ANSWER = "the draft could not be looked at, nothing came of it; `arboleda check` says more"
ENDING = "the draft is not looked at any more: the plant ends"

Row = dict[str, Any]


class Workshop:
    """Workshop: begins with the first request; each is about files as if they were beside `plant_file()`."""

    def __init__(self, plant_file: Callable[[], Path]) -> None:
        self._plant_file = plant_file
        self._turns = threading.Lock()
        self._beginning = threading.Lock()  # held while a process begins, and while all of it is to end
        self._ended = False
        self._run: subprocess.Popen[bytes] | None = None
        self._files: PlantFiles | None = None  # that the process was given last
        self._problems: tuple[str, ...] = ()

    def stop(self) -> None:
        """End the process, and begin no other; idempotent. Whoever waits for an answer is refused."""
        with self._beginning:
            self._ended = True
            run = self._run
        if run is None:
            return
        run.kill()
        with self._turns:  # whoever waits for it has its refusal
            run.communicate()
            self._run = None

    def cells(self, base: PlantFiles, files: PlantFiles) -> Row:
        """`cells` and possible `faults` of the draft, and its `problems`: then they are those of before."""
        with self._turns:
            self._load(base, files)
            cells, faults = self._ask("cells"), self._ask("faults")
            return {"cells": cells, "faults": faults, "problems": list(self._problems)}

    def palette(self, base: PlantFiles, files: PlantFiles, cell: str, words: Mapping[str, str]) -> list[Row]:
        """As `PlantApi.palette`, of the draft."""
        found: list[Row] = self._answer(base, files, "palette", cell, dict(words))
        return found

    def drawn(
        self, base: PlantFiles, files: PlantFiles, cell: str, text: str, operation: Operation | None
    ) -> Row:
        """As `PlantApi.drawn`, of the draft."""
        found: Row = self._answer(base, files, "drawn", cell, text, operation)
        return found

    def shown(self, base: PlantFiles, files: PlantFiles, cell: str, recipe: str) -> str:
        """The tree of a recipe, whoever wrote it, as XML."""
        with self._turns:
            self._load(base, files)
            return str(self._ask("shown", cell, recipe))

    def carrying(
        self, base: PlantFiles, files: PlantFiles, cell: str, name: str, way: Mapping[str, str]
    ) -> str:
        """A tree in which a part is carried; `way` has `robot`, `start` and `end`."""
        return str(self._answer(base, files, "carrying", cell, name, way["robot"], way["start"], way["end"]))

    def copied(self, base: PlantFiles, files: PlantFiles, cell: str, recipe: str, name: str) -> str:
        """As `PlantApi.copied`, of the draft."""
        with self._turns:
            self._load(base, files)
            return str(self._ask("copied", cell, recipe, name))

    def translate(self, language: str, lines: list[str]) -> list[str]:
        """Findings in a language, by the workshop's process, as looking for templates takes a while."""
        with self._turns:
            if self._run is None or self._run.poll() is not None:
                self._begin()
            translated: list[str] = self._ask("translate", language, lines)
            return translated

    def problems(self, files: PlantFiles) -> list[str]:
        """The problems of these files; the other requests go on with those that they know."""
        with self._turns:
            if self._run is None or self._run.poll() is not None:
                self._begin()
            return list(self._ask("problems", files, self._plant_file()))

    def drivers(self, base: PlantFiles, files: PlantFiles, language: str) -> list[Row]:
        """The drivers that a device of a declared kind can have, with a field for each setting."""
        found: list[Row] = self._answer(base, files, "drivers", language)
        return found

    def driver(self, base: PlantFiles, files: PlantFiles, name: str, texts: Mapping[str, str]) -> Any:
        """The value of the key `driver` for what was written in its fields."""
        return self._answer(base, files, "driver", name, dict(texts))

    def _answer(self, base: PlantFiles, files: PlantFiles, name: str, *values: Any) -> Any:
        with self._turns:
            if not self._has_devices_of(files):
                self._load(base, files)
            return self._ask(name, *values)

    def _has_devices_of(self, files: PlantFiles) -> bool:
        """True if the process knows the plant file of these, on which alone it depends what a tree can be."""
        known = self._files
        if self._run is None or self._run.poll() is not None or known is None:
            return False
        return known.contents[known.plant] == files.contents[files.plant]

    def _load(self, base: PlantFiles, files: PlantFiles) -> None:
        """Have the process look at these files; where they cannot be read, at those of before, or `base`."""
        if self._run is None or self._run.poll() is not None:
            self._begin()
        if files == self._files:
            return
        if self._files is None and files != base:
            self._ask("load", base, self._plant_file())
        self._problems = self._ask("load", files, self._plant_file())
        self._files = files

    def _begin(self) -> None:
        command = [sys.executable, "-I", "-c", START, json.dumps(sys.path)]
        pipe = subprocess.PIPE
        with self._beginning:
            if self._ended:
                raise ArboledaError(ENDING)
            self._run = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL)
        self._files = None

    def _ask(self, name: str, *values: Any) -> Any:
        run = self._run
        assert run is not None and run.stdin is not None and run.stdout is not None
        late = threading.Timer(PATIENCE_S, run.kill)
        late.start()
        try:
            pickle.dump((name, values), run.stdin)
            run.stdin.flush()
            result, refusal = pickle.load(run.stdout)
        except (OSError, EOFError, ValueError, pickle.UnpicklingError) as error:
            run.kill()
            run.wait()  # the next request finds it ended, and begins another
            raise ArboledaError(ENDING if self._ended else NO_ANSWER) from error
        finally:
            late.cancel()
            late.join()
        if refusal:
            raise DraftRefused(refusal)
        return result
