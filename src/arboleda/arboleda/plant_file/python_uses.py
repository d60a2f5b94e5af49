"""Python that a plant file uses: recipes, kinds, drivers and nodes by name, and where problems stand."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, field
from traceback import extract_tb

from arboleda.drivers.port import DriverSpec
from arboleda.kinds import WrittenKind
from arboleda.model.errors import ArboledaError, ConfigError
from arboleda.model.outside import plain
from arboleda.model.recipe import Recipe
from arboleda.recipes import WrittenNode
from arboleda.recipes.errors import misspelled
from arboleda.recipes.of_files import FileRecipe, NoDeviceError, TreeError

from .document import Document
from .lost_steps import LostSteps
from .robot_kind import RobotKind
from .wrong_call import wrong_call

LONGEST = 500  # characters of a path, or of an error's text
KindInPython = WrittenKind | RobotKind
Written = Recipe | KindInPython | DriverSpec | WrittenNode
Watch = Callable[["SourceSpot", str], None]
"""Is told what begins, and where in a file, so that a watch knows which work takes too long."""


@dataclass(frozen=True, kw_only=True)
class SourceSpot:
    """A place in a file of Python or XML, as problems name it."""

    file: str
    line: int = 1
    column: int = 1

    def problem(self, sentence: str) -> str:
        return f"{plain(self.file, LONGEST)}:{self.line}:{self.column}: {plain(sentence, LONGEST)}"


def unwatched(spot: SourceSpot, doing: str) -> None:
    """Watch a run whose duration is not limited."""


@dataclass
class PythonUses:
    """Recipes, kinds, drivers and nodes by name that the files and modules of `uses` have."""

    recipes: dict[str, Recipe] = field(default_factory=dict)
    kinds: dict[str, KindInPython] = field(default_factory=dict)
    drivers: dict[str, DriverSpec] = field(default_factory=dict)
    nodes: dict[str, WrittenNode] = field(default_factory=dict)  # for trees that are written as XML
    source: str = ""  # a hash of all files, by which a kept task sees that its recipe changed; "": none
    files: dict[str, str] = field(default_factory=dict)  # by the path of a file: its name for people
    watch: Watch = unwatched
    lost: LostSteps | None = None  # steps that statements make, where recipes are only tried
    is_whole: bool = True  # False: something could not be imported, so a name may be missing
    in_trees: set[str] = field(default_factory=set)  # mistakes of trees that cells can be checked with
    may_import: bool = True  # False: a trial has refused the files, so they are not run here
    installed: tuple[str, ...] = ()  # kinds that packages register
    broken: set[str] = field(default_factory=set)  # names of kinds that cannot be used; problems are kept

    def spot(self, written: Written) -> SourceSpot:
        """The beginning of the function of a recipe, a kind or a node, or of the first method of a driver."""
        if isinstance(written, FileRecipe):
            return SourceSpot(file=written.file)
        code = inspect.unwrap(_function(written)).__code__
        return SourceSpot(file=self.files.get(code.co_filename, code.co_filename), line=code.co_firstlineno)

    def where(self, error: BaseException, otherwise: SourceSpot) -> SourceSpot:
        """The last line of a user's file that an error passed through."""
        if isinstance(error, TreeError | NoDeviceError):
            mark = error.place.mark
            return SourceSpot(file=error.place.file, line=mark.line, column=mark.column)
        frames = [frame for frame in extract_tb(error.__traceback__) if frame.filename in self.files]
        if isinstance(error, SyntaxError) and error.filename in self.files:
            return SourceSpot(file=self.files[error.filename], line=error.lineno or 1)
        if not frames:
            return otherwise
        return SourceSpot(file=self.files[frames[-1].filename], line=frames[-1].lineno or 1)

    def keep(self, document: Document, problem: str) -> None:
        """Keep a problem of one of the files. Names that this file may have are not reported as missing."""
        self.is_whole = False
        document.keep_those_of(ConfigError((problem,)))


def error_text(error: BaseException) -> str:
    """An error as the end of a sentence."""
    if isinstance(error, ArboledaError):
        return str(error)
    if isinstance(error, AttributeError) and (sentence := misspelled(error)) is not None:
        return sentence
    if isinstance(error, TypeError) and (sentence := wrong_call(error)) is not None:
        return sentence
    if isinstance(error, RecursionError):
        return "it calls itself without an end"
    if isinstance(error, SystemExit):
        return f"it ends the program (SystemExit: {error})"
    try:
        text = str(error.msg if isinstance(error, SyntaxError) else error)
    except Exception:  # noqa: BLE001 - an error of the user's may have no words
        text = ""
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def refused(error: BaseException) -> str:
    """The reason why settings are refused. The rules of a kind or driver raise ValueError with the reason."""
    return str(error) if isinstance(error, ValueError) and str(error) else error_text(error)


def _function(written: Written) -> Callable[..., object]:
    if isinstance(written, Recipe):
        return written.build
    if isinstance(written, RobotKind):
        return written.read
    if isinstance(written, DriverSpec):
        begin: Callable[..., object] = getattr(written.made_by, "start", written.made_by)
        return begin
    return written.function
