"""Digests of recipes: of all in the files of a plant that can decide on what comes of one."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from hashlib import blake2b
from typing import Any

import yaml

from arboleda import __version__
from arboleda.model.plant_files import PlantFiles
from arboleda.model.plant_model import PlantModel

from .proof_tally import RecipeKey
from .scenario import alone

FORMAT = 5  # of what is kept; another one is another digest
PYTHON = ".py"
BY_OTHER_NAMES = frozenset(
    {"globals", "vars", "eval", "exec", "getattr", "__dict__", "modules", "getmembers"}
)


def recipe_digests(model: PlantModel, files: PlantFiles) -> dict[RecipeKey, str]:
    """The digest of each recipe in each cell.

    It sees the version, the plant file without cells that its own cannot meet, and each file that the plant
    uses, of Python without comments, layout and the functions of other recipes that it does not name.
    """
    return {
        (cell.name, recipe.name): _digest(_visible(files, alone(model, cell.name), recipe.name))
        for cell in model.cells
        for recipe in cell.recipes
    }


def _digest(words: Iterator[str]) -> str:
    digest = blake2b(f"{FORMAT} {__version__}".encode(), digest_size=16)
    for word in words:
        digest.update(f"\n{len(word)} {word}".encode("utf-8", "surrogatepass"))
    return digest.hexdigest()


def _visible(files: PlantFiles, visible: PlantModel, recipe: str) -> Iterator[str]:
    cells = {cell.name for cell in visible.cells}
    for name, content in sorted(files.contents.items()):
        yield name
        if name == files.plant:
            yield _of_cells(content, cells)
        else:
            yield _of_python(content, recipe) if name.endswith(PYTHON) else content.decode("latin-1")


def _of_cells(content: bytes, cells: set[str]) -> str:
    """The content of a plant file without the cells that are not among these."""
    data: Any = yaml.safe_load(content)
    declared = data.get("cells") if isinstance(data, Mapping) else None
    if not isinstance(declared, Mapping):
        return content.decode("latin-1")
    return repr(
        {**data, "cells": {name: declaration for name, declaration in declared.items() if name in cells}}
    )


def _of_python(content: bytes, recipe: str) -> str:
    """The syntax of a file without other recipes' functions, unless what is left names them."""
    try:
        module = ast.parse(content)
    except (SyntaxError, ValueError, RecursionError):
        return content.decode("latin-1")
    functions = [each for each in module.body if isinstance(each, ast.FunctionDef)]
    others = {each.name: each for each in functions if _is_of_another(each, recipe)}
    if others.keys() & BY_OTHER_NAMES or _words(module.body) & BY_OTHER_NAMES:
        others = {}
    kept = [each for each in module.body if each not in others.values()]
    while named := others.keys() & _words(kept):
        kept += [others.pop(name) for name in sorted(named)]
    return ast.dump(ast.Module(body=kept, type_ignores=[]))


def _is_of_another(node: ast.FunctionDef, recipe: str) -> bool:
    """True for a function that is decorated as another recipe, and with nothing else."""
    if len(node.decorator_list) != 1:
        return False
    call = node.decorator_list[0]
    if not isinstance(call, ast.Call) or not isinstance(call.func, ast.Name) or call.func.id != "recipe":
        return False
    name = call.args[0].value if call.args and isinstance(call.args[0], ast.Constant) else None
    return isinstance(name, str) and name != recipe


def _words(nodes: Sequence[ast.AST]) -> set[str]:
    """The names, attributes and texts in some statements."""
    found: set[str] = set()
    for each in (inner for node in nodes for inner in ast.walk(node)):
        if isinstance(each, ast.Name):
            found.add(each.id)
        elif isinstance(each, ast.Attribute):
            found.add(each.attr)
        elif isinstance(each, ast.Constant) and isinstance(each.value, str):
            found.add(each.value)
    return found
