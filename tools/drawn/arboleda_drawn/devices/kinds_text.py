"""Drawn kinds as a file of Python, roughly as a person would write it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .kinds import Kind, Span, Type, Verb

HEAD = '''"""Kinds that were drawn from a seed."""

from dataclasses import dataclass

from arboleda.kinds import Axes, Axis, Kind, Number, kind, motion, moving_kind, process, query, switch
'''
TURNTABLE = "turntable"  # the kind of robots in Python, which is always the same
TURNS = f'''

@dataclass(frozen=True, kw_only=True)
class Turntable:
    """What the plant file may say of a turntable."""

    deg_s: float = 60.0


@moving_kind({TURNTABLE!r})
def turntable(settings: Turntable) -> Axes:
    """Turns parts to where somebody works on them."""
    return Axes(Axis("table", unit="deg", lower=-180, upper=180, speed=settings.deg_s))
'''
TYPES: Mapping[str, str] = {"bool": "bool", "int": "int", "number": "float", "text": "str"}
LEAST_S = 0.6  # of `at_most_s`, beside the time that a verb takes


def kinds_of(kinds: Sequence[Kind]) -> str:
    """The file with these kinds, and with that of turntables."""
    return HEAD + TURNS + "".join(f"\n\n{_kind(each)}\n" for each in kinds)


def _kind(kind: Kind) -> str:
    facts = ", ".join(f"{name!r}: {_type(type)}" for name, type in kind.facts)
    verbs = "".join(f"\n            {verb.name!r}: {_verb(kind, verb)}," for verb in kind.all_verbs)
    settings = kind.name.title().replace("_", "")
    return f'''@dataclass(frozen=True, kw_only=True)
class {settings}:
    """What the plant file may say of a {kind.name}."""

    pace: float = 1.0


@kind({kind.name!r})
def {kind.name}(settings: {settings}) -> Kind:
    """Was drawn."""
    return Kind(
        facts={{{facts}}},
        verbs={{{verbs}
        }},
    )'''


def _verb(kind: Kind, verb: Verb) -> str:
    """The call that makes a verb; its time is computed of the settings."""
    given = "".join(f", {name}" for name, _ in verb.parameters)
    words = [f"parameters={{{_types(verb.parameters)}}}"] if verb.parameters else []
    words += [
        f"{key}={dict(values)!r}" for key, values in (("sets", verb.sets), ("needs", verb.needs)) if values
    ]
    if verb.takes_s:
        words.append(f"takes_s=lambda{given[1:]}: {verb.takes_s} * settings.pace")
    if verb.takes_s or verb.at_most_s is not None:
        words.append(f"at_most_s={verb.at_most_s or round(verb.takes_s * 3 + LEAST_S, 3)}")
    words += [word for word, is_so in _words(verb) if is_so]
    if verb.answers:
        words.append(f"answers={list(verb.answers)!r}")
    elif verb.numbers is not None:
        words.append(f"answers={_type(verb.numbers)}")
    if _counts(kind, verb):
        words.append(f"virtual=lambda facts{given}: {{'count': facts['count'] + 1}}")
    return f"{verb.effect}({', '.join(words)})"


def _words(verb: Verb) -> tuple[tuple[str, bool], ...]:
    return (
        ("finishes=True", verb.finishes),
        ("holds_part=True", verb.holds),
        ("works_on_part=True", verb.works_on),
        ("makes_part=True", verb.makes),
    )


def _counts(kind: Kind, verb: Verb) -> bool:
    """True for work that a virtual device counts."""
    return verb.effect == "process" and dict(kind.facts).get("count") in ("int", "number")


def _types(parameters: Sequence[tuple[str, Type]]) -> str:
    return ", ".join(f"{name!r}: {_type(type)}" for name, type in parameters)


def _type(type: Type) -> str:
    if isinstance(type, Span):
        return f"Number({type.lower!r}, {type.upper!r})"
    return repr(list(type)) if isinstance(type, tuple) else TYPES[type]
