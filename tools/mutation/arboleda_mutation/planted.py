"""Plants a mutant as its module is imported: the file stays as it is."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from types import CodeType, ModuleType

from .mutant import Mutant
from .sources import Sources


def plant(mutant: Mutant, sources: Sources) -> None:
    """From now on its module has the bug; nothing may have imported that module before."""
    module = sources.module(mutant.file)
    if module in sys.modules:
        raise AssertionError(f"{module} was imported before its mutant was planted")
    code = compile(sources.mutated(mutant), str(sources.path(mutant.file)), "exec", dont_inherit=True)
    sys.meta_path.insert(0, _Finder(module, code))


class _Finder(MetaPathFinder):
    """Finds one module, with other code than that of its file."""

    def __init__(self, module: str, code: CodeType) -> None:
        self._module = module
        self._code = code

    def find_spec(
        self, name: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        spec = PathFinder.find_spec(name, path, target) if name == self._module else None
        if spec is not None and spec.origin is not None:
            spec.loader = _Loader(name, spec.origin, self._code)
        return spec


class _Loader(SourceFileLoader):
    def __init__(self, name: str, path: str, code: CodeType) -> None:
        super().__init__(name, path)
        self._code = code

    def get_code(self, fullname: str) -> CodeType:
        return self._code
