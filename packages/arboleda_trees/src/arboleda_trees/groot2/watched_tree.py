"""Groot2's protocol for one cell: requests in, replies out. It only reads."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from . import messages
from .cell_tree import NONE_YET, CellTree, Row
from .messages import NoAnswer, Request, RequestType, Transition

MOST_TRANSITIONS = 1000  # between two requests for them, as in BehaviorTree.CPP
READ_ONLY = "read only: breakpoints and hooks would change what robots do"
Pack = Callable[[Any], bytes]  # plain data as MessagePack


class WatchedTree:
    """Tree of a cell for viewers; times are Unix time in microseconds."""

    def __init__(self, pack: Pack) -> None:
        self._pack = pack
        self._tree = CellTree(NONE_YET)
        self._rows: Sequence[Row] = ()
        self._facts: Mapping[str, Any] = {}
        self._recorded_from: int | None = None
        self._transitions: deque[Transition] = deque(maxlen=MOST_TRANSITIONS)

    def saw(
        self, rows: Sequence[Row], facts: Mapping[str, Any], at_us: int, *, has_succeeded: bool = False
    ) -> None:
        """Take the cell's snapshot: the rows of its tree, none if none runs, and other facts.

        `has_succeeded`: the task of the last tree is done.
        """
        self._rows, self._facts = rows, facts
        if rows and not self._tree.is_of(rows):
            self._tree = CellTree(rows)
            self._transitions.clear()  # they have numbers of the former tree
        for node, status in self._tree.stand(rows, has_succeeded=has_succeeded):
            if self._recorded_from is not None:
                at = at_us - self._recorded_from
                self._transitions.append(Transition(at_us=at, node=node, status=status))

    def answer(self, parts: Sequence[bytes], now_us: int) -> list[bytes]:
        """The reply to a client, whatever it sent."""
        try:
            request = messages.request_of(parts)
            return messages.reply(request, self._tree.name, *self._content(request, now_us))
        except NoAnswer as error:
            return messages.refusal(error)

    def _content(self, request: Request, now_us: int) -> list[bytes]:
        if request.type is RequestType.TREE:
            return [self._tree.xml]
        if request.type is RequestType.STATUS:
            return [messages.statuses(self._tree.codes)]
        if request.type is RequestType.BLACKBOARD:
            return [self._pack(self._blackboards(request.words.split(";")))]
        if request.type is RequestType.HOOKS_DUMP:
            return [b"[]"]
        if request.type is RequestType.RECORDING:
            return self._record(request.words, now_us)
        if request.type is RequestType.TRANSITIONS:
            content = messages.transitions(self._transitions)
            self._transitions.clear()
            return [content]
        if request.type in (RequestType.REMOVE_ALL_HOOKS, RequestType.DISABLE_ALL_HOOKS):
            return []  # there are none
        raise NoAnswer(READ_ONLY)

    def _blackboards(self, names: Sequence[str]) -> dict[str, Any] | None:
        """The variables of the trees of these names; None if there is no such tree."""
        values = self._tree.values(self._rows)
        values[self._tree.tree.main] = {**self._facts, **values[self._tree.tree.main]}
        return {name: values[name] for name in names if name in values} or None

    def _record(self, words: str, now_us: int) -> list[bytes]:
        if words == "start":
            self._recorded_from = now_us
            self._transitions.clear()
            return [str(now_us).encode()]
        if words == "stop":
            self._recorded_from = None
        return []
