"""Trail of a running task, kept for the next start: the state of its tree and the last reports of devices.

The next start puts it back into a tree that it makes anew, of the same recipe and plant file. A trail is kept
before the commands of its step leave, but for stops. So it may name a command that never left, and a command
that it does not name has left only where a power cut took the last writes.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter, itemgetter
from typing import Any, NamedTuple

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.model.commands import Position
from arboleda.model.kept_failures import failure_kept, read_failure
from arboleda.model.messages import Check, Failure, Receipt, TaskAnswer
from arboleda.model.sentence import Sentence, retold
from arboleda.trees.cell_robots import Planned
from arboleda.trees.node_state import Keeps

VERSION = 3
STATUS_WORD, FIRST = attrgetter("status._value_"), itemgetter(0)  # `value` takes several times as long
STATUSES = {status.value[0]: status for status in Status}
REMEMBERS = composites.Sequence | composites.Selector | composites.Parallel


class Knowledge(NamedTuple):
    """Knowledge of a device: its boot, its receipt, and the epoch of its bridge.

    Up to `more` commands may have reached the device that it had not named yet.
    """

    boot: int | None
    receipt: Receipt | None
    more: int
    bridge: int | None = None

    def explains(self, now: Receipt | None, *, others: int = 0) -> bool:
        """True where the commands that were under way, and at most `others` more, explain a later receipt."""
        before, most = self.receipt, self.more + others
        if now == before:
            return True
        if now is None:
            return False
        if before is not None and now.epoch == before.epoch:
            return 0 <= now.accepted - before.accepted <= most
        # A bridge counts from 1 in each epoch. A later bridge may have had commands of a start that is
        # forgotten.
        return now.epoch == self.bridge and now.accepted <= most


@dataclass(frozen=True, kw_only=True)
class Begun:
    """Beginning of a task, which does not change while it runs; `made` is the fingerprint of its tree.

    `envelope` are effectors that the task may tell to switch before their new grip is durable. So after a
    power cut none of them counts as off until it reports what it holds.
    """

    made: str
    planned: Planned
    envelope: Sequence[str] = ()

    @cached_property
    def text(self) -> str:
        """The text in which it is kept, encoded once and not at every step."""
        planned = self.planned
        return ENCODE([VERSION, self.made, planned.standing, planned.positions, self.envelope])

    @classmethod
    def read(
        cls,
        version: int,
        made: str,
        standing: Mapping[str, str],
        positions: Mapping[str, Any],
        envelope: Sequence[str] = (),
    ) -> Begun:
        """The beginning in a text; ValueError for another version."""
        if version != VERSION:
            raise ValueError("it is of another version")
        stood = {name: _position(each) for name, each in positions.items()}
        planned = Planned(standing=standing, positions=stood)
        return cls(made=made, planned=planned, envelope=tuple(map(str, envelope)))


class Trail(NamedTuple):
    """Trail of a task. `statuses` has a letter for each node, the root last; `nodes` has further states.

    `used` are the devices that the task has commanded. `taken` are those that hold a part of it, each with
    the boot in which it took that. `recovers`: the recovery runs, after the `failure` of the work. `cancels`:
    the task ends as cancelled.
    """

    begun: Begun
    statuses: str
    nodes: Mapping[int, Mapping[str, Any]]
    carrier: str | None
    back: Mapping[str, str]
    origins: Sequence[str]
    used: Sequence[str]
    knowledge: Mapping[str, Knowledge]
    grips: Mapping[str, str]
    zones: Mapping[str, Sequence[str]]  # that its machines hold for the tree
    failure: Failure | None = None
    recovers: bool = False
    cancels: bool = False
    stranded: Sentence | None = None
    answers: Sequence[TaskAnswer] = ()
    taken: Mapping[str, int | None] = {}
    unchecked: Sequence[Check] = ()

    def text(self) -> str:
        """The text in which it is kept: the beginning of the task, then its place."""
        return f"[{self.begun.text},{ENCODE(self[1:])}]"

    @classmethod
    def read(cls, text: str) -> Trail:
        """The trail in a text; ValueError for a text of another version."""
        try:
            begun, now = json.loads(text)
            fields = dict(zip(cls._fields[1:], now, strict=True))
            failure, stranded = fields["failure"], fields["stranded"]
            fields |= {
                "nodes": {int(number): each for number, each in fields["nodes"].items()},
                "knowledge": {name: _knowledge(*each) for name, each in fields["knowledge"].items()},
                "failure": None if failure is None else read_failure(*failure),
                "stranded": None if stranded is None else retold(*stranded),
                "answers": [TaskAnswer(**each) for each in fields["answers"]],
                "unchecked": [Check(each) for each in fields["unchecked"]],
            }
            return cls(begun=Begun.read(*begun), **fields)
        except (AttributeError, KeyError, TypeError) as error:
            raise ValueError(f"what was kept of a task is damaged ({error})") from error


def statuses(nodes: Iterable[Behaviour]) -> str:
    """The statuses of nodes, a letter each."""
    return "".join(map(FIRST, map(STATUS_WORD, nodes)))


def kept_of(nodes: Iterable[tuple[int, Keeps]]) -> dict[int, Mapping[str, Any]]:
    """The states to keep of nodes beside their statuses, by number."""
    states: dict[int, Mapping[str, Any]] = {}
    for number, node in nodes:
        if (node.status is Status.RUNNING or not node.ends_unkept) and (state := node.kept()):
            states[number] = state
    return states


def put_back(nodes: Sequence[Behaviour], trail: Trail) -> list[Keeps]:
    """Give the nodes of a new tree the states of a trail; returns the nodes of ours that were under way.

    ValueError where a node was under way that cannot go on, as one of a user's own class.
    """
    if len(trail.statuses) != len(nodes):
        raise ValueError("the tree has another number of nodes")
    for node, letter in zip(nodes, trail.statuses, strict=True):
        node.status = STATUSES[letter]
    for number, state in trail.nodes.items():
        node = nodes[number]
        if isinstance(node, Keeps):
            node.restore(state)
    under_way = [node for node in nodes if node.status is Status.RUNNING]
    for node in under_way:
        if isinstance(node, REMEMBERS):
            going = (child for child in node.children if child.status is Status.RUNNING)
            node.current_child = next(going, node.children[0])
        elif not isinstance(node, Keeps):
            raise ValueError(f"nobody knows how a step of the kind {type(node).__name__} goes on")
    return [node for node in under_way if isinstance(node, Keeps)]


def _plain(value: Failure | Sentence | TaskAnswer) -> Any:
    if isinstance(value, TaskAnswer):
        return vars(value)
    if isinstance(value, Failure):
        return failure_kept(value)
    return [str(value), value.data()]


# No value of a trail contains itself, so the encoder need not look for that.
ENCODE = json.JSONEncoder(check_circular=False, separators=(",", ":"), default=_plain).encode


def _knowledge(
    boot: int | None, receipt: Sequence[int] | None, more: int, bridge: int | None = None
) -> Knowledge:
    last = None if receipt is None else Receipt(*receipt)
    return Knowledge(boot=boot, receipt=last, more=more, bridge=bridge)


def _position(value: Any) -> Position:
    return tuple(value) if isinstance(value, list) else int(value)
