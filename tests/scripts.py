"""Programs of scripts/ and tools/ in this process: as modules, which no name imports, and what they print."""

from __future__ import annotations

import runpy
import sys
from contextlib import redirect_stdout
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from io import StringIO
from pathlib import Path
from typing import Any
from unittest import mock

ROOT = Path(__file__).parents[1]


def load(name: str) -> Any:
    loader = SourceFileLoader(name.replace("-", "_"), str(_program(name)))
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None
    module = module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look there
    loader.exec_module(module)
    return module


def printed(name: str, *words: str) -> str:
    """What the program prints."""
    with mock.patch.object(sys, "argv", [name, *words]), redirect_stdout(StringIO()) as said:
        runpy.run_path(str(_program(name)), run_name="__main__")
    return said.getvalue()


def _program(name: str) -> Path:
    return next(path for folder in ("scripts", "tools") if (path := ROOT / folder / name).is_file())
