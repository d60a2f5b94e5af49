"""Snapshot streams of py_trees_ros, which `py-trees-tree-watcher` and similar tools request.

Only this module imports py_trees_ros_interfaces, which few have.
"""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

from diagnostic_msgs.msg import KeyValue
from py_trees_ros_interfaces.msg import Behaviour, BehaviourTree, SnapshotStreamParameters
from py_trees_ros_interfaces.srv import CloseSnapshotStream, OpenSnapshotStream, ReconfigureSnapshotStream
from rclpy.node import Node
from rclpy.publisher import Publisher
from unique_identifier_msgs.msg import UUID

from arboleda_ros import py_trees_tree, qos

MOST = 20  # streams at a time
DESERTED_S = 60.0  # life of a stream without listeners
NEARLY = 0.98  # of a period: snapshots come when they come
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}", re.ASCII)
Cell = Mapping[str, Any]


class SnapshotStreams:
    """Streams of all cells, on the executor's thread.

    The plant's thread calls `show`, which leaves its news for the other thread.
    """

    def __init__(self, node: Node, cells: Iterable[str], clock: Callable[[], float]) -> None:
        self._node = node
        self._clock = clock
        self._streams: dict[str, _Stream] = {}  # by topic
        self._trees: dict[str, list[py_trees_tree.Row]] = {}  # by cell: the one that it ran last
        self._news: deque[list[Cell]] = deque(maxlen=1)
        self._number = 0
        for cell in cells:
            at = f"{cell}/tree/snapshot_streams"
            node.create_service(OpenSnapshotStream, f"{at}/open", partial(self._open, cell))
            node.create_service(CloseSnapshotStream, f"{at}/close", self._close)
            node.create_service(ReconfigureSnapshotStream, f"{at}/reconfigure", self._reconfigure)

    @property
    def watched(self) -> bool:
        """True if there is a stream."""
        return bool(self._streams)

    def show(self, snapshot: Mapping[str, Any]) -> None:
        executor = self._node.executor
        if self._streams and executor is not None:
            self._news.append(list(snapshot["cells"]))
            executor.create_task(self._publish)

    def _publish(self) -> None:
        cells = {cell["name"]: cell for cell in (self._news.popleft() if self._news else ())}
        now = self._clock()
        for stream in [each for each in self._streams.values() if each.cell in cells]:
            cell = cells[stream.cell]
            if cell["tree"]:
                self._trees[stream.cell] = cell["tree"]
            known = self._trees.get(stream.cell, py_trees_tree.NONE_YET)
            stream.show(cell, cell["tree"] or py_trees_tree.idle(known), now)
            if stream.is_deserted(now):
                self._end(stream)

    def _open(
        self, cell: str, request: OpenSnapshotStream.Request, response: OpenSnapshotStream.Response
    ) -> OpenSnapshotStream.Response:
        """Open a stream on a topic of its own, and return the topic; "" if there are too many streams.

        A requested name is used if it is one word.
        """
        if len(self._streams) >= MOST:
            return response
        wish = request.topic_name.rpartition("/")[2]
        self._number += 1
        name = wish if NAME.fullmatch(wish) else f"_snapshots_{self._number}"
        topic = self._node.resolve_topic_name(f"{cell}/tree/snapshot_streams/{name}")
        if topic not in self._streams:
            publisher = self._node.create_publisher(BehaviourTree, topic, qos.VIEW)
            self._streams[topic] = _Stream(cell, publisher, self._node, self._clock())
        self._streams[topic].parameters = request.parameters
        response.topic_name = topic
        return response

    def _close(
        self, request: CloseSnapshotStream.Request, response: CloseSnapshotStream.Response
    ) -> CloseSnapshotStream.Response:
        stream = self._streams.get(request.topic_name)
        if stream is not None:
            self._end(stream)
        response.result = stream is not None
        return response

    def _reconfigure(
        self, request: ReconfigureSnapshotStream.Request, response: ReconfigureSnapshotStream.Response
    ) -> ReconfigureSnapshotStream.Response:
        stream = self._streams.get(request.topic_name)
        if stream is not None:
            stream.parameters = request.parameters
        response.result = stream is not None
        return response

    def _end(self, stream: _Stream) -> None:
        del self._streams[stream.topic]
        self._node.destroy_publisher(stream.publisher)


class _Stream:
    """Topic on which a cell's tree is shown."""

    def __init__(self, cell: str, publisher: Publisher, node: Node, now: float) -> None:
        self.cell = cell
        self.publisher = publisher
        self.topic = str(publisher.topic_name)
        self.parameters = SnapshotStreamParameters(snapshot_period=math.inf)
        self._node = node
        self._shown: list[py_trees_tree.Behaviour] = []
        self._shown_at = -math.inf
        self._listened_at = now
        self._count = 0

    def is_deserted(self, now: float) -> bool:
        if self.publisher.get_subscription_count():
            self._listened_at = now
        return now - self._listened_at > DESERTED_S

    def show(self, cell: Cell, rows: Iterable[py_trees_tree.Row], now: float) -> None:
        """Publish the tree if it has changed, or if its period is over."""
        tree = py_trees_tree.behaviours(self.cell, list(rows))
        changed = tree != self._shown
        if not changed and not now - self._shown_at >= NEARLY * self.parameters.snapshot_period:
            return
        self._shown, self._shown_at = tree, now
        self._count += 1
        message = BehaviourTree(behaviours=[_message(each) for each in tree], changed=changed)
        message.statistics.count = self._count
        message.statistics.stamp = self._node.get_clock().now().to_msg()
        if self.parameters.blackboard_data:
            known = py_trees_tree.variables(cell)
            message.blackboard_on_visited_path = [KeyValue(key=key, value=value) for key, value in known]
        self.publisher.publish(message)


def _message(node: py_trees_tree.Behaviour) -> Behaviour:
    return Behaviour(
        name=node.name,
        class_name=node.class_name,
        own_id=_id(node.own_id),
        parent_id=_id(node.parent_id),
        tip_id=_id(node.tip_id),
        child_ids=[_id(child) for child in node.child_ids],
        current_child_id=_id(node.current_child_id),
        type=node.type,
        blackbox_level=py_trees_tree.NOT_A_BLACKBOX,
        status=node.status,
        message=node.message,
        is_active=node.is_active,
    )


def _id(bytes_of_it: bytes) -> UUID:
    return UUID(uuid=list(bytes_of_it))
