"""Trail of a running task, kept for the next start: the state of its tree, and what its devices had reported
by then. It is put back into a tree that is made anew, of the same recipe and plant file.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from py_trees import composites
from py_trees.behaviour import Behaviour
from py_trees.common import Status

from arboleda.dispatch.belief import Belief
from arboleda.model.commands import Position
from arboleda.model.messages import Check, Failure, Receipt, TaskAnswer
from arboleda.model.sentence import Sentence, retold
from arboleda.trees.cell_robots import Planned
from arboleda.trees.node_state import Keeps, failure_kept, read_failure

VERSION = 3
STATUSES = {status.value[0]: status for status in Status}
REMEMBERS = composites.Sequence | composites.Selector | composites.Parallel


class Knowledge(NamedTuple):
    """Knowledge of a device; `more` commands may have reached it that it had not told of, by the start
    of the bridge that had the epoch `bridge`.
    """

    boot: int | None
    receipt: Receipt | None
    more: int
    bridge: int | None = None

    @classmethod
    def of(cls, belief: Belief, more: int) -> Knowledge:
        """As it is now."""
        return cls(boot=belief.boot_id, receipt=belief.receipt, more=more, bridge=belief.epoch)

    def explains(self, now: Receipt | None, *, others: int = 0) -> bool:
        """True where the commands that were under way, and so many others at most, can have led there."""
        before, most = self.receipt, self.more + others
        if now == before:
            return True
        if now is None:
            return False
        if before is not None and now.epoch == before.epoch:
            return 0 <= now.accepted - before.accepted <= most
        # it counted from 1; a later bridge had commands of a later start, whose steps a power cut has undone
        return now.epoch == self.bridge and now.accepted <= most


@dataclass(frozen=True, kw_only=True)
class Begun:
    """Start of a task, which stays the same while it runs; `made` is the hash of its tree.

    `envelope` are the effectors that it may have told to switch without this being durable: after a power cut
    nobody knows what they hold before they report it.
    """

    made: str
    planned: Planned
    envelope: Sequence[str] = ()

    @cached_property
    def text(self) -> str:
        """It as it is kept, written once and not at every step."""
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
        """It as it was kept."""
        if version != VERSION:
            raise ValueError("it is of another version")
        stood = {name: _position(each) for name, each in positions.items()}
        planned = Planned(standing=standing, positions=stood)
        return cls(made=made, planned=planned, envelope=tuple(map(str, envelope)))


class Trail(NamedTuple):
    """`statuses` has a letter for each node, the root last, `nodes` what else is kept of some, by number.
    `used` are the devices that the task has told to do something, `taken` those that hold a part of it, with
    the boot in which they took that.

    `failure` is that of the work, where what runs `recovers` from it; `cancels`: it ends as cancelled.
    """

    begun: Begun
    statuses: str
    nodes: Mapping[int, Mapping[str, Any]]
    carrier: str | None
    back: Mapping[str, str]
    origins: Sequence[str]
    used: Sequence[str]
    known: Mapping[str, Knowledge]
    grips: Mapping[str, str]
    zones: Mapping[str, Sequence[str]]  # those that its machines held, by the word of the tree
    failure: Failure | None = None
    recovers: bool = False
    cancels: bool = False
    stranded: Sentence | None = None
    answers: Sequence[TaskAnswer] = ()
    taken: Mapping[str, int | None] = {}
    unchecked: Sequence[Check] = ()

    def text(self) -> str:
        """It as it is kept: how the task began, and where it stands."""
        return f"[{self.begun.text},{ENCODE(self[1:])}]"

    @classmethod
    def read(cls, text: str) -> Trail:
        """It as it was kept; ValueError for what this version did not write."""
        try:
            begun, now = json.loads(text)
            fields = dict(zip(cls._fields[1:], now, strict=True))
            failure, stranded = fields["failure"], fields["stranded"]
            fields |= {
                "nodes": {int(number): each for number, each in fields["nodes"].items()},
                "known": {name: _known(*each) for name, each in fields["known"].items()},
                "failure": None if failure is None else read_failure(*failure),
                "stranded": None if stranded is None else retold(*stranded),
                "answers": [TaskAnswer(**each) for each in fields["answers"]],
                "unchecked": [Check(each) for each in fields["unchecked"]],
            }
            return cls(begun=Begun.read(*begun), **fields)
        except (AttributeError, KeyError, TypeError) as error:
            raise ValueError(f"what was kept of a task is damaged ({error})") from error


def statuses(nodes: Iterable[Behaviour]) -> str:
    """A letter for each node."""
    return "".join([node.status._value_[0] for node in nodes])  # `value` takes several times as long


def kept_of(nodes: Iterable[tuple[int, Keeps]]) -> dict[int, Mapping[str, Any]]:
    """The state that is kept of nodes beside their status, by number."""
    kept: dict[int, Mapping[str, Any]] = {}
    for number, node in nodes:
        if (node.status is Status.RUNNING or not node.ends_unkept) and (state := node.kept()):
            kept[number] = state
    return kept


def put_back(nodes: Sequence[Behaviour], trail: Trail) -> list[Keeps]:
    """Give the nodes of a new tree the state that is kept; those of ours that were under way.

    ValueError where a node was under way of which nobody knows how it goes on.
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


# Nothing that is kept contains itself, so nobody need look for that.
ENCODE = json.JSONEncoder(check_circular=False, separators=(",", ":"), default=_plain).encode


def _known(
    boot: int | None, receipt: Sequence[int] | None, more: int, bridge: int | None = None
) -> Knowledge:
    last = None if receipt is None else Receipt(*receipt)
    return Knowledge(boot=boot, receipt=last, more=more, bridge=bridge)


def _position(value: Any) -> Position:
    return tuple(value) if isinstance(value, list) else int(value)
