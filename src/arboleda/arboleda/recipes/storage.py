"""What a cell with an arm, a mobile robot and a rack offers: to store a part, and the arm's own cycle."""

from __future__ import annotations

from collections.abc import Sequence

from py_trees.behaviour import Behaviour

from arboleda.kinds.mobile import FollowPath
from arboleda.model.messages import Failure, Reason
from arboleda.model.plant_model import Cell, Path, Pose
from arboleda.model.recipe import Parameter, Recipe
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.task import Order
from arboleda.recipes.storage_layout import PALLETIZING as PALLETIZING_TARGETS
from arboleda.recipes.storage_layout import StorageLayout
from arboleda.trees import steps, zone_plan
from arboleda.trees.context import Context
from arboleda.trees.leaves import Act, Require

STORING = Phrase("step.storage", "storage")
CYCLE = Phrase("step.palletizing", "palletizing")
AT_START = Phrase("step.at_start", "at start")
DRIVE = Phrase("step.drive", "drive path {path}")
DRIVING = Phrase("doing.drive", "driving path {path}")
DRIVE_TO = Phrase("step.drive_to", "drive to node {node}")
DRIVING_TO = Phrase("doing.drive_to", "driving to node {node}")
NOT_AT_START = Phrase(
    "path.not_at_start", "{mobile} stands on node {node}, path {path} starts at node {start}"
)
PATH = Phrase("text.path", "path")
ARM = Phrase("text.arm", "arm")
STATION = Phrase("text.station", "station")


def storage(order: Order, context: Context) -> Behaviour:
    """Drive the mobile, pick the part up, put it into its station, go home."""
    path, station = order.values["path"], order.values["station"]
    cell = StorageLayout(context.cell)
    arm, check = cell.arm.name, context.cell.piece_check
    pickup = cell.pickup_of(path)
    context.parts.set_origin(arm, pickup)
    way = storage_way(cell, pickup, station, context.robots.standing(arm))
    visits = [
        (pickup, steps.grip(context, arm, pickup, check=check)),
        (station, steps.let_go(context, arm, station, check=check)),
        (cell.home, []),
    ]
    work = [*_drive(context, path), *steps.visit(context, arm, way, visits)]
    return steps.task(STORING(), work, context)


def palletizing(order: Order, context: Context) -> Behaviour:
    """Home, pick, place: the arm alone."""
    cell = StorageLayout(context.cell)
    arm, check = cell.arm.name, context.cell.piece_check
    pick, place = cell.palletizing.pick, cell.palletizing.place
    context.parts.set_origin(arm, cell.pickup)
    way = palletizing_way(cell, context.robots.standing(arm))
    visits = [
        (cell.home, []),
        (pick, steps.grip(context, arm, pick, check=check)),
        (place, steps.let_go(context, arm, place, check=check)),
    ]
    return steps.task(CYCLE(), steps.visit(context, arm, way, visits), context)


def storage_way(cell: StorageLayout, pickup: Pose, station: Pose, start: Pose) -> tuple[Pose, ...]:
    """The poses of the storage recipe for an arm that stands at `start`."""
    return (start, pickup, station, cell.home)


def palletizing_way(cell: StorageLayout, start: Pose) -> tuple[Pose, ...]:
    """The poses of the palletizing recipe for an arm that stands at `start`; it stays at the last one."""
    return (start, cell.home, cell.palletizing.pick, cell.palletizing.place)


def plan_problems(cell: Cell) -> dict[str, str]:
    """Problems of planning the arm's own cycle: a sentence by the name of the pose that is in the way."""
    if PALLETIZING_TARGETS not in cell.groups:
        return {}
    place = StorageLayout(cell).palletizing.place
    rule = "palletizing ends and waits there, so it must be outside all zones"
    return {place.name: f"cell {cell.name}: {zone_plan.lying(place)}; {rule}"} if place.zones else {}


def _codes(cell: Cell) -> Sequence[str]:
    return list(cell.paths)


def _path(cell: Cell, code: str) -> Path:
    return cell.paths[code]


def _numbers(cell: Cell) -> Sequence[str]:
    return [str(number) for number in range(len(cell.stations))]


def _station(cell: Cell, number: str) -> Pose:
    return cell.stations[int(number)]


STORAGE = Recipe(
    name="storage",
    build=storage,
    parameters=(
        Parameter(name="path", words=_codes, value=_path, called=PATH),
        Parameter(name="station", words=_numbers, value=_station, called=STATION),
    ),
    is_default=True,
)
PALLETIZING = Recipe(
    name="palletizing", build=palletizing, alone="arm", alone_called=ARM, part_from=PALLETIZING_TARGETS
)
RECIPES = (STORAGE, PALLETIZING)


def only_stores(cell: Cell) -> bool:
    """True if a cell offers nothing but these recipes."""
    return bool(cell.recipes) and {*cell.recipes} <= {*RECIPES}


def _drive(context: Context, path: Path) -> list[Behaviour]:
    cell, start = StorageLayout(context.cell), path.nodes[0]
    code = path.code
    follow = _follow(context, DRIVE(path=code), DRIVING(path=code), path.nodes, whole=True)
    known = _node(context)
    if known is None or known == start:
        return [follow]
    if not context.cell.drive_to_start:
        return [Require(AT_START(), context.failures, lambda: _not_at_start(context, path)), follow]
    way = cell.mobile.grid.route(known, start)
    return [_follow(context, DRIVE_TO(node=start), DRIVING_TO(node=start), way), follow]


def _node(context: Context) -> int | None:
    known = context.robots.position(StorageLayout(context.cell).mobile.name)
    return known if isinstance(known, int) else None


def _not_at_start(context: Context, path: Path) -> Failure | None:
    start, mobile, known = path.nodes[0], StorageLayout(context.cell).mobile.name, _node(context)
    if known == start:
        return None
    node = "?" if known is None else known
    sentence = NOT_AT_START(mobile=mobile, node=node, path=path.code, start=start)
    return Failure(reason=Reason.REJECTED, sentence=sentence)


def _follow(
    context: Context, title: Sentence, doing: Sentence, nodes: tuple[int, ...], *, whole: bool = False
) -> Behaviour:
    """Drive over nodes; given anew after a hold or a failure, only over what remains of them.

    A robot that stands on none of them by then, as one that lied of its node or was carried away, is led from
    there where the cell drives to starts: straight to the last node, or, where all of them are to be driven,
    to the first one.

    `whole`: given for the first time all of them, as the robot stands where they begin: the last node that
    it told may be older than the end of its last drive, and a round trip comes by there once more.
    """
    cell = StorageLayout(context.cell)
    mobile = cell.mobile

    def all_of_it(id: str) -> FollowPath:
        return FollowPath(id=id, robot=mobile.name, nodes=nodes)

    def rest_of_it(id: str) -> FollowPath:
        known = _node(context)
        if known in nodes:
            rest = nodes[nodes.index(known) :]
        elif known is None or not context.cell.drive_to_start:
            rest = nodes
        elif whole:
            rest = (*mobile.grid.route(known, nodes[0]), *nodes[1:])
        else:
            rest = mobile.grid.route(known, nodes[-1])
        return FollowPath(id=id, robot=mobile.name, nodes=rest)

    return Act(title, context, all_of_it if whole else rest_of_it, doing, anew=rest_of_it)
