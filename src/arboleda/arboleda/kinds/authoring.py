"""Authoring of kinds of devices: a function of settings that returns the facts and verbs of a kind.

@dataclass(frozen=True, kw_only=True)
class Saw:
    mm_s: float = 20.0

@kind("saw")
def saw(settings: Saw) -> Kind:
    return Kind(
        facts={"guard": ["open", "closed"], "cuts": int},
        verbs={
            "close": motion(sets={"guard": "closed"}, takes_s=1),
            "cut": process(
                parameters={"mm": Number(10, 300)},
                needs={"guard": "closed"},
                takes_s=lambda mm: mm / settings.mm_s,
                at_most_s=60,
                virtual=lambda facts, mm: {"cuts": facts["cuts"] + 1},
            ),
        },
    )

The fields of the settings are the keys that the plant file takes for a device of this kind. The facts that a
verb sets, and the time that it takes, may be functions of its parameters; they depend on nothing else.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass, replace
from typing import Any

from arboleda.model.outside import quoted

from . import rules
from .declared import DeviceKind
from .verbs import KindError, Verb
from .written import refuse, timed, types_of, verb_of


@dataclass(frozen=True, kw_only=True)
class Kind:
    """Facts and verbs of a kind of device; raises KindError if they do not fit together.

    `verbs`, by name, are made by `motion`, `process`, `switch` and `query`; at least one. `facts`, by name,
    are what the devices report.

    A fact and a parameter are bool, int, float, str, a list of words or numbers, or Number(lower, upper).
    """

    verbs: Mapping[str, Verb]
    facts: Mapping[str, object] = field(default_factory=dict)
    declared: DeviceKind = field(init=False, repr=False)

    def __post_init__(self) -> None:
        facts = types_of("facts", self.facts)
        if not self.verbs:
            raise KindError("verbs must have at least 1 verb, has 0")
        verbs = {name: verb_of(name, each, facts) for name, each in self.verbs.items()}
        refuse("verbs", rules.release_objection(verbs))
        object.__setattr__(self, "declared", timed(DeviceKind(name="device", facts=facts, verbs=verbs)))


@dataclass(frozen=True, kw_only=True)
class WrittenKind:
    """Kind as `@kind` makes it: its name, and the function that returns its verbs and facts.

    `settings` is the frozen dataclass that the function takes, None if it takes nothing; `about` is the first
    line of its docstring. Raises KindError if `function` is no function.
    """

    name: str
    function: Callable[..., Kind]
    settings: type[Any] | None = None
    about: str = ""

    def __post_init__(self) -> None:
        if not inspect.isfunction(self.function):
            raise KindError(f"{self.name}: a kind is a function, and {quoted(self.function)} is none")

    def of(self, settings: object | None) -> DeviceKind:
        """The kind with these settings (None for a function that takes nothing).

        Raises KindError if the function returns no Kind.
        """
        made = self.function() if self.settings is None else self.function(settings)
        if not isinstance(made, Kind):
            raise KindError(f"{self.name} returns {quoted(made)}; a kind returns Kind(facts=..., verbs=...)")
        return replace(made.declared, name=self.name)


def kind(name: str) -> Callable[[Callable[..., Kind]], WrittenKind]:
    """Decorator that makes a kind, called `name` in plant files, of a function that returns a Kind.

    The function takes its settings, an instance of a frozen dataclass to which it is annotated, or nothing.
    The first line of its docstring describes the kind to users. Raises KindError for another signature.
    """

    def made(function: Callable[..., Kind]) -> WrittenKind:
        about = (inspect.getdoc(function) or "").partition("\n")[0]
        settings = settings_of(name, function) if inspect.isfunction(function) else None
        return WrittenKind(name=name, function=function, settings=settings, about=about)

    return made


def settings_of(name: str, function: Callable[..., object]) -> type[Any] | None:
    """The dataclass that a function is annotated to take; None if it takes nothing."""
    taken = list(inspect.signature(function).parameters)
    if not taken:
        return None
    if len(taken) > 1:
        raise KindError(f"{name}: a kind is a function of its settings alone; this takes {', '.join(taken)}")
    try:
        notes = inspect.get_annotations(function, eval_str=True)
    except (NameError, SyntaxError) as error:
        raise KindError(f"{name}: an annotation cannot be read ({error})") from error
    note = notes.get(taken[0])
    if not isinstance(note, type) or not is_dataclass(note) or not _is_frozen(note):
        form = f"def {function.__name__}({taken[0]}: Settings), where Settings is a @dataclass(frozen=True)"
        raise KindError(f"{name}: its settings are a frozen dataclass: {form}")
    hidden = [each.name for each in fields(note) if not each.init]
    if hidden:
        raise KindError(f"{name}: {hidden[0]} of its settings can be given by nobody (init=False)")
    return note


def _is_frozen(note: type[Any]) -> bool:
    return bool(note.__dataclass_params__.frozen)
