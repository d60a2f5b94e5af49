"""Built-in kinds of nodes, of BehaviorTree.CPP, Nav2 and MoveIt Pro: their ports and numbers of children.

The names, ports and defaults are those of BehaviorTree.CPP 4.10 and 3.8, of Nav2 for ROS 2 Jazzy, and of the
decorator ForEach of MoveIt Pro, as their headers and documentation give them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import Enum

from arboleda.model.recipe import FOR_PEOPLE

MANY = 1000  # children that a node has at most


class Category(str, Enum):
    """Category of a node in an editor; its words are the tags of the explicit form."""

    ACTION = "Action"
    CONDITION = "Condition"
    CONTROL = "Control"
    DECORATOR = "Decorator"
    SUBTREE = "SubTree"


class PortDirection(str, Enum):
    """Direction of a port's value; its words are those of a TreeNodesModel."""

    IN = "input_port"
    OUT = "output_port"
    BOTH = "inout_port"


@dataclass(frozen=True, kw_only=True)
class Port:
    """Value that a node takes or gives; `is_needed`: the node cannot work without the value.

    `words` are all possible values, if they are known. `limits` are those of a number, None where none are.
    `can_compare`: instead of a number it may have a comparison, as "> 120".
    """

    name: str
    type: str = ""
    direction: PortDirection = PortDirection.IN
    default: str | None = None
    is_needed: bool = False
    words: tuple[str, ...] = ()
    limits: tuple[float, float] | None = None
    can_compare: bool = field(default=False, metadata={FOR_PEOPLE: True})  # its type says so, too
    about: str = ""


@dataclass(frozen=True, kw_only=True)
class Kind:
    """Kind of node; `ports` is None where they are unknown. A node needs at least one port of `some_of`."""

    name: str
    category: Category
    ports: Mapping[str, Port] | None
    fewest: int = 0
    most: int = 0
    about: str = ""
    some_of: tuple[str, ...] = ()


def by_name(ports: Iterable[Port]) -> dict[str, Port]:
    return {each.name: each for each in ports}


def children(category: Category) -> tuple[int, int]:
    """The least and the greatest number of children of a category."""
    return {Category.CONTROL: (1, MANY), Category.DECORATOR: (1, 1)}.get(category, (0, 0))


def _port(text: str) -> Port:
    """The port of a text `name:type=default`; it begins with `>` for an output, `<>` for both directions."""
    direction = (
        PortDirection.BOTH
        if text.startswith("<>")
        else PortDirection.OUT
        if text.startswith(">")
        else PortDirection.IN
    )
    declared, _, default = text.lstrip("<>").partition("=")
    name, _, type = declared.partition(":")
    is_needed = "=" not in text and not name.endswith("?")
    return Port(
        name=name.removesuffix("?"),
        type=type,
        direction=direction,
        default=default or None,
        is_needed=is_needed,
    )


def _kind(
    category: Category, name: str, *ports: str, fewest: int | None = None, most: int | None = None
) -> Kind:
    least, greatest = children(category)
    return Kind(
        name=name,
        category=category,
        ports=by_name(map(_port, ports)),
        fewest=least if fewest is None else fewest,
        most=greatest if most is None else most,
    )


def _control(name: str, *ports: str, fewest: int | None = None, most: int | None = None) -> Kind:
    return _kind(Category.CONTROL, name, *ports, fewest=fewest, most=most)


def _decorator(name: str, *ports: str) -> Kind:
    return _kind(Category.DECORATOR, name, *ports)


def _action(name: str, *ports: str) -> Kind:
    return _kind(Category.ACTION, name, *ports)


def _switch(cases: int) -> Kind:
    ports = ("variable:string", *(f"case_{number}:string" for number in range(1, cases + 1)))
    return _control(f"Switch{cases}", *ports, fewest=cases + 1, most=cases + 1)


def _loop(type: str) -> Kind:
    return _decorator(f"Loop{type.title()}", "<>queue:", "if_empty:status=SUCCESS", f">value?:{type}")


_THRESHOLDS = ("success_count:int=-1", "failure_count:int=1")
_OLD_THRESHOLDS = ("success_threshold?:int", "failure_threshold?:int", "threshold?:int")
_SPEEDS = ("min_rate:double=0.1", "max_rate:double=1.0", "min_speed:double=0.0", "max_speed:double=0.5")
_CHECKED = ("value_A:", "value_B:", "return_on_mismatch:status=FAILURE")
OF_LIBRARY: Mapping[str, Kind] = {
    each.name: each
    for each in (
        _control("Sequence"),
        _control("AsyncSequence"),
        _control("SequenceWithMemory"),
        _control("ReactiveSequence"),
        _control("Fallback"),
        _control("AsyncFallback"),
        _control("ReactiveFallback"),
        _control("Parallel", *_THRESHOLDS, *_OLD_THRESHOLDS),
        _control("ParallelAll", "max_failures:int=1"),
        _control("IfThenElse", fewest=2, most=3),
        _control("WhileDoElse", fewest=2, most=3),
        _control("TryCatch", "catch_on_halt:bool=false", fewest=2),
        *map(_switch, range(2, 7)),
        _control("ManualSelector", "repeat_last_selection:bool=false"),
        _decorator("Inverter"),
        _decorator("ForceSuccess"),
        _decorator("ForceFailure"),
        _decorator("KeepRunningUntilFailure"),
        _decorator("Repeat", "num_cycles:int"),
        _decorator("RetryUntilSuccessful", "num_attempts:int"),
        _decorator("Timeout", "msec:msec"),
        _decorator("Delay", "delay_msec:msec"),
        _decorator("RunOnce", "then_skip:bool=true"),
        _decorator("Precondition", "if:script", "else:status=FAILURE"),
        *map(_loop, ("int", "bool", "double", "string")),
        _decorator("SkipUnlessUpdated", "entry:"),
        _decorator("WaitValueUpdate", "entry:"),
        _decorator("BlackboardCheckInt", *_CHECKED),
        _decorator("BlackboardCheckDouble", *_CHECKED),
        _decorator("BlackboardCheckString", *_CHECKED),
        _decorator("BlackboardCheckBool", *_CHECKED),
        _action("AlwaysSuccess"),
        _action("AlwaysFailure"),
        _action("Script", "code:script"),
        _action("SetBlackboard", "value:", "<>output_key:"),
        _action("UnsetBlackboard", "key:"),
        _action("Sleep", "msec:msec"),
        _kind(Category.CONDITION, "ScriptCondition", "code:script"),
        _kind(Category.CONDITION, "WasEntryUpdated", "entry:"),
    )
}
OF_NAV2: Mapping[str, Kind] = {
    each.name: each
    for each in (
        _control("RecoveryNode", "number_of_retries:int=1", fewest=2, most=2),
        _control("PipelineSequence"),
        _control("RoundRobin", "wrap_around:bool=false"),
        _decorator("RateController", "hz:double=10.0"),
        _decorator("DistanceController", "distance:double=1.0", "global_frame?:", "robot_base_frame?:"),
        _decorator("SpeedController", *_SPEEDS, "goal?:", "goals?:"),
        _decorator("SingleTrigger"),
        _decorator("GoalUpdater", "input_goal?:", "input_goals?:", ">output_goal?:", ">output_goals?:"),
        _decorator("GoalUpdatedController", "goal?:", "goals?:"),
        _decorator("PathLongerOnApproach", "path?:", "prox_len:double=3.0", "length_factor:double=2.0"),
        _control("NonblockingSequence"),
        _control("PersistentSequence", "<>current_child_idx:int"),
        _control("PauseResumeController", "pause_service_name?:", "resume_service_name?:"),
    )
}
OF_MOVEIT: Mapping[str, Kind] = {"ForEach": _decorator("ForEach", "vector_in:", ">out:", ">index?:int")}
BUILT_IN: Mapping[str, Kind] = {**OF_LIBRARY, **OF_NAV2, **OF_MOVEIT}
OTHER_SPELLINGS: Mapping[str, str] = {
    "RetryUntilSuccesful": "RetryUntilSuccessful",
    "SequenceStar": "SequenceWithMemory",
    "SubTreePlus": "SubTree",
    "Subtree": "SubTree",
}
"""The kinds by their names in version 3."""


SINCE_VERSION_4 = frozenset(
    {
        *("AsyncSequence", "AsyncFallback", "SequenceWithMemory", "ParallelAll", "TryCatch", "RunOnce"),
        *("Precondition", "LoopInt", "LoopBool", "LoopDouble", "LoopString"),
        *("SkipUnlessUpdated", "WaitValueUpdate", "Script", "UnsetBlackboard", "Sleep"),
        *("ScriptCondition", "WasEntryUpdated"),
    }
)
"""The kinds of the library that version 3 does not have."""


def is_own(declared: Kind, *, is_old: bool) -> bool:
    """True if a file declares a kind of its own under a built-in name that its author need not know.

    These names are those of Nav2 and MoveIt, and in a file of version 3 (`is_old`) those of version 4. A
    declaration that agrees with the built-in kind means the built-in kind.
    """
    built = BUILT_IN.get(declared.name)
    if built is None or (declared.name in OF_LIBRARY and not (is_old and declared.name in SINCE_VERSION_4)):
        return False
    declared_ports, ports = declared.ports or {}, built.ports or {}
    needed = {port.name for port in ports.values() if port.is_needed}
    return declared.category is not built.category or not needed <= declared_ports.keys() <= ports.keys()


def built_in(name: str) -> Kind | None:
    """The built-in kind of that name, in any spelling; None if there is none."""
    return BUILT_IN.get(OTHER_SPELLINGS.get(name, name))
