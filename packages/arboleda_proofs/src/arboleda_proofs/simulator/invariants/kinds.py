"""Invariant of declared kinds: a verb is told as its definition says, read anew here."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from arboleda.drivers import (
    Command,
    Effect,
    FactType,
    Motion,
    Process,
    Query,
    Slot,
    Switch,
    Value,
    VerbCommand,
    Work,
)

from .invariant import Look, Trigger, invariant

CLASSES: Mapping[Effect, type[Command]] = {
    Effect.MOTION: Motion,
    Effect.PROCESS: Process,
    Effect.SWITCH: Switch,
    Effect.QUERY: Query,
}


@invariant(Trigger.COMMANDED)
def commands_are_as_declared(look: Look) -> Iterator[str]:
    """A command of a device has the effect, values, facts, needs and end that its verb is declared with."""
    for sent in look.record.commands.new:
        call = sent.command
        if isinstance(call, VerbCommand) and (wrong := [what for what, as_is in LIKE if not as_is(call)]):
            yield f"{sent} is not {call.verb} as it is declared: {', '.join(wrong)}"


def _as_values(call: VerbCommand) -> bool:
    """True for a value of each parameter, in their order, that its type has."""
    types, names = dict(call.definition.parameters), [name for name, _ in call.values]
    return names == [*types] and all(_is_one(types[name], value) for name, value in call.values)


def _is_one(type: FactType, value: Value) -> bool:
    if type.words:
        return value in type.words
    of = (int, float) if type.type is float else type.type
    if not isinstance(value, of) or (isinstance(value, bool) and type.type is not bool):
        return False
    return not isinstance(value, int | float) or type.lower <= value <= type.upper


def _as_sets(call: VerbCommand) -> bool:
    """True if it sets what is declared; for a function of its values only that function knows."""
    return call.definition.sets_by is not None or call.sets == _sets(call)


def _sets(call: VerbCommand) -> tuple[tuple[str, Value], ...]:
    values = dict(call.values)
    rows = call.definition.sets
    return tuple((name, values[value.name] if isinstance(value, Slot) else value) for name, value in rows)


def _as_end(call: VerbCommand) -> bool:
    return not isinstance(call, Work) or call.on_stop is call.definition.on_stop


def _as_grip(call: VerbCommand) -> bool:
    """True if a switch counts as a grip, and as one that lets go, by the only truth value that it sets."""
    if not isinstance(call, Switch):
        return True
    held = next((value for _, value in _sets(call) if isinstance(value, bool)), None)
    return call.grips is (held if call.definition.holds else None)


LIKE: tuple[tuple[str, Callable[[VerbCommand], bool]], ...] = (
    ("effect", lambda call: isinstance(call, CLASSES[call.definition.effect])),
    ("with", _as_values),
    ("sets", _as_sets),
    ("needs", lambda call: call.needs == call.definition.needs),
    ("at_most_s", lambda call: call.at_most_s == call.definition.at_most_s),
    ("on_stop", _as_end),
    ("holds", _as_grip),
    ("makes", lambda call: call.makes_part is call.definition.makes_part),
    ("works_on", lambda call: call.works_on_part is call.definition.works_on_part),
)


KINDS = (commands_are_as_declared,)
