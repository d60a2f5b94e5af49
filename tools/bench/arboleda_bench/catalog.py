"""Every benchmark by name: a module of that name with `run(scene) -> Result`.

The first line of its docstring says what it measures.
"""

from __future__ import annotations

import ast
import importlib
from importlib.resources import files
from types import ModuleType

from arboleda.extension import ArboledaError
from arboleda_ros import missing_libraries

NAMES = (
    "reaction",
    "chain",
    "polling",
    "rival",
    "cycle",
    "idle",
    "scale",
    "burst",
    "bridge",
    "step",
    "kept",
    "stop",
    "modbus_driver",
    "opcua_driver",
    "trajectory_driver",
    "simulate",
    "dobot",
)


def module(name: str) -> ModuleType:
    """The module of a benchmark; raises ArboledaError if a library that it needs is missing."""
    try:
        return importlib.import_module(f".{name}", __package__)
    except ImportError as error:
        raise ArboledaError(missing_libraries.sentence(error)) from error


def about(name: str) -> str:
    """The first line of the benchmark's docstring; nothing is imported for it."""
    source = (files(__package__ or "") / f"{name}.py").read_text(encoding="utf-8")
    return (ast.get_docstring(ast.parse(source)) or "").partition("\n")[0]
