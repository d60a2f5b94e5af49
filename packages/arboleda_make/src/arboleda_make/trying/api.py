"""Draft as a plant, as the web server sees it: its cells and trees, what is tried and proved of it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol

from ..editing.operations import Operation

Row = dict[str, Any]
RUNS = ("try", "prove", "notice", "reach")


class MakeApi(Protocol):
    """All data is plain, with the keys of types in `arboleda_make.answers`. What runs does so in processes
    of its own; a call waits for one that only looks."""

    @abstractmethod
    def cells(self) -> Row:
        """The cells of the draft: DraftCells."""

    @abstractmethod
    def palette(self, cell: str, language: str) -> list[Row]:
        """The nodes that a tree can have in a cell of the draft."""

    @abstractmethod
    def drawn(self, cell: str, text: str, operation: Operation | None = None) -> Row:
        """A file of trees as an editor shows it in a cell of the draft, after an operation on it."""

    @abstractmethod
    def shown(self, cell: str, recipe: str) -> str:
        """The tree of a recipe, whoever wrote it, as XML for viewers."""

    @abstractmethod
    def carry(self, editor: str, recipe: str, way: Mapping[str, str]) -> Row:
        """Add a recipe that carries a part: `way` has `cell`, `robot`, `start`, `end`. The draft's state."""

    @abstractmethod
    def copy(self, editor: str, cell: str, recipe: str, name: str) -> Row:
        """Add a recipe `name` that is a tree and does what one in Python does. The draft's state."""

    @abstractmethod
    def translate(self, language: str, lines: list[str]) -> list[str]:
        """Findings of files and runs, given in English, in a language; what it lacks stays in English."""

    @abstractmethod
    def drivers(self, language: str) -> list[Row]:
        """The drivers that a device of a declared kind can have: a DriverRow each."""

    @abstractmethod
    def add_device(self, editor: str, device: Mapping[str, Any]) -> Row:
        """Add a device, or change it: `cell`, also a new one, `role`, `kind`, which `declared` has if new
        or changed, other `keys` of the plant file, its `driver` and what was written for its `settings`. The
        state of the draft."""

    @abstractmethod
    def objections(self, device: Mapping[str, Any]) -> list[Row]:
        """The problems that `check` finds in such a device, its kind and the name of its cell, and does not
        find in the draft without it: an Objection each."""

    @abstractmethod
    def remove(self, editor: str, cell: str, role: str) -> Row:
        """Take a device away with all that names it, or the whole cell where the role is empty. The draft's
        state."""

    @abstractmethod
    def reach(self, device: Mapping[str, Any]) -> Row:
        """Begin to listen to such a device, as the run "reach", without adding it."""

    @abstractmethod
    def begin(self, what: str, wanted: Mapping[str, Any]) -> Row:
        """Begin one of RUNS with the draft as it is now; the one before ends. Its state."""

    @abstractmethod
    def run(self, what: str) -> Row:
        """The state of one of RUNS: RunState."""

    @abstractmethod
    def end(self, what: str) -> Row:
        """End one of RUNS. Its state."""

    @abstractmethod
    def result(self, what: str) -> Path | None:
        """The file with what came of the last one, as JSON; None if nothing came of it."""

    @abstractmethod
    def tried(self) -> tuple[Path, Path] | None:
        """The record of the last tryout, and the file on what is shown of its plant; None if there is
        none."""

    @abstractmethod
    def proof_page(self) -> Path | None:
        """The page on the last proof, as one HTML file; None if there is none."""
