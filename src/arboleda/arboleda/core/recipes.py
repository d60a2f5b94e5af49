"""Order -> tree, one function per recipe, each made of the same few idioms."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from py_trees.behaviour import Behaviour
from py_trees.composites import Sequence

from .leaves import Act, Announce, Context, Dwell, Require
from .messages import Failure, FollowPath, MoveJoints, Reason, SetEffector, SystemStart
from .model import Path, Pose
from .task import Order, Recipe


def build(order: Order, context: Context) -> Behaviour:
    """The tree that carries out `order` in the context's cell."""
    return RECIPES[order.recipe](order, context)


def storage(order: Order, context: Context) -> Behaviour:
    """Drive the mobile, pick the part up, put it into its station, go home."""
    assert order.path is not None and order.station is not None
    cell = context.cell
    return _sequence(
        "storage",
        _start(context),
        *_drive(context, order.path),
        *_pick(context, cell.pickup),
        *_place(context, order.station),
        _move(context, cell.home),
    )


def palletizing(order: Order, context: Context) -> Behaviour:
    """Home, pick, place: the arm alone."""
    cell = context.cell
    return _sequence(
        "palletizing",
        _start(context),
        _move(context, cell.home),
        *_pick(context, cell.palletizing.pick),
        *_place(context, cell.palletizing.place),
    )


RECIPES: dict[Recipe, Callable[[Order, Context], Behaviour]] = {
    Recipe.STORAGE: storage,
    Recipe.PALLETIZING: palletizing,
}


def _sequence(name: str, *children: Behaviour) -> Sequence:
    return Sequence(name, memory=True, children=list(children))


def _start(context: Context) -> Behaviour:
    announce = Announce("announce", context, SystemStart(cell=context.cell.name))
    return _sequence("system start", announce, Dwell("dwell", context, context.dwell_s))


def _drive(context: Context, path: Path) -> list[Behaviour]:
    start = path.nodes[0]
    follow = _follow(context, f"drive path {path.code}", path.nodes)
    known = context.node()
    if known is None or known == start:
        return [follow]
    if not context.cell.drive_to_start:
        return [Require("at start", context, lambda: _not_at_start(context, path)), follow]
    way = context.cell.mobile.grid.route(known, start)
    return [_follow(context, f"drive to node {start}", way), follow]


def _not_at_start(context: Context, path: Path) -> Failure | None:
    start, mobile = path.nodes[0], context.cell.mobile.name
    if context.node() == start:
        return None
    sentence = f"{mobile} stands on node {context.node()}, path {path.code} starts at node {start}"
    return Failure(reason=Reason.REJECTED, sentence=sentence)


def _follow(context: Context, name: str, nodes: tuple[int, ...]) -> Behaviour:
    mobile = context.cell.mobile.name
    doing = name.replace("drive", "driving", 1)
    return Act(name, context, partial(FollowPath, robot=mobile, nodes=nodes), doing)


def _move(context: Context, pose: Pose, *, above: bool = False) -> Behaviour:
    arm, target = context.cell.arm.name, pose.above if above and pose.above else pose.q
    where = f"above {pose.name}" if above else pose.name
    return Act(f"move to {where}", context, partial(MoveJoints, robot=arm, q=target), f"moving to {where}")


def _effector(context: Context, on: bool) -> Behaviour:
    arm, word = context.cell.arm.name, "on" if on else "off"
    act = Act("switch", context, partial(SetEffector, robot=arm, on=on), f"switching the effector {word}")
    return _sequence(f"effector {word}", act, Dwell("dwell", context, context.dwell_s))


def _at(context: Context, pose: Pose, *work: Behaviour) -> list[Behaviour]:
    """Go to a pose, do the work there and, where the pose has an approach height, come back up."""
    if pose.above is None:
        return [_move(context, pose), *work]
    return [
        _move(context, pose, above=True),
        _move(context, pose),
        *work,
        _move(context, pose, above=True),
    ]


def _pick(context: Context, pose: Pose) -> list[Behaviour]:
    return _at(context, pose, _effector(context, True))


def _place(context: Context, pose: Pose) -> list[Behaviour]:
    return _at(context, pose, _effector(context, False))
