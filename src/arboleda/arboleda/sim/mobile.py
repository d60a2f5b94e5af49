"""Drive of a mobile robot's board: node to node over its grid."""

from __future__ import annotations

from itertools import pairwise

from arboleda.kinds.mobile import Mobile
from arboleda.model.facts import Value
from arboleda.wire.payloads import PathGoal
from arboleda.wire.topics import Channel

from .body import BodyReport, Robotic, SeenState


class MobileBody(Robotic):
    """Body of a mobile robot at a node, or on an edge that it always drives to its end, in pitch / speed.

    `node` is where it believes to be, `true_node` where it is.
    """

    channels = frozenset({Channel.PATH, Channel.STOP, Channel.HOME, Channel.BEAT})
    axes: int | None = None

    def __init__(self, mobile: Mobile, *, start_node: int) -> None:
        self._grid = mobile.grid
        self._reports = tuple(BodyReport(node=node) for node in range(mobile.grid.size))
        self._edge_us = max(1, round(mobile.grid.pitch / mobile.speed * 1e6))
        self._start_node = self.true_node = start_node
        self.reset()

    def reset(self) -> None:
        """Reset as a board comes up, believing the start node; the robot stays where it is."""
        self.node = self._start_node
        self._way: tuple[int, ...] = ()  # nodes ahead; the first one ends the edge it is on
        self.next_change_us: int | None = None

    @property
    def moving(self) -> bool:
        return self.next_change_us is not None

    @property
    def true_place(self) -> int:
        return self.true_node

    @property
    def true_facts(self) -> dict[str, Value]:
        return {}

    def admits(self, goal: PathGoal) -> bool:
        """True if the path starts here or next door and never leaves the grid's edges."""
        way = self._ahead(goal.nodes)
        nodes_exist = all(node < self._grid.size for node in goal.nodes)
        edges = pairwise((self._next_node, *way))
        return nodes_exist and all(there in self._grid.neighbours(here) for here, there in edges)

    def start(self, now_us: int, goal: PathGoal) -> None:
        self._drive(now_us, self._ahead(goal.nodes))

    def home(self, now_us: int) -> None:
        """Drive to the start node by sight, whatever node it believed to be at."""
        if not self._way:
            self.node = self.true_node
        self._drive(now_us, self._grid.route(self._next_node, self._start_node)[1:])

    def place(self, seen: SeenState, *, holds: bool) -> None:
        if seen.node is not None:
            self.node = self.true_node = seen.node

    def put_at_reference(self) -> None:
        self.node = self.true_node = self._start_node

    def stop(self, now_us: int) -> None:
        self._way = self._way[:1]

    def advance(self, now_us: int) -> None:
        while self.next_change_us is not None and self.next_change_us <= now_us:
            if self._way:
                self._pass(self._way[0])
                _, *ahead = self._way
                self._way = tuple(ahead)
            self.next_change_us = self.next_change_us + self._edge_us if self._way else None

    def switch_effector(self, on: bool) -> None:
        raise NotImplementedError("a mobile robot has no effector and no topic for one")

    def tell(self) -> BodyReport:
        return self._reports[self.node]

    @property
    def _next_node(self) -> int:
        """The node at which the next edge can begin."""
        return self._way[0] if self._way else self.node

    def _pass(self, node: int) -> None:
        """Reach the next node; a misplaced robot drives the same edge from there, up to the border."""
        columns = self._grid.columns
        row, column = (
            here + to - since
            for here, to, since in zip(
                divmod(self.true_node, columns),
                divmod(node, columns),
                divmod(self.node, columns),
                strict=True,
            )
        )
        if 0 <= row < self._grid.rows and 0 <= column < columns:
            self.true_node = row * columns + column
        self.node = node

    def _ahead(self, nodes: tuple[int, ...]) -> tuple[int, ...]:
        return nodes[1:] if nodes[0] == self._next_node else nodes

    def _drive(self, now_us: int, ahead: tuple[int, ...]) -> None:
        """Finish the present edge, then go `ahead`; a way of no length takes a moment, too."""
        if self._way:
            self._way = (self._way[0], *ahead)
            return
        self._way = ahead
        self.next_change_us = now_us + (self._edge_us if ahead else 1)
