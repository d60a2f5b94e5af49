"""Mutant: a bug as a small edit of the shipped source, and the weather in which it shows."""

from __future__ import annotations
import __future__

import inspect
import textwrap
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import CodeType
from typing import Any

import pytest

from arboleda.model.plant_model import PlantModel
from arboleda_proofs.simulator.climate import Climate

ALL, SHIPPED, SHARED = (
    range(1, 201),
    range(1, 201, 2),
    range(2, 201, 2),
)  # odd and even seeds have a plant each
ANNOTATIONS = __future__.annotations.compiler_flag


@dataclass(frozen=True, kw_only=True)
class Edit:
    """In the source of a function, `old`, which stands there once, becomes `new`."""

    function: Callable[..., Any]
    old: str
    new: str

    def make(self, patch: pytest.MonkeyPatch) -> None:
        """Have the function do so wherever it is called from."""
        patch.setattr(self.function, "__code__", self.compiled())

    def compiled(self) -> CodeType:
        """The code of the function with the edit."""
        code, source = self.function.__code__, textwrap.dedent(inspect.getsource(self.function))
        assert source.count(self.old) == 1, f"{self.function.__qualname__} holds this not once: {self.old}"
        source = source.replace(self.old, self.new)
        if code.co_freevars:
            body = textwrap.indent(source, "    ")
            source = f"def outside({', '.join(code.co_freevars)}):\n{body}"
        whole = compile(source, code.co_filename, "exec", flags=ANNOTATIONS, dont_inherit=True)
        return next(each for each in _codes(whole) if each.co_name == code.co_name)


def _codes(code: CodeType) -> list[CodeType]:
    inner = [each for each in code.co_consts if isinstance(each, CodeType)]
    return [*inner, *(deep for each in inner for deep in _codes(each))]


@dataclass(frozen=True, kw_only=True)
class Mutant:
    """`invariant` finds `bug` at one of `seeds`, at a level of faults or with these rates, within `cycles`.

    `likely` is the one that is tried first: it found the bug last, where those before it take long.
    `rest_s`: how long to wait for everything to come to rest, where that is what it does not do. `any_of`:
    with tasks that several cells can do. `standby`: on two hosts.
    """

    invariant: str
    bug: str
    edits: tuple[Edit, ...]
    seeds: range = ALL
    likely: int | None = None
    weather: str | Mapping[str, float] = "normal"
    cycles: int = 6
    rest_s: float = 600.0
    any_of: bool = False
    standby: bool = False

    def plant(self, patch: pytest.MonkeyPatch) -> None:
        """Bring the bug in."""
        for edit in self.edits:
            edit.make(patch)

    def climate(self, model: PlantModel, seed: int) -> Climate:
        if isinstance(self.weather, str):
            return Climate.draw(model, seed, self.weather, standby=self.standby)
        return Climate.from_file(model, seed, {"rates": dict(self.weather)}, standby=self.standby)


def edit(function: Any, old: str, new: str) -> Edit:
    """An edit of a function, a method or a property."""
    return Edit(function=getattr(function, "fget", None) or function, old=old, new=new)


def mutant(invariant: str, bug: str, *edits: Edit, **search: Any) -> Mutant:
    """A row of a table of mutants."""
    return Mutant(invariant=invariant, bug=bug, edits=edits, **search)
