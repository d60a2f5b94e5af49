"""Keys of the driver `ros` in a plant file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from arboleda.drivers import DriverError, Value, among
from arboleda_drivers.meaning import Meaning, as_text
from arboleda_drivers.paths import FIELD, steps
from arboleda_drivers.ros_action.presence import End

TYPES = {"action": "action", "service": "srv", "publish": "msg", "topic": "msg"}
FORMS = {
    "action": "turtlesim/action/RotateAbsolute",
    "srv": "std_srvs/srv/Trigger",
    "msg": "std_msgs/msg/Bool",
}
NOW = "$now"


@dataclass(frozen=True, kw_only=True)
class Argument:
    """Value that is sent: `$name` is the verb's parameter. What is sent is what means this value."""

    value: bool | int | float | str
    words: dict[str, Any] = field(default_factory=dict)
    scale: float = 1.0

    def __post_init__(self) -> None:
        Meaning(words=self.words, scale=self.scale)  # refuses what has none

    @property
    def parameter(self) -> str | None:
        """The parameter that it names; None for a plain value."""
        value = self.value
        return value[1:] if isinstance(value, str) and value.startswith("$") and value != NOW else None

    def filled(self, values: Mapping[str, Value]) -> Any:
        """The value to send; raises DriverError for a word that stands for none."""
        value = self.value if self.parameter is None else values[self.parameter]
        word, meaning = as_text(value), Meaning(words=self.words, scale=self.scale)
        if self.words and word not in self.words:
            raise DriverError(f"there is no word {word}; {among(word, self.words)}")
        return meaning.shown(word if self.words else value)


Fields = dict[str, Any]
"""Values by their paths."""
Given = Argument | bool | int | float | str | list[bool | int | float | str]


@dataclass(frozen=True, kw_only=True)
class Qos:
    """Quality of service of what is published, in the words of ROS 2."""

    reliability: Literal["reliable", "best_effort"] = "reliable"
    durability: Literal["volatile", "transient_local"] = "volatile"
    depth: int = 10


@dataclass(frozen=True, kw_only=True)
class Field(Meaning):
    """Field of a result or of a response, and what its value means."""

    field: str

    def __post_init__(self) -> None:
        super().__post_init__()
        steps(self.field, FIELD)


@dataclass(frozen=True, kw_only=True)
class Call:
    """Goal of an action, request of a service, or message, with the fields that are not as the type has them.

    `done` are fields of the result or response that say success by these values, `failure` is the one that
    says why not.
    """

    type: str
    action: str = ""
    service: str = ""
    publish: str = ""
    fields: dict[str, Given] = field(default_factory=dict)
    qos: Qos = Qos()
    done: dict[str, bool | int | float | str] = field(default_factory=dict)
    failure: Field | None = None

    def __post_init__(self) -> None:
        if sum(bool(each) for each in (self.action, self.service, self.publish)) != 1:
            raise DriverError("give one of action, service and publish, with its name")
        check_type(self.type, TYPES[self.kind])
        for path in (*self.fields, *self.done):
            steps(path, FIELD)

    @property
    def kind(self) -> str:
        """The key that names it: action, service or publish."""
        return "action" if self.action else "service" if self.service else "publish"

    @property
    def name(self) -> str:
        return self.action or self.service or self.publish

    @property
    def parameters(self) -> Iterator[tuple[str, str]]:
        """The parameters of the verb that it names, each with the field."""
        for path, given in self.fields.items():
            yield from ((path, each.parameter) for each in _arguments(given) if each.parameter is not None)

    def filled(self, values: Mapping[str, Value]) -> Fields:
        """The fields with these values of the parameters; raises DriverError for one without a word."""
        filled = {path: [each.filled(values) for each in _arguments(it)] for path, it in self.fields.items()}
        return {
            path: each if isinstance(self.fields[path], list) else each[0] for path, each in filled.items()
        }


@dataclass(frozen=True, kw_only=True)
class Verb(Call):
    """Call for a verb; `answer` is the field of the result or response that answers a query."""

    answer: Field | None = None


@dataclass(frozen=True, kw_only=True)
class Source(Meaning):
    """Source of a fact: a `field` of a `topic`, of the `feedback` or the `result` of a verb, or with
    `done` the verb that ended well last, whose word it then is. After `silent_s` without a message the link
    is lost."""

    topic: str = ""
    type: str = ""
    field: str = ""
    feedback: str = ""
    result: str = ""
    verb: str = ""
    done: bool = False
    silent_s: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if sum(bool(each) for each in (self.topic, self.feedback, self.result, self.done)) != 1:
            raise DriverError("give one of topic, feedback, result and done")
        if bool(self.topic) != bool(self.field) or bool(self.topic) != bool(self.type):
            raise DriverError(
                "topic, type and field go together, {topic: /on, type: std_msgs/msg/Bool, field: data}"
            )
        if self.topic:
            check_type(self.type, "msg")
        if self.path:
            steps(self.path, FIELD)

    @property
    def path(self) -> str:
        """The path into its message; "" where it has none."""
        return self.field or self.feedback or self.result


@dataclass(frozen=True, kw_only=True)
class Keys:
    """Keys of the driver `ros`: the mapping of one device. `namespace` comes before names that do not
    begin with /. `halt` is called beside the cancels of all goals, and `clear` after it.
    `lan` lets the driver reach other machines.
    """

    namespace: str = ""
    verbs: dict[str, Verb] = field(default_factory=dict)
    facts: dict[str, Source] = field(default_factory=dict)
    state: Source | None = None
    halt: Call | None = None
    clear: Call | None = None
    answer_s: float = 2.0
    lan: bool = False

    def __post_init__(self) -> None:
        if not 0.1 <= self.answer_s <= 60:
            raise DriverError(f"answer_s is {self.answer_s:g}; allowed: 0.1 to 60")
        if any(call is not None and call.action for call in (self.halt, self.clear)):
            raise DriverError(
                "halt and clear are a service, or are published; goals are cancelled beside them"
            )

    @property
    def calls(self) -> Iterator[tuple[tuple[str, ...], Call]]:
        """All that is ever sent, with its keys."""
        yield from ((("verbs", name), verb) for name, verb in self.verbs.items())
        yield from (((key,), call) for key, call in (("halt", self.halt), ("clear", self.clear)) if call)

    @property
    def sources(self) -> Iterator[tuple[tuple[str, ...], Source]]:
        """All that is heard, with its keys."""
        yield from ((("facts", name), source) for name, source in self.facts.items())
        if self.state is not None:
            yield ("state",), self.state

    def end(self, call: Call) -> End:
        """The other end that answers or hears a call."""
        return End(call.kind, self.full(call.name))

    def full(self, name: str) -> str:
        """The name in the namespace."""
        return name if name.startswith("/") or not self.namespace else f"{self.namespace.rstrip('/')}/{name}"

    def verb_of(self, source: Source) -> str:
        """The verb whose feedback or result a fact is; "" where that is not clear."""
        kinds = ("action",) if source.feedback else ("action", "service")
        known = [name for name, verb in self.verbs.items() if verb.kind in kinds]
        return source.verb or (known[0] if len(known) == 1 else "")


def _arguments(given: Given) -> list[Argument]:
    return [
        each if isinstance(each, Argument) else Argument(value=each)
        for each in (given if isinstance(given, list) else [given])
    ]


def check_type(type: str, kind: str) -> None:
    """Raises DriverError unless it names a type of that kind."""
    if type.split("/")[1:-1] != [kind]:
        raise DriverError(f"type is {type}; it is written as {FORMS[kind]}")
