"""Steps of a robot that drives over the paths of its cell, node by node."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from arboleda.model.commands import Command
from arboleda.model.messages import Failure, Reason
from arboleda.model.plant_model import Path
from arboleda.model.sentence import Phrase

from .context import Context
from .leaves import Act, Approach, Require

AT_START = Phrase("step.at_start", "at start")
DRIVE = Phrase("step.drive", "drive path {path}")
DRIVING = Phrase("doing.drive", "driving path {path}")
AT_NODE = Phrase("step.at_node", "be at node {node}")
DRIVING_TO = Phrase("doing.drive_to", "driving to node {node}")
NOT_AT_START = Phrase(
    "path.not_at_start", "{mobile} stands on node {node}, path {path} starts at node {start}"
)


def follow(context: Context, robot: str, path: Path) -> list[Behaviour]:
    """Drive to the start of a path, where the cell allows that, and over the path.

    A drive that is given anew, after a hold or a failure, leads over the remaining nodes alone. A robot that
    is on none of the nodes by then, as it was carried away, drives to the first one where the cell allows
    that.
    """
    code, start = path.code, path.nodes[0]
    device = context.cell.reach[robot].robot

    def known() -> int | None:
        node = context.robots.position(robot)
        return node if isinstance(node, int) else None

    def whole(id: str) -> Command:
        # The last reported node may be older than the end of the last drive, and a round trip comes by its
        # start once more: so the first time all nodes are given, whatever was reported.
        return device.go(id=id, way=path.nodes)

    def rest(id: str) -> Command:
        node, nodes = known(), path.nodes
        if node in nodes:
            return device.go(id=id, way=nodes[nodes.index(node) :])
        if node is None or not context.cell.drive_to_start:
            return device.go(id=id, way=nodes)
        return device.go(id=id, way=(*device.motion.route(node, start), *nodes[1:]))

    def to_start(id: str) -> Command:
        return device.go(id=id, way=device.motion.route(known(), start))

    def is_at_start() -> bool:
        return known() in (None, start)

    def objection() -> Failure | None:
        if is_at_start():
            return None
        node = "?" if (here := known()) is None else here
        sentence = NOT_AT_START(mobile=robot, node=node, path=code, start=start)
        return Failure(reason=Reason.REJECTED, sentence=sentence)

    drive = Act(DRIVE(path=code), context, whole, DRIVING(path=code), anew=rest)
    if not context.cell.drive_to_start:
        return [Require(AT_START(), context.failures, objection), drive]
    there = Approach(AT_NODE(node=start), context, to_start, DRIVING_TO(node=start))
    there.is_there = lambda: is_at_start() and not context.robots.is_out_of_sight(robot)
    return [there, drive]
