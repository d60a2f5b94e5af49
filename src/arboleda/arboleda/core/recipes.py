"""Order -> tree, one function per recipe, each made of the same few idioms.

A recipe is a Selector with memory over its work and its recovery: once the work has failed, the
recovery runs to its end. Recovered is not delivered: the task has failed all the same.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

from py_trees import composites
from py_trees.behaviour import Behaviour

from . import zone_plan
from .context import Context
from .leaves import Act, Announce, Await, Carry, Dwell, LeaveZones, Piece, Require, TakeZones, Unless
from .messages import Failure, FollowPath, MoveJoints, Reason, SetEffector, SystemStart
from .model import Path, Pose
from .sentence import Phrase
from .task import Order, Recipe

MAIN, RECOVERY = PHASES = ("main", "recovery")
UNENDED = Phrase("recovery.unended", "{arm} had commands that did not end")
NOT_AT_START = Phrase(
    "path.not_at_start", "{mobile} stands on node {node}, path {path} starts at node {start}"
)
PART_LOST = Phrase("part.lost", "{arm}: the part was lost on the way")
NO_PIECE = Phrase("part.none", "{arm}: no piece at {pose}")
NOT_GRIPPED = Phrase("part.not_gripped", "{arm}: the piece at {pose} was not gripped")
SETTLE_S = 1.0  # after the last stop was confirmed or given up
Visit = tuple[Pose, list[Behaviour]]  # a pose of the arm, and the work to do there
Recipes = Mapping[Recipe, Callable[[Order, Context], Behaviour]]


def build(order: Order, context: Context) -> Behaviour:
    """The tree that carries out `order` in the context's cell."""
    return RECIPES[order.recipe](order, context)


def storage(order: Order, context: Context) -> Behaviour:
    """Drive the mobile, pick the part up, put it into its station, go home."""
    assert order.path is not None and order.station is not None
    cell, station = context.cell, order.station
    pickup = context.back = cell.pickup_of(order.path)
    way = zone_plan.storage_way(cell, pickup, station, context.standing())
    visits: list[Visit] = [
        (pickup, _grip(context, pickup)),
        (station, _let_go(context, station)),
        (cell.home, []),
    ]
    work = [_start(context), *_drive(context, order.path), *_visit(context, way, visits)]
    return _recovering(Recipe.STORAGE, work, context)


def palletizing(order: Order, context: Context) -> Behaviour:
    """Home, pick, place: the arm alone."""
    cell = context.cell
    pick, place = cell.palletizing.pick, cell.palletizing.place
    context.back = cell.pickup
    way = zone_plan.palletizing_way(cell, context.standing())
    visits: list[Visit] = [(cell.home, []), (pick, _grip(context, pick)), (place, _let_go(context, place))]
    return _recovering(Recipe.PALLETIZING, [_start(context), *_visit(context, way, visits)], context)


RECIPES: Recipes = {
    Recipe.STORAGE: storage,
    Recipe.PALLETIZING: palletizing,
}


def recovery(context: Context) -> Behaviour:
    """Wait until all has come to rest; carry a part that is held back to the pick-up pose; go home."""
    cell, context.back = context.cell, context.way_back()
    back = _sequence("carry back", *_at(context, context.back, _effector(context, False)))
    shares = cell.zones
    return _sequence(
        RECOVERY,
        _settle(context),
        *_rise(context),
        *([TakeZones("take zones", context, context.recovery_zones, inside=True)] if shares else []),
        _selector("part back", Unless("holds nothing", lambda: not context.holding()), back),
        _move(context, cell.home.name, cell.home.q),
        *([LeaveZones("leave zones", context)] if shares else []),
    )


def _recovering(recipe: Recipe, work: list[Behaviour], context: Context) -> Behaviour:
    return _selector(recipe.value, _sequence(MAIN, *work), recovery(context))


def _sequence(name: str, *children: Behaviour) -> Behaviour:
    return composites.Sequence(name, memory=True, children=list(children))


def _selector(name: str, *children: Behaviour) -> Behaviour:
    return composites.Selector(name, memory=True, children=list(children))


def _start(context: Context) -> Behaviour:
    announce = Announce("announce", context, SystemStart(cell=context.cell.name))
    return _sequence("system start", announce, Dwell("dwell", context, context.timing.dwell_s))


def _rise(context: Context) -> list[Behaviour]:
    """Where poses have an approach height, an arm that may stand low goes straight up first."""
    if not any(pose.above for pose in context.cell.poses):
        return []

    def make(id: str) -> MoveJoints:
        return MoveJoints(id=id, robot=context.cell.arm.name, q=context.risen())

    return [Act("rise", context, make, "rising")]


def _settle(context: Context) -> Behaviour:
    arm = context.cell.arm.name

    def settled() -> bool:
        return not context.open_commands() and context.obstacle(arm) is None

    def unsettled() -> Failure:
        failure = context.obstacle(arm, was=True)
        return failure or Failure(reason=Reason.STOP_UNCONFIRMED, sentence=UNENDED(arm=arm))

    return Await("settle", context, settled, context.timing.stop_timeout_s + SETTLE_S, unsettled)


def _drive(context: Context, path: Path) -> list[Behaviour]:
    start = path.nodes[0]
    follow = _follow(context, f"drive path {path.code}", path.nodes, whole=True)
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
    sentence = NOT_AT_START(mobile=mobile, node=_named(context.node()), path=path.code, start=start)
    return Failure(reason=Reason.REJECTED, sentence=sentence)


def _named(node: int | None) -> int | str:
    return "?" if node is None else node


def _follow(context: Context, name: str, nodes: tuple[int, ...], *, whole: bool = False) -> Behaviour:
    """Drive over nodes; given anew after a hold or a failure, only over what remains of them.

    `whole`: given for the first time all of them, as the robot stands where they begin: the last node that
    it told may be older than the end of its last drive, and a round trip comes by there once more.
    """
    mobile = context.cell.mobile.name
    doing = name.replace("drive", "driving", 1)

    def all_of_it(id: str) -> FollowPath:
        return FollowPath(id=id, robot=mobile, nodes=nodes)

    def rest_of_it(id: str) -> FollowPath:
        node = context.node()
        rest = nodes[nodes.index(node) :] if node in nodes else nodes
        return FollowPath(id=id, robot=mobile, nodes=rest)

    return Act(name, context, all_of_it if whole else rest_of_it, doing, anew=rest_of_it)


def _visit(context: Context, way: Sequence[Pose], visits: list[Visit]) -> list[Behaviour]:
    """Go from pose to pose and work there, holding the shared zones of each leg of the way."""
    legs = zone_plan.plan(context.cell, way, context.way_back()) if context.cell.zones else []
    steps: list[Behaviour] = []
    for index, (pose, work) in enumerate(visits):
        steps += [_take(context, leg.zones) for leg in legs if leg.start == index and leg.zones]
        steps += _at(context, pose, *work)
        steps += [LeaveZones("leave zones", context) for leg in legs if leg.end == index + 1 and leg.zones]
    return steps


def _take(context: Context, zones: frozenset[str]) -> Behaviour:
    return TakeZones("take zones", context, lambda: zones)


def _at(context: Context, pose: Pose, *work: Behaviour) -> list[Behaviour]:
    """Go to a pose, do the work there and, where the pose has an approach height, come back up."""
    go = _move(context, pose.name, pose.q)
    if pose.above is None:
        return [go, *work]
    above = partial(_move, context, f"above {pose.name}", pose.above)
    return [above(), go, *work, above()]


def _move(context: Context, where: str, q: tuple[float, ...]) -> Behaviour:
    make = partial(MoveJoints, robot=context.cell.arm.name, q=q)
    return Act(f"move to {where}", context, make, f"moving to {where}", guard=partial(_part_lost, context))


def _part_lost(context: Context) -> Failure | None:
    """The part left an effector that holds it while it was carried."""
    if not context.cell.piece_check or not context.carried or context.piece(0.0) is not False:
        return None
    sentence = PART_LOST(arm=context.cell.arm.name)
    return Failure(reason=Reason.PART_LOST, sentence=sentence)


def _effector(context: Context, on: bool, then: Callable[[], None] | None = None) -> Behaviour:
    arm, word = context.cell.arm.name, "on" if on else "off"
    make, doing = partial(SetEffector, robot=arm, on=on), f"switching the effector {word}"
    act = Act("switch", context, make, doing, then=then)
    return _sequence(f"effector {word}", act, Dwell("dwell", context, context.timing.dwell_s))


def _grip(context: Context, pose: Pose) -> list[Behaviour]:
    """Effector on, checked before and after where the cell checks pieces."""
    on = _effector(context, True)
    if not context.cell.piece_check:
        return [on]
    arm, retry, wait_s = context.cell.arm.name, context.cell.retry, context.timing.piece_wait_s
    none = Failure(reason=Reason.NO_PIECE, sentence=NO_PIECE(arm=arm, pose=pose.name))
    patience_s = wait_s + retry.times * (retry.backoff_s + wait_s)  # to try again is to wait again
    attempts = [_attempt(context, pose, number) for number in range(retry.times + 1)]
    return [
        Piece("piece there", context, patience_s, none),
        _selector("grip", *attempts),
        Carry("carry", context, True),
    ]


def _attempt(context: Context, pose: Pose, number: int) -> Behaviour:
    """Effector on and the piece seen in it; a later attempt opens the effector first."""
    arm, retry = context.cell.arm.name, context.cell.retry
    missed = Failure(reason=Reason.NOT_GRIPPED, sentence=NOT_GRIPPED(arm=arm, pose=pose.name))
    final = number == retry.times
    seen = Piece("piece gripped", context, context.timing.piece_wait_s, missed, final=final)
    return _sequence(
        f"try {number + 1}", *(_again(context) if number else []), _effector(context, True), seen
    )


def _again(context: Context) -> list[Behaviour]:
    """What a further attempt begins with; there is none after another failure than a missed grip."""
    only_missed = Unless("only missed", lambda: context.failure is None)
    return [only_missed, _effector(context, False), Dwell("back-off", context, context.cell.retry.backoff_s)]


def _let_go(context: Context, pose: Pose) -> list[Behaviour]:
    off = _effector(context, False, then=partial(context.store, pose))
    return [Carry("arrived", context, False), off] if context.cell.piece_check else [off]
