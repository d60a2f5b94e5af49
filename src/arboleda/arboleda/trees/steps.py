"""Steps that recipes are made of: a visit, a switched effector, shared zones, and the recovery.

A task is a Selector with memory over its work and its recovery. Once the work has failed, the recovery runs
to its end, and the task has failed all the same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from py_trees import common, composites
from py_trees.behaviour import Behaviour

from arboleda.model import zone_plan
from arboleda.model.commands import Command
from arboleda.model.messages import Check, Failure, Reason, SystemStart
from arboleda.model.plant_model import PieceCheck, Pose
from arboleda.model.sentence import Phrase, Sentence

from . import parts
from .context import Context
from .leaves import (
    Act,
    Announce,
    Approach,
    Await,
    Carry,
    Dwell,
    LeaveDevices,
    LeaveZones,
    Note,
    Piece,
    Require,
    TakeDevices,
    TakeZones,
    Unless,
    titled,
)

MAIN, RECOVERY = PHASES = ("main", "recovery")
"""The name of a part of a task's tree: its work, and its recovery."""
TITLES = {name: Phrase(f"step.{name}", name) for name in PHASES}
ANNOUNCE = Phrase("step.announce", "announce")
SYSTEM_START = Phrase("step.system_start", "system start")
DWELL = Phrase("step.dwell", "dwell")
SETTLE = Phrase("step.settle", "settle")
RISE = Phrase("step.rise", "rise")
RISING = Phrase("doing.rise", "rising")
ALL_HOME = Phrase("step.all_home", "all go home")
HOME_AGAIN = Phrase("step.home_again", "{arm} goes home")
CARRY_BACK = Phrase("step.carry_back", "carry back")
PART_BACK = Phrase("step.part_back", "part back")
HOLDS_NOTHING = Phrase("step.holds_nothing", "holds nothing")
LETS_GO_OF_NOTHING = Phrase("step.lets_go_of_nothing", "lets go of nothing")
LET_GO_FIRST = Phrase("step.let_go_first", "end letting go")
TAKE_ZONES = Phrase("step.take_zones", "take zones")
LEAVE_ZONES = Phrase("step.leave_zones", "leave zones")
TAKE_DEVICES = Phrase("step.take_devices", "take {devices}")
LEAVE_DEVICES = Phrase("step.leave_devices", "give back {devices}")
AT_HOME = Phrase("step.at_home", "at home")
GO_HOME = Phrase("step.go_home", "go home")
EMPTY = Phrase("step.empty", "holds no part")
PART_LEFT = Phrase(
    "device.part_left",
    "{device} may still hold a part after its last step, and no other cell would know whose that is",
)
NOT_OURS = Phrase("step.not_ours", "another cell may have {robot}")
MOVE = Phrase("step.move", "move to {pose}")
MOVING = Phrase("doing.move", "moving to {pose}")
MOVE_ABOVE = Phrase("step.move_above", "move to above {pose}")
MOVING_ABOVE = Phrase("doing.move_above", "moving to above {pose}")
SWITCH = Phrase("step.switch", "switch")
EFFECTOR_ON = Phrase("step.effector_on", "effector on")
EFFECTOR_OFF = Phrase("step.effector_off", "effector off")
HAND_ON = Phrase("step.hand_on", "{device} grips")
HAND_OFF = Phrase("step.hand_off", "{device} lets go")
GRIPPING = Phrase("doing.grip_by", "gripping with {device}")
LETTING_GO = Phrase("doing.let_go_by", "letting go with {device}")
SWITCHING_ON = Phrase("doing.switch_on", "switching the effector on")
SWITCHING_OFF = Phrase("doing.switch_off", "switching the effector off")
PIECE_THERE = Phrase("step.piece_there", "piece there")
PIECE_GRIPPED = Phrase("step.piece_gripped", "piece gripped")
PIECE_BROUGHT = Phrase("step.piece_brought", "piece brought")
GRIP = Phrase("step.grip", "grip")
TRY = Phrase("step.try", "try {number}")
ONLY_MISSED = Phrase("step.only_missed", "only missed")
BACK_OFF = Phrase("step.back_off", "back-off")
CARRY = Phrase("step.carry", "carry")
NOTE_ORIGIN = Phrase("step.note_origin", "note where parts come from")
OVER = Phrase("step.over", "over the place")
NO_APPROACH = Phrase("step.no_approach", "no approach")
GO_BACK = Phrase("step.go_back", "go back to where it was taken")
GOING_BACK = Phrase("doing.go_back", "going back to where it was taken")
GO_OVER = Phrase("step.go_over", "go over where it was taken")
GOING_OVER = Phrase("doing.go_over", "going over where it was taken")
ARRIVED = Phrase("step.arrived", "arrived")
UNENDED = Phrase("recovery.unended", "{arm} had commands that did not end")
NO_PIECE = Phrase("part.none", "{arm}: no piece at {pose}")
NOT_GRIPPED = Phrase("part.not_gripped", "{arm}: the piece at {pose} was not gripped")
SETTLE_S = 1.0  # after the last stop was confirmed or given up
Visit = tuple[Pose, list[Behaviour]]  # a pose of a robot, and the work to do there


def task(
    title: Sentence | str, work: list[Behaviour], context: Context, *, notes_origins: bool = False
) -> Behaviour:
    """The announced work of a task, and its recovery.

    `notes_origins`: only the work shows where a part comes from, so the recovery looks that up when it
    begins.
    """
    back = recovery(context, notes_origins=notes_origins)
    return selector(title, sequence(TITLES[MAIN](), start(context), *work), back)


def recovery(context: Context, *, notes_origins: bool = False) -> Behaviour:
    """Wait until all robots rest, carry held parts back to where they came from, and go home.

    Several robots go independently of each other: one may wait for a zone that another robot is still in.
    """
    robots = tuple(context.cell.workspaces)
    settle = _settle(context, robots)
    routes = [_way_home_if_ours(context, robot, notes_origins=notes_origins) for robot in robots]
    if len(routes) < 2:
        return sequence(TITLES[RECOVERY](), settle, *(step for route in routes for step in route))
    policy = common.ParallelPolicy.SuccessOnAll(synchronise=True)
    each = [sequence(HOME_AGAIN(arm=robot), *route) for robot, route in zip(robots, routes, strict=True)]
    together = composites.Parallel(str(ALL_HOME()), policy=policy, children=each)
    return sequence(TITLES[RECOVERY](), settle, titled(together, ALL_HOME()))


def sequence(title: Sentence | str, *children: Behaviour) -> Behaviour:
    """The steps one after the other, until one fails; where it was is kept from tick to tick."""
    return titled(composites.Sequence(str(title), memory=True, children=list(children)), title)


def selector(title: Sentence | str, *children: Behaviour) -> Behaviour:
    """The steps one after the other, until one succeeds; where it was is kept from tick to tick."""
    return titled(composites.Selector(str(title), memory=True, children=list(children)), title)


def framed(node: Behaviour) -> Behaviour:
    """A node that only says when others run, so that screens name the step in it."""
    node.frame = True  # type: ignore[attr-defined]
    return node


def is_frame(node: Behaviour) -> bool:
    """True for a node of `framed`."""
    return getattr(node, "frame", False)


def start(context: Context) -> Behaviour:
    """Tell that a task starts."""
    announce = Announce(ANNOUNCE(), context, SystemStart(cell=context.cell.name))
    return sequence(SYSTEM_START(), announce, Dwell(DWELL(), context.time, context.timing.dwell_s))


def tour(context: Context, robot: str, visits: Sequence[Visit]) -> list[Behaviour]:
    """Go from pose to pose and work there, holding the shared zones of each leg of the way.

    Each leg is planned when it begins, from where the robot stands; the way ends outside all zones.
    """
    space, poses = context.cell.reach[robot], [pose for pose, _ in visits]
    legs = zone_plan.plan(space, (space.home, *poses), None) if space.zones else []
    steps: list[Behaviour] = []
    for index, (pose, work) in enumerate(visits):
        begins = [number for number, leg in enumerate(legs) if leg.start == index]
        needed = [partial(_zones_of_leg, context, robot, poses, number) for number in begins]
        steps += [TakeZones(TAKE_ZONES(), context, robot, zones) for zones in needed]
        steps += _rise_first(context, robot, pose) if index == 0 else []
        steps += _at(context, robot, pose, *work)
        ends = [leg for leg in legs if leg.end == index + 1]
        steps += [LeaveZones(LEAVE_ZONES(), context, robot) for _ in ends]
    return steps


def _zones_of_leg(context: Context, robot: str, poses: Sequence[Pose], number: int) -> frozenset[str]:
    """The zones of a leg of a tour; the first leg begins where the robot stands."""
    space = context.cell.reach[robot]
    route = (context.robots.standing(robot) if number == 0 else space.home, *poses)
    return zone_plan.plan(space, route, context.parts.way_back(robot))[number].zones


def visit_from_anywhere(
    context: Context, robot: str, pose: Pose, work: Sequence[Behaviour]
) -> list[Behaviour]:
    """Go to a pose and work there, planned when the visit begins, from where the robot stands.

    A visit begins and ends outside all zones: from a pose that lies in a zone the robot goes home. So no
    robot waits for zones while it holds others, whatever steps come before and after.
    """
    space = context.cell.reach[robot]
    origin = Note(NOTE_ORIGIN(), partial(context.parts.note_origin, robot, pose))
    steps = [*_rise_first(context, robot, pose), *_at(context, robot, pose, origin, *work)]
    if not space.zones:
        return steps

    def needed() -> frozenset[str]:
        route = (context.robots.standing(robot), pose, *((space.home,) if pose.zones else ()))
        legs = zone_plan.plan(space, route, context.parts.way_back(robot))
        return context.zones.needs.between(robot, pose).union(*(leg.zones for leg in legs))

    out = [_move(context, robot, space.home)] if pose.zones else []
    leave = LeaveZones(LEAVE_ZONES(), context, robot)
    return [TakeZones(TAKE_ZONES(), context, robot, needed), *steps, *out, leave]


def interlocked(context: Context, command: Command) -> list[Behaviour]:
    """The steps before a command that makes its device occupy zones, so that no robot is in these."""
    locks = context.cell.interlocks_of(command.robot)
    zones = frozenset(each.zone for each in locks if each.is_ended_by(command))
    return [_take(context, command.robot, zones)] if zones else []


def go_home(context: Context, robot: str) -> Behaviour:
    """Go to the pose where a robot waits, planned when the step begins."""
    return sequence(GO_HOME(), *visit_from_anywhere(context, robot, context.cell.reach[robot].home, []))


def take_devices(context: Context, devices: frozenset[str]) -> Behaviour:
    """Wait until the cell has these shared devices, all at once.

    Devices are taken before any zone. So a cell that waits for a device has no robot in a zone, a cell whose
    robots hold zones asks for no device, and nobody waits in a ring.
    """
    return TakeDevices(TAKE_DEVICES(devices=tuple(sorted(devices))), context, devices)


def leave_devices(context: Context, devices: frozenset[str]) -> list[Behaviour]:
    """Give back the shared devices of these that the cell has: empty, and robots at home."""
    named, access = tuple(sorted(devices)), context.devices

    def kept() -> Failure | None:
        device = access.part_left_in(devices)
        if device is None:
            return None
        return Failure(reason=Reason.PRECONDITION, sentence=PART_LEFT(device=device))

    def home(robot: str) -> Behaviour:
        there = Unless(AT_HOME(), lambda: not access.holds(robot) or access.hand_over.is_home(robot))
        return selector(HOME_AGAIN(arm=robot), there, go_home(context, robot))

    homes = [home(robot) for robot in named if robot in context.cell.reach]
    holders = [robot.name for robot in context.cell.robots if robot.held_fact is not None]
    empty = [] if devices.isdisjoint(holders) else [Require(EMPTY(), context.failures, kept)]
    return [*empty, *homes, LeaveDevices(LEAVE_DEVICES(devices=named), context, devices)]


def grip(context: Context, robot: str, pose: Pose, *, check: PieceCheck) -> list[Behaviour]:
    """Effector on; `check`: the piece sensor has to see the part before and after."""
    if not check:
        return [unchecked_grip(context, robot)]
    retry, wait_s = context.cell.retry, context.timing.piece_wait_s
    none = Failure(reason=Reason.NO_PIECE, sentence=NO_PIECE(arm=robot, pose=pose.sentence))
    patience_s = wait_s + retry.times * (retry.backoff_s + wait_s)  # each try waits once
    needed = check is True
    attempts = [_attempt(context, robot, pose, number, needed=needed) for number in range(retry.times + 1)]
    return [
        Piece(PIECE_THERE(), context, robot, patience_s, none, needed=needed),
        selector(GRIP(), *attempts),
        Carry(CARRY(), context.parts, robot),
    ]


def unchecked_grip(context: Context, robot: str) -> Behaviour:
    """Grip without a piece sensor; a separate tool reports itself whether it holds a part."""
    own = context.cell.workspaces[robot].hand.has_effector
    missed = partial(context.handling.miss, Check.GRIP) if own else None
    return effector(context, robot, on=True, then=missed)


def let_go(context: Context, robot: str, *, check: PieceCheck) -> list[Behaviour]:
    """Effector off: the part stays where it is. `check`: the piece sensor has to see the part until then."""
    off = effector(context, robot, on=False)
    if not check:
        return [off]
    lost = Failure(reason=Reason.PART_LOST, sentence=parts.LOST(arm=robot))
    wait_s, needed = context.timing.piece_wait_s, check is True
    brought = Piece(PIECE_BROUGHT(), context, robot, wait_s, lost, needed=needed)
    return [brought, Carry(ARRIVED(), context.parts, None), off]


def _way_home_if_ours(context: Context, robot: str, *, notes_origins: bool) -> list[Behaviour]:
    """The steps of a recovery that bring a robot home; a shared robot only while the cell holds it."""
    steps_home = _way_home(context, robot, notes_origins=notes_origins)
    if robot not in context.cell.shared:
        return steps_home
    of_others = Unless(NOT_OURS(robot=robot), lambda: not context.devices.holds(robot))
    return [selector(HOME_AGAIN(arm=robot), of_others, sequence(HOME_AGAIN(arm=robot), *steps_home))]


def _way_home(context: Context, robot: str, *, notes_origins: bool) -> list[Behaviour]:
    space = context.cell.workspaces[robot]
    steps = [*_opened(context, robot), *_rise(context, robot)]
    if space.zones:
        needed = partial(context.zones.needs.for_recovery, robot)
        steps.append(TakeZones(TAKE_ZONES(), context, robot, needed, recovers=True))
    if space.hand.held_fact is not None:
        steps += _part_back(context, robot, notes_origins=notes_origins)
    steps.append(_move(context, robot, space.home))
    return [*steps, LeaveZones(LEAVE_ZONES(), context, robot)] if space.zones else steps


def _opened(context: Context, robot: str) -> list[Behaviour]:
    """Let go once more, before a move, with a tool that may still do so on an earlier command."""
    if context.cell.workspaces[robot].tool is None:
        return []
    settled = Unless(LETS_GO_OF_NOTHING(), lambda: context.parts.opening_tool(robot) is None)
    return [selector(LET_GO_FIRST(), settled, effector(context, robot, on=False))]


def _part_back(context: Context, robot: str, *, notes_origins: bool) -> list[Behaviour]:
    """Bring the part of a robot back to where it came from, which may be known only when the steps begin."""
    hand = context.cell.workspaces[robot].hand.name
    back = context.parts.back.get(robot) if notes_origins else context.parts.way_back(robot)
    off = effector(context, robot, on=False)
    if back is not None:
        context.parts.back[robot] = back
        empty = Unless(HOLDS_NOTHING(), lambda: hand not in context.parts.holding)
        return [selector(PART_BACK(), empty, sequence(CARRY_BACK(), *_at(context, robot, back, off)))]

    from_pose: list[Pose | None] = [None]  # looked up before it lets go: after that the origin is forgotten

    def origin() -> Pose | None:
        return from_pose[0]

    def kept() -> bool:
        from_pose[0] = context.parts.way_back(robot)
        return hand not in context.parts.holding or from_pose[0] is None

    def flat() -> bool:
        pose = origin()
        return pose is None or pose.above is None

    def over() -> Behaviour:
        return selector(OVER(), Unless(NO_APPROACH(), flat), _go_where(context, robot, origin, above=True))

    keeps = Unless(HOLDS_NOTHING(), kept)
    there = _go_where(context, robot, origin, above=False)
    return [selector(PART_BACK(), keeps, sequence(CARRY_BACK(), over(), there, off, over()))]


def _go_where(context: Context, robot: str, where: Callable[[], Pose | None], *, above: bool) -> Behaviour:
    """Go to a pose that is known once the step begins."""
    device = context.cell.workspaces[robot].robot

    def make(id: str) -> Command:
        pose = where() or context.cell.workspaces[robot].home
        goal = pose.above if above and pose.above is not None else pose.q
        return device.go(id=id, way=device.motion.route(context.robots.position(robot), goal))

    title, doing = (GO_OVER, GOING_OVER) if above else (GO_BACK, GOING_BACK)
    return Act(title(), context, make, doing())


def _rise(context: Context, robot: str) -> list[Behaviour]:
    """The first move of a robot that may stand low: straight up. None without approach heights."""
    if not any(pose.above for pose in context.cell.workspaces[robot].poses):
        return []
    return [Act(RISE(), context, partial(_risen, context, robot), RISING())]


def _rise_first(context: Context, robot: str, goal: Pose) -> list[Behaviour]:
    """The move straight up before a move to a goal, for a robot that is down at another target.

    It is down there where the work at that target has failed, and the recipe went on all the same.
    """
    if not any(pose != goal for pose in context.cell.reach[robot].poses if pose.above):
        return []
    rise = Approach(RISE(), context, partial(_risen, context, robot), RISING())

    def is_up() -> bool:
        robots = context.robots
        return not (robots.is_out_of_sight(robot) or robots.is_down_elsewhere(robot, goal))

    rise.is_there = is_up
    return [rise]


def _risen(context: Context, robot: str, id: str) -> Command:
    return context.cell.reach[robot].robot.go(id=id, way=(context.robots.risen(robot),))


def _settle(context: Context, robots: Sequence[str]) -> Behaviour:
    def ours() -> Iterator[str]:
        return filter(context.devices.has, robots)

    def settled() -> bool:
        ending = not all(entry.finishes for entry in context.commands.open())
        return not ending and not any(context.robots.obstacle(robot) for robot in ours())

    def unsettled() -> Failure:
        obstacles = (context.robots.obstacle(robot, was=True) for robot in ours())
        unended = UNENDED(arm=tuple(robots) or context.cell.name)
        ended = Failure(reason=Reason.STOP_UNCONFIRMED, sentence=unended)
        return next((failure for failure in obstacles if failure), ended)

    return Await(SETTLE(), context, settled, context.timing.stop_timeout_s + SETTLE_S, unsettled)


def _take(context: Context, robot: str, zones: frozenset[str]) -> Behaviour:
    return TakeZones(TAKE_ZONES(), context, robot, lambda: zones)


def _at(context: Context, robot: str, pose: Pose, *work: Behaviour) -> list[Behaviour]:
    """Go to a pose, do the work there and, where the pose has an approach height, come back up."""
    go = _move(context, robot, pose)
    if pose.above is None:
        return [go, *work]
    return [_move(context, robot, pose, above=True), go, *work, _move(context, robot, pose, above=True)]


def _move(context: Context, robot: str, pose: Pose, *, above: bool = False) -> Behaviour:
    goal = pose.q if pose.above is None or not above else pose.above
    device = context.cell.reach[robot].robot

    def make(id: str) -> Command:
        return device.go(id=id, way=device.motion.route(context.robots.position(robot), goal))

    title, doing = (MOVE_ABOVE, MOVING_ABOVE) if above else (MOVE, MOVING)
    return Act(title(pose=pose.sentence), context, make, doing(pose=pose.sentence), guard=context.parts.lost)


def effector(context: Context, robot: str, *, on: bool, then: Callable[[], None] | None = None) -> Behaviour:
    hand = context.cell.workspaces[robot].hand
    make = hand.grip if on else hand.let_go
    title, doing = (EFFECTOR_ON, SWITCHING_ON) if on else (EFFECTOR_OFF, SWITCHING_OFF)
    named = (title(), doing())
    if not hand.has_effector:
        title, doing = (HAND_ON, GRIPPING) if on else (HAND_OFF, LETTING_GO)
        named = (title(device=hand.name), doing(device=hand.name))
    act = Act(SWITCH(), context, make, named[1], then=then)
    return sequence(named[0], act, Dwell(DWELL(), context.time, context.timing.dwell_s))


def _attempt(context: Context, robot: str, pose: Pose, number: int, *, needed: bool) -> Behaviour:
    """Effector on, and the piece seen in it; a later attempt opens the effector first."""
    retry = context.cell.retry
    missed = Failure(reason=Reason.NOT_GRIPPED, sentence=NOT_GRIPPED(arm=robot, pose=pose.sentence))
    final = number == retry.times
    wait_s = context.timing.piece_wait_s
    piece = Piece(PIECE_GRIPPED(), context, robot, wait_s, missed, needed=needed, final=final)
    again = _again(context, robot) if number else []
    return sequence(TRY(number=number + 1), *again, effector(context, robot, on=True), piece)


def _again(context: Context, robot: str) -> list[Behaviour]:
    """The steps that begin a further attempt; it follows a missed grip, and no other failure."""
    only_missed = Unless(ONLY_MISSED(), lambda: context.failures.first is None)
    back_off = Dwell(BACK_OFF(), context.time, context.cell.retry.backoff_s)
    return [only_missed, effector(context, robot, on=False), back_off]
