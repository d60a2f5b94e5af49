"""Conversion of events and messages to plain data for JSON, and of events back, exact to the last bit."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, fields, is_dataclass, replace
from enum import Enum
from functools import partial
from operator import attrgetter
from typing import Any

from arboleda.model.messages import (
    Check,
    ClockSet,
    Course,
    Event,
    Fact,
    Failure,
    FaultByHand,
    Interference,
    Jog,
    Journal,
    KeptTask,
    LateDeparture,
    MotionState,
    OperatorAnswer,
    OperatorRequest,
    Reason,
    Receipt,
    Report,
    RestartRequest,
    Revision,
    RevisionName,
    Shutdown,
    TaskAnswer,
    TaskRequest,
    TaskState,
    Tokens,
    Uncontested,
    Undelivered,
    Verb,
)
from arboleda.model.sentence import Phrase, Sentence, Value
from arboleda.model.verbs import from_text

from .errors import NoRecord

Memory = dict[Fact, dict[str, str]]
TYPE, NUMBER = "type", "number"
ABOUT_VERBS = (OperatorAnswer.__name__, Journal.__name__)
NOT_FINITE = ("nan", "inf", "-inf")
SENTENCE = {"key", "english", "values"}
EVENTS: dict[str, type[Any]] = {
    each.__name__: each
    for each in (
        Report,
        TaskRequest,
        OperatorRequest,
        Jog,
        Undelivered,
        LateDeparture,
        FaultByHand,
        ClockSet,
        Interference,
        Uncontested,
        Shutdown,
        RestartRequest,
        Revision,
    )
}


def plain(value: Any) -> Any:
    """The value as plain data; of a dataclass its type, and the fields that differ from their defaults.

    Here and below, values that are plain already are passed on without a call: most are, of each step.
    """
    kind = type(value)
    if kind in SAME:
        return value
    write = WRITERS.get(kind)
    return _writer(kind)(value) if write is None else write(value)


def event_from(data: Any) -> Event:
    """The event in plain data; raises NoRecord if this version does not know it."""
    try:
        made: Event = _made(EVENTS[data[TYPE]], data)
        if isinstance(made, OperatorRequest) and not made.arguments:
            made = _with_arguments(made)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise NoRecord(f"it has an event that this version does not know ({_short(data)})") from error
    return made


def _with_arguments(request: OperatorRequest) -> OperatorRequest:
    """The request of a record whose plant took the arguments of a verb as words of its scope."""
    scope, arguments = from_text(request.verb, request.scope)
    return replace(request, scope=scope, arguments=arguments) if arguments else request


def message_from(data: Any) -> Any:
    """The message as this version records it: arguments of a verb apart from its scope."""
    if data.get(TYPE) not in ABOUT_VERBS or "arguments" in data or data.get("verb") is None:
        return data
    scope, arguments = from_text(Verb(data["verb"]), data["scope"])
    return data | {"scope": scope, "arguments": plain(arguments)} if arguments else data


def kept_from(data: Any) -> KeptTask:
    """The task of an earlier start in plain data; raises NoRecord if this version does not know it."""
    try:
        return _kept(data)
    except (AttributeError, IndexError, KeyError, TypeError, ValueError) as error:
        raise NoRecord(f"it has a task that this version does not know ({_short(data)})") from error


def memory_from(data: Any) -> Memory:
    """The memory of earlier starts from plain data; raises NoRecord if it is not valid."""
    try:
        return {
            Fact(fact): {str(name): str(value) for name, value in kept.items()} for fact, kept in data.items()
        }
    except (AttributeError, ValueError) as error:
        raise NoRecord(f"it has a fact that this version does not know ({_short(data)})") from error


def value_from(data: Any) -> Any:
    """The value from plain data, with its sentences and numbers; tuples stay lists, and words stay words."""
    if isinstance(data, list):
        return [value_from(each) for each in data]
    if not isinstance(data, dict):
        return data
    if data.keys() == {NUMBER} and data[NUMBER] in NOT_FINITE:
        return float(data[NUMBER])
    if isinstance(data.get("values"), dict) and data.keys() - {"others"} == SENTENCE:
        return sentence_from(data)
    return {key: value_from(each) for key, each in data.items()}


def _short(data: Any) -> str:
    return repr(data)[:80]


def _number(value: float) -> Any:
    """The number as plain data; JSON itself has no word for one that is not finite."""
    return value if math.isfinite(value) else {NUMBER: repr(value)}


def _sequence(value: Any) -> list[Any]:
    return [each if type(each) in SAME else plain(each) for each in value]


def _mapping(value: Mapping[Any, Any]) -> dict[str, Any]:
    return {
        key if type(key) is str else str(plain(key)): each if type(each) in SAME else plain(each)
        for key, each in value.items()
    }


def _sentence(value: Sentence) -> dict[str, Any]:
    return {
        "key": value.key,
        "english": value.phrase.english,
        "values": _mapping(value.values),
        **_others(value.phrase),
    }


def _others(phrase: Phrase) -> dict[str, Any]:
    return {"others": dict(phrase.others)} if phrase.others else {}


def _error(value: BaseException) -> str:
    return f"{type(value).__name__}: {value}"


SAME = frozenset({str, int, bool, type(None)})
WRITERS: dict[type, Callable[[Any], Any]] = {
    float: _number,
    tuple: _sequence,
    list: _sequence,
    dict: _mapping,
    Sentence: _sentence,
}


def _writer(kind: type) -> Callable[[Any], Any]:
    """The function that makes plain data of a class's values, by its nature; found once for each class."""
    found = _found(kind)
    WRITERS[kind] = found
    return found


def _found(kind: type) -> Callable[[Any], Any]:
    if issubclass(kind, Enum):
        return attrgetter("_value_")  # `value` takes two calls of Python
    if is_dataclass(kind):
        return partial(_record, kind.__name__, _defaults(kind))
    for base in (bool, int, float, str):
        if issubclass(kind, base):
            return lambda value: plain(base(value))
    if issubclass(kind, Mapping):
        return _mapping
    if issubclass(kind, tuple | list):
        return _sequence
    if issubclass(kind, set | frozenset):
        return lambda value: sorted(_sequence(value), key=repr)
    return _error if issubclass(kind, BaseException) else lambda _: kind.__name__


def _record(name: str, defaults: Sequence[tuple[str, Any]], value: Any) -> dict[str, Any]:
    data = {TYPE: name}
    for field, default in defaults:
        if (each := getattr(value, field)) is not default:
            data[field] = each if type(each) in SAME else plain(each)
    return data


def _defaults(kind: Any) -> tuple[tuple[str, Any], ...]:
    """The fields of a dataclass with their defaults."""
    return tuple((each.name, each.default) for each in fields(kind))


def _made(kind: type[Any], data: Mapping[str, Any]) -> Any:
    """A dataclass of these fields; raises an error for a missing or unknown one."""
    readers = READERS[kind]
    values = {}
    for name, each in data.items():
        if name == TYPE:
            continue
        reader = readers.get(name)
        values[name] = reader(each) if reader is not None else each if type(each) in SAME else _value(each)
    missing = NEEDED[kind] - values.keys()
    if missing:
        raise ValueError(f"{kind.__name__} has no {min(missing)}")
    return kind(**values)


def _value(data: Any) -> Any:
    """The value from plain data without a type of its own: lists become tuples, the only kind in an event."""
    if isinstance(data, list):
        return tuple(_value(each) for each in data)
    return float(data[NUMBER]) if isinstance(data, dict) else data


def sentence_from(data: Any) -> Sentence | None:
    """The sentence in plain data, or None; raises errors of several types for anything else."""
    if data is None:
        return None
    phrase = Phrase(data["key"], data["english"], **data.get("others", {}))
    return Sentence(phrase, {slot: _slot_value(each) for slot, each in data["values"].items()})


def _slot_value(data: Any) -> Value:
    if isinstance(data, list):
        return tuple(_slot_value(each) for each in data)
    if isinstance(data, dict) and NUMBER not in data:
        inner = sentence_from(data)
        assert inner is not None
        return inner
    value: Value = _value(data)
    return value


def _tokens(data: Any) -> Tokens:
    return Tokens(*data)


def _receipt(data: Any) -> Receipt:
    return Receipt(*data)


def _version(data: Any) -> RevisionName:
    version: RevisionName = _made(RevisionName, data)
    return version


def _failure(data: Any) -> Failure:
    failure: Failure = _made(Failure, data)
    return failure


def _kept(data: Any) -> KeptTask:
    kept: KeptTask = _made(KeptTask, data)
    return kept


def _course(data: Any) -> Course:
    course: Course = _made(Course, data)
    return course


def _states(data: Any) -> tuple[MotionState, ...]:
    return tuple(map(MotionState, data))


def _checks(data: Any) -> tuple[Check, ...]:
    return tuple(map(Check, data))


def _answers(data: Any) -> tuple[TaskAnswer, ...]:
    return tuple(_made(TaskAnswer, each) for each in data)


Reader = Callable[[Any], Any]
READERS: dict[type, dict[str, Reader]] = {
    Report: {
        "state": MotionState,
        "receipt": _receipt,
        "tokens": _tokens,
        "lost": sentence_from,
        "foreign": sentence_from,
    },
    TaskRequest: {"kept": _kept},
    OperatorRequest: {"verb": Verb},
    Jog: {},
    Undelivered: {"sentence": sentence_from},
    LateDeparture: {},
    Interference: {"sentence": sentence_from},
    Uncontested: {"said": _states},
    FaultByHand: {"sentence": sentence_from},
    ClockSet: {},
    Shutdown: {},
    Revision: {"version": _version},
    RestartRequest: {},
    RevisionName: {},
    KeptTask: {
        "state": TaskState,
        "failure": _failure,
        "answers": _answers,
        "choice": sentence_from,
        "course": _course,
        "unchecked": _checks,
    },
    Failure: {"reason": Reason, "sentence": sentence_from},
    TaskAnswer: {},
    Course: {"begun": dict},
}
NEEDED = {kind: frozenset(each.name for each in fields(kind) if each.default is MISSING) for kind in READERS}
"""The fields without a default of each dataclass that is read."""
