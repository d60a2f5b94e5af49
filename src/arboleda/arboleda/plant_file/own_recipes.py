"""Import of recipes, kinds, nodes and drivers that a plant file uses, from files beside it or modules."""

from __future__ import annotations

import ast
import importlib
import inspect
import os
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from hashlib import sha256
from pathlib import Path
from types import ModuleType
from typing import Any

from arboleda.drivers.port import spec_of
from arboleda.model.errors import ConfigError
from arboleda.model.outside import plain
from arboleda.model.plant_model import Link
from arboleda.model.recipe import Recipe
from arboleda.recipes import WrittenNode

from . import recipe_forms, user_file
from .document import Document, Place, nearest, shown
from .lost_steps import KEEP, NAME, LostSteps, noting
from .moving_kinds import as_read
from .python_uses import LONGEST, PythonUses, SourceSpot, Watch, Written, error_text, unwatched
from .recipe_forms import RecipeForm
from .shapes import NAME_RULE, WORDS, is_name
from .shipped_kinds import IN_PYTHON, RESERVED
from .source_text import source_of
from .storage_form import TAKEN

SECTION: Place = ("uses",)
NODE = re.compile("[A-Za-z_][A-Za-z0-9_]*", re.ASCII)
ENDING = ".py"
USES = "arboleda_uses_"  # before the names of modules that are files of plants
READ = "__arboleda_read__"  # of a module: the files that were read for it, with their contents
LARGEST = 256 * 1024  # bytes of a file
LINKS = tuple(each.value for each in Link)


def listed(document: Document) -> tuple[str, ...]:
    """The files and modules that the plant file uses; none, with the problem kept, if `uses` is no list."""
    words = document.read_plain(WORDS, SECTION) or ()
    for index, word in enumerate(words):
        if word in words[:index]:
            document.problem((*SECTION, index), f"{shown(word)} is there twice")
    return tuple(dict.fromkeys(words))


def imported(document: Document, words: Sequence[str], watch: Watch) -> PythonUses:
    """Everything that the used files and modules have; problems of failed imports are kept."""
    used = PythonUses(watch=watch, lost=None if watch is unwatched else LostSteps())
    forms: dict[str, RecipeForm] = {}
    for index, word in enumerate(words):
        place = (*SECTION, index)
        if recipe_forms.has_form(word):
            _of_form(document, place, word, used, forms)
            continue
        module = (_file if _is_file(word) else _module)(document, place, word, used, watch)
        if module is None:
            used.is_whole = False
        else:
            _collect(document, place, module, used)
    for node in used.nodes.values():
        for problem in filter(None, [form.objection(node.name) for form in forms.values()]):
            used.keep(document, used.spot(node).problem(problem))
    if all(_is_file(word) for word in words):  # the files of an installed module are not known
        used.source = source_of(document.files, document.folder)
    return used


def _of_form(
    document: Document, place: Place, word: str, used: PythonUses, forms: dict[str, RecipeForm]
) -> None:
    """Add the recipe of a file that is no Python, and its form to `forms`."""
    suffix = Path(word).suffix
    try:
        forms[suffix] = forms.get(suffix) or recipe_forms.form_of(word)
    except ConfigError as error:
        document.problem(place, plain(str(error), LONGEST))
        used.is_whole = False
        return
    forms[suffix].add(document, place, word, used)


def _is_file(word: str) -> bool:
    return word.endswith(ENDING) or recipe_forms.has_form(word) or "/" in word


def _file(document: Document, place: Place, word: str, used: PythonUses, watch: Watch) -> ModuleType | None:
    if document.folder is None:
        document.problem(place, "this plant file lies in no folder, so no recipes can lie beside it")
        return None
    if not word.endswith(ENDING):
        document.problem(place, f"must be a file that ends in {ENDING}, or a module; is {shown(word)}")
        return None
    path = (document.folder / word).absolute()
    shown_path = str(document.folder / word)
    try:
        source = user_file.read_bytes(path, LARGEST)
    except ConfigError as error:
        near = nearest(word, (each.name for each in _beside(path)))
        document.problem(place, plain(str(error).replace(str(path), shown_path), LONGEST) + near)
        return None
    used.files |= {str(each): str(Path(shown_path).parent / each.name) for each in _beside(path)}
    used.files[str(path)] = shown_path
    document.files[path] = source
    if document.runs:
        return _as_imported(document, place, path)
    watch(SourceSpot(file=shown_path), "importing this")
    read = {path: source}
    try:
        with _importing(path.parent, read):
            module = _run(path, source, used.lost)
        setattr(module, READ, read)
    except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        spot = used.where(error, SourceSpot(file=shown_path))
        used.keep(document, spot.problem(f"cannot be imported: {error_text(error)}"))
        return None
    document.files |= read
    _check_twice(document, shown_path, source)
    return module


def _as_imported(document: Document, place: Place, path: Path) -> ModuleType | None:
    """The module that this process has imported from a file, or from a file of which this one is a copy.

    None, with the problem kept, where the file was changed since.
    """
    for module in [each for name, each in sys.modules.items() if name.startswith(USES)]:
        read: dict[Path, bytes] = getattr(module, READ, {})
        here = {path.parent / os.path.relpath(each, Path(str(module.__file__)).parent): each for each in read}
        if path in here and all(_content(each) == read[there] for each, there in here.items()):
            document.files |= {each: read[there] for each, there in here.items()}
            return module
    document.problem(place, "was changed since it was imported, and Python is not imported again")
    return None


def _content(path: Path) -> bytes | None:
    try:
        return path.read_bytes()
    except OSError:
        return None


def _module_name(path: Path) -> str:
    return f"{USES}{sha256(str(path).encode()).hexdigest()[:12]}_{path.stem}"


def _module(document: Document, place: Place, word: str, used: PythonUses, watch: Watch) -> ModuleType | None:
    watch(SourceSpot(file=word), "importing this")
    try:
        module = importlib.import_module(word)
    except ModuleNotFoundError as error:
        if error.name is not None and (word == error.name or word.startswith(f"{error.name}.")):
            hint = f'; a file beside this one is written with its ending, "{word}{ENDING}"'
            document.problem(place, f"no module {shown(word)} is installed{hint}")
        else:
            document.problem(place, plain(f"{shown(word)} cannot be imported: {error_text(error)}", LONGEST))
        return None
    except (Exception, SystemExit) as error:  # noqa: BLE001 - it is user code: whatever it raises is told
        document.problem(place, plain(f"{shown(word)} cannot be imported: {error_text(error)}", LONGEST))
        return None
    if file := getattr(module, "__file__", None):
        used.files[file] = file
    return module


def _beside(path: Path) -> list[Path]:
    """The Python files in the folder of a file."""
    return sorted(path.parent.glob(f"*{ENDING}")) if path.parent.is_dir() else []


def _run(path: Path, source: bytes, lost: LostSteps | None) -> ModuleType:
    """Run a file as a module of its own; Python writes no compiled file beside the user's file.

    `lost`, where given, notes the steps that statements and assignments make.
    """
    tree = ast.parse(source, str(path))
    code = compile(tree if lost is None else noting(tree), str(path), "exec", dont_inherit=True)
    module = ModuleType(_module_name(path))
    module.__file__ = str(path)
    if lost is not None:
        setattr(module, KEEP, lost.note)
        setattr(module, NAME, lost.note)
    sys.modules[module.__name__] = module  # where dataclasses and annotations look for it
    exec(code, module.__dict__)
    return module


@contextmanager
def _importing(folder: Path, files: dict[Path, bytes]) -> Iterator[None]:
    """Context in which files of `folder` can be imported; adds those that were to `files`, and forgets them.

    Another plant may have other files of these names.
    """
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
            if file is not None and folder in Path(file).parents and not name.startswith(USES):
                with suppress(OSError):  # the file may have deleted itself
                    files[Path(file)] = Path(file).read_bytes()
                del sys.modules[name]


def _collect(document: Document, place: Place, module: ModuleType, used: PythonUses) -> None:
    recipes = {id(each): each for each in vars(module).values() if isinstance(each, Recipe)}
    kinds = {id(each): as_read(each) for each in vars(module).values() if isinstance(each, IN_PYTHON)}
    drivers = {id(spec): spec for each in vars(module).values() if (spec := spec_of(each)) is not None}
    nodes = {id(each): each for each in vars(module).values() if isinstance(each, WrittenNode)}
    if not recipes and not kinds and not drivers and not nodes:
        how = 'one is a function with @recipe("its name") or @kind("its name") before it'
        document.problem(place, f"has neither a recipe nor a kind; {how}, a driver a class with @driver")
        used.is_whole = False
    for recipe in recipes.values():
        if not inspect.isfunction(inspect.unwrap(recipe.build)):
            document.problem(place, f"the recipe {shown(recipe.name)} is no function")
        elif problem := objection_to_recipe(recipe, used):
            used.keep(document, used.spot(recipe).problem(problem))
        else:
            used.recipes[recipe.name] = recipe
    for kind in kinds.values():
        if problem := _objection("kind", kind, used.kinds, RESERVED, used):
            used.keep(document, used.spot(kind).problem(problem))
        else:
            used.kinds[kind.name] = kind
    for node in nodes.values():
        if problem := _objection_to_node(node, used):
            used.keep(document, used.spot(node).problem(problem))
        else:
            used.nodes[node.name] = node
    for spec in drivers.values():
        if problem := _objection("driver", spec, used.drivers, LINKS, used):
            used.keep(document, used.spot(spec).problem(problem))
        else:
            used.drivers[spec.name] = spec


def objection_to_recipe(recipe: Recipe, used: PythonUses) -> str | None:
    """The reason why a recipe cannot have its name; None where it can."""
    return _objection("recipe", recipe, used.recipes, TAKEN, used)


def _objection(
    what: str, written: Written, there: Mapping[str, Any], taken: Sequence[str], used: PythonUses
) -> str | None:
    """The reason why a recipe, a kind or a driver cannot have its name; None where it can."""
    name = written.name
    if not isinstance(name, str) or not is_name(name):
        return f"{shown(name)} cannot be the name of a {what}; it must be {NAME_RULE}"
    if name in taken:
        return f"the {what} {shown(name)} comes with Arboleda; give this one another name"
    return _twice(what, written, there, used)


def _objection_to_node(node: WrittenNode, used: PythonUses) -> str | None:
    """The reason why trees as XML cannot have a node of this name; None where they can."""
    if not isinstance(node.name, str) or not NODE.fullmatch(node.name):
        return f"{shown(node.name)} cannot be the name of a node; it must be letters, digits and _"
    return _twice("node", node, used.nodes, used)


def _twice(what: str, written: Written, there: Mapping[str, Any], used: PythonUses) -> str | None:
    other = there.get(written.name)
    if other is None or other is written:
        return None
    first = used.spot(other)
    return (
        f"the {what} {shown(written.name)} is there twice; the other is on line {first.line} of {first.file}"
    )


def _check_twice(document: Document, shown_path: str, source: bytes) -> None:
    """Keep a problem for each second recipe, kind or node of one name: Python forgets the first."""
    lines: dict[str, int] = {}
    for node in ast.parse(source).body:
        if not isinstance(node, ast.FunctionDef | ast.ClassDef):
            continue
        marked = [each for each in node.decorator_list if isinstance(each, ast.Call) and _marks(each.func)]
        first = lines.setdefault(node.name, node.lineno)
        if first != node.lineno and marked:
            spot = SourceSpot(file=shown_path, line=node.lineno)
            sentence = f"the function {node.name} is there twice, so Python forgets that on line {first}"
            document.keep_those_of(ConfigError((spot.problem(sentence),)))


def _marks(decorator: ast.expr) -> bool:
    name = decorator.attr if isinstance(decorator, ast.Attribute) else getattr(decorator, "id", "")
    return name in ("recipe", "kind", "moving_kind", "node", "function")
