"""What a plant file uses of Python, by name, and where in its files a problem stands."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, field
from traceback import extract_tb

from arboleda.bt_xml.recipe import TreeRecipe
from arboleda.bt_xml.running.errors import NoDeviceError, TreeError
from arboleda.drivers.port import DriverSpec
from arboleda.kinds import WrittenKind
from arboleda.model.errors import ArboledaError, ConfigError
from arboleda.model.outside import plain
from arboleda.model.recipe import Recipe
from arboleda.recipes import WrittenNode

from .document import Document
from .robot_kind import RobotKind

LONGEST = 500  # characters of a path, or of what an error says
KindInPython = WrittenKind | RobotKind
Written = Recipe | KindInPython | DriverSpec | WrittenNode
Watch = Callable[["Spot", str], None]
"""Told what begins now, and where it stands: whoever watches knows what takes too long."""


@dataclass(frozen=True, kw_only=True)
class Spot:
    """A place in a file of Python or XML, as problems name it."""

    file: str
    line: int = 1
    column: int = 1

    def problem(self, sentence: str) -> str:
        return f"{plain(self.file, LONGEST)}:{self.line}:{self.column}: {plain(sentence, LONGEST)}"


def unwatched(spot: Spot, doing: str) -> None:
    """Nobody looks how long it takes."""


@dataclass
class PythonUses:
    """What `uses` has brought, by name, and the files that problems can be found in."""

    recipes: dict[str, Recipe] = field(default_factory=dict)
    kinds: dict[str, KindInPython] = field(default_factory=dict)
    drivers: dict[str, DriverSpec] = field(default_factory=dict)
    nodes: dict[str, WrittenNode] = field(default_factory=dict)  # for trees that are written as XML
    files: dict[str, str] = field(default_factory=dict)  # as Python knows them: as people do
    watch: Watch = unwatched
    is_whole: bool = True  # False: something could not be imported, so a name may be missing
    may_import: bool = True  # False: it was tried elsewhere, and must not be run here
    installed: tuple[str, ...] = ()  # kinds that packages register
    broken: set[str] = field(default_factory=set)  # those of these that were told to be wrong

    def spot(self, written: Written) -> Spot:
        """Where the function of a recipe, a kind or a node begins, or the first method of a driver."""
        if isinstance(written, TreeRecipe):
            return Spot(file=written.file)
        code = inspect.unwrap(_function(written)).__code__
        return Spot(file=self.files.get(code.co_filename, code.co_filename), line=code.co_firstlineno)

    def where(self, error: BaseException, otherwise: Spot) -> Spot:
        """The line of a user's file that an error came by last."""
        if isinstance(error, TreeError | NoDeviceError):
            mark = error.place.mark
            return Spot(file=error.place.file, line=mark.line, column=mark.column)
        frames = [frame for frame in extract_tb(error.__traceback__) if frame.filename in self.files]
        if isinstance(error, SyntaxError) and error.filename in self.files:
            return Spot(file=self.files[error.filename], line=error.lineno or 1)
        if not frames:
            return otherwise
        return Spot(file=self.files[frames[-1].filename], line=frames[-1].lineno or 1)

    def keep(self, document: Document, problem: str) -> None:
        """Keeps a problem of one of the files; that what it brings is missing is not told besides."""
        self.is_whole = False
        document.keep_those_of(ConfigError((problem,)))


def said(error: BaseException) -> str:
    """An error in words, as a sentence goes on."""
    if isinstance(error, ArboledaError):
        return str(error)
    if isinstance(error, SystemExit):
        return f"it ends the program (SystemExit: {error})"
    try:
        text = str(error.msg if isinstance(error, SyntaxError) else error)
    except Exception:  # noqa: BLE001 - an error of the user's may have no words
        text = ""
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def refused(error: BaseException) -> str:
    """Why the settings of a kind or driver are refused: its own rules raise ValueError with a sentence."""
    return str(error) if isinstance(error, ValueError) and str(error) else said(error)


def _function(written: Written) -> Callable[..., object]:
    if isinstance(written, Recipe):
        return written.build
    if isinstance(written, RobotKind):
        return written.read
    return written.made_by.start if isinstance(written, DriverSpec) else written.function
