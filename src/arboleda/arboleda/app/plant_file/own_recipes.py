"""Recipes that a plant file uses: of Python files beside it, or of installed modules."""

from __future__ import annotations

import ast
import importlib
import inspect
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path
from traceback import extract_tb
from types import ModuleType

from arboleda.core.errors import ArboledaError, ConfigError
from arboleda.core.outside import plain
from arboleda.core.recipe import Recipe
from arboleda.recipes.storage import RECIPES

from .. import user_file
from .document import Document, Place, nearest, shown
from .shapes import NAME_RULE, WORDS, is_name

SECTION: Place = ("uses",)
ENDING = ".py"
LARGEST = 256 * 1024  # bytes of a file
LONGEST = 500  # characters of a path, or of what an error says
TAKEN = tuple(each.name for each in RECIPES)
Watch = Callable[["Spot", str], None]
"""Told what begins now, and where it stands: whoever watches knows what takes too long."""


@dataclass(frozen=True, kw_only=True)
class Spot:
    """A line of a file of Python, as problems name it."""

    file: str
    line: int = 1

    def problem(self, sentence: str) -> str:
        return f"{plain(self.file, LONGEST)}:{self.line}:1: {plain(sentence, LONGEST)}"


@dataclass
class Used:
    """What `uses` has brought: recipes by name, and the files that problems can be found in."""

    recipes: dict[str, Recipe] = field(default_factory=dict)
    files: dict[str, str] = field(default_factory=dict)  # as Python knows them: as people do

    def spot(self, recipe: Recipe) -> Spot:
        """Where the function of a recipe begins."""
        code = inspect.unwrap(recipe.build).__code__
        return Spot(file=self.files.get(code.co_filename, code.co_filename), line=code.co_firstlineno)

    def where(self, error: BaseException, otherwise: Spot) -> Spot:
        """The line of a user's file that an error came by last."""
        frames = [frame for frame in extract_tb(error.__traceback__) if frame.filename in self.files]
        if isinstance(error, SyntaxError) and error.filename in self.files:
            return Spot(file=self.files[error.filename], line=error.lineno or 1)
        if not frames:
            return otherwise
        return Spot(file=self.files[frames[-1].filename], line=frames[-1].lineno or 1)


def listed(document: Document) -> tuple[str, ...]:
    """The files and modules that the plant file uses; none, with the problem kept, where that is no list."""
    words = document.read_plain(WORDS, SECTION) or ()
    for index, word in enumerate(words):
        if word in words[:index]:
            document.problem((*SECTION, index), f"{shown(word)} is there twice")
    return tuple(dict.fromkeys(words))


def imported(document: Document, words: Sequence[str], watch: Watch) -> Used:
    """The recipes of all of them; the problems of those that cannot be imported are kept."""
    used = Used()
    for index, word in enumerate(words):
        place = (*SECTION, index)
        is_file = word.endswith(ENDING) or "/" in word
        module = (_file if is_file else _module)(document, place, word, used, watch)
        if module is not None:
            _collect(document, place, module, used)
    return used


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


def _file(document: Document, place: Place, word: str, used: Used, watch: Watch) -> ModuleType | None:
    if document.folder is None:
        document.problem(place, "this plant file lies in no folder, so no recipes can lie beside it")
        return None
    if not word.endswith(ENDING):
        document.problem(place, f"must be a file that ends in {ENDING}, or a module; is {shown(word)}")
        return None
    path = (document.folder / word).absolute()
    known_as = str(document.folder / word)
    try:
        source = user_file.read_bytes(path, LARGEST)
    except ConfigError as error:
        near = nearest(word, (each.name for each in _beside(path)))
        document.problem(place, plain(str(error).replace(str(path), known_as), LONGEST) + near)
        return None
    used.files |= {str(each): str(Path(known_as).parent / each.name) for each in _beside(path)}
    used.files[str(path)] = known_as
    watch(Spot(file=known_as), "importing this")
    try:
        with _importing(path.parent):
            module = _run(path, source)
    except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        spot = used.where(error, Spot(file=known_as))
        document.keep_those_of(ConfigError((spot.problem(f"cannot be imported: {said(error)}"),)))
        return None
    _check_twice(document, known_as, source)
    return module


def _module(document: Document, place: Place, word: str, used: Used, watch: Watch) -> ModuleType | None:
    watch(Spot(file=word), "importing this")
    try:
        module = importlib.import_module(word)
    except ModuleNotFoundError as error:
        if error.name is not None and (word == error.name or word.startswith(f"{error.name}.")):
            hint = f'; a file beside this one is written with its ending, "{word}{ENDING}"'
            document.problem(place, f"no module {shown(word)} is installed{hint}")
        else:
            document.problem(place, plain(f"{shown(word)} cannot be imported: {said(error)}", LONGEST))
        return None
    except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        document.problem(place, plain(f"{shown(word)} cannot be imported: {said(error)}", LONGEST))
        return None
    if file := getattr(module, "__file__", None):
        used.files[file] = file
    return module


def _beside(path: Path) -> list[Path]:
    """The files of Python in the folder of one."""
    return sorted(path.parent.glob(f"*{ENDING}")) if path.parent.is_dir() else []


def _run(path: Path, source: bytes) -> ModuleType:
    """A module of its own of this file; Python keeps no compiled file of it beside the user's."""
    code = compile(source, str(path), "exec", dont_inherit=True)
    module = ModuleType(f"arboleda_uses_{sha256(str(path).encode()).hexdigest()[:12]}_{path.stem}")
    module.__file__ = str(path)
    sys.modules[module.__name__] = module  # where dataclasses and annotations look for it
    exec(code, module.__dict__)
    return module


@contextmanager
def _importing(folder: Path) -> Iterator[None]:
    """What lies in `folder` can be imported meanwhile, and is forgotten: other plants have other files."""
    before, writes = set(sys.modules), sys.dont_write_bytecode
    sys.path.insert(0, str(folder))
    sys.dont_write_bytecode = True
    try:
        yield
    finally:
        sys.dont_write_bytecode = writes
        if str(folder) in sys.path:
            sys.path.remove(str(folder))
        for name in set(sys.modules) - before:
            file = getattr(sys.modules[name], "__file__", None)
            if file is not None and folder in Path(file).parents and not name.startswith("arboleda_uses_"):
                del sys.modules[name]


def _collect(document: Document, place: Place, module: ModuleType, used: Used) -> None:
    found = {id(each): each for each in vars(module).values() if isinstance(each, Recipe)}
    if not found:
        document.problem(place, 'has no recipe; one is a function with @recipe("its name") before it')
    for each in found.values():
        problem = _objection(each, used)
        if not inspect.isfunction(inspect.unwrap(each.build)):
            document.problem(place, f"the recipe {shown(each.name)} is no function")
        elif problem is None:
            used.recipes[each.name] = each
        else:
            document.keep_those_of(ConfigError((used.spot(each).problem(problem),)))


def _objection(recipe: Recipe, used: Used) -> str | None:
    """Why it cannot be a recipe beside those that there are."""
    if not isinstance(recipe.name, str) or not is_name(recipe.name):
        return f"{shown(recipe.name)} cannot be the name of a recipe; it must be {NAME_RULE}"
    if recipe.name in TAKEN:
        return f"the recipe {shown(recipe.name)} comes with Arboleda; give this one another name"
    other = used.recipes.get(recipe.name)
    if other is None or other is recipe:
        return None
    first = used.spot(other)
    return (
        f"the recipe {shown(recipe.name)} is there twice; the other is on line {first.line} of {first.file}"
    )


def _check_twice(document: Document, known_as: str, source: bytes) -> None:
    """Keeps a problem for each recipe whose function has the name of a later one: Python forgets it."""
    lines: dict[str, int] = {}
    for node in ast.parse(source).body:
        if not isinstance(node, ast.FunctionDef | ast.ClassDef):
            continue
        marked = [
            each for each in node.decorator_list if isinstance(each, ast.Call) and _is_recipe(each.func)
        ]
        first = lines.setdefault(node.name, node.lineno)
        if first != node.lineno and marked:
            spot = Spot(file=known_as, line=node.lineno)
            sentence = f"the function {node.name} is there twice, so Python forgets that on line {first}"
            document.keep_those_of(ConfigError((spot.problem(sentence),)))


def _is_recipe(decorator: ast.expr) -> bool:
    name = decorator.attr if isinstance(decorator, ast.Attribute) else getattr(decorator, "id", "")
    return name == "recipe"
