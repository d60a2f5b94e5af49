"""Check that the robots of a plant can show their arrival before their moves are given up."""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.kinds.declared import DeviceVerb, Effect
from arboleda.model.plant_model import APART_S, QUIET_S, Cell, Evidence, Robot, Timing

from .document import Document, Place

PERIOD_S = APART_S / 2  # of telemetry
# The reports that show an arrival. With ids it is one report. With state it is a report that the robot moves,
# and one that it stands. With joints it is two reports of one position, QUIET_S apart.
SHOWN_S = {
    Evidence.IDS: PERIOD_S,
    Evidence.STATE: APART_S + PERIOD_S,
    Evidence.JOINTS: QUIET_S + 2 * PERIOD_S,
}
# A drive over nodes, with joints: the robot stops, and tells its last node APART_S or more after that.
DRIVE_SHOWN_S = 3 * APART_S + 2 * PERIOD_S
ROUNDING_S = 1e-6


def check_arrivals_show(document: Document, cells: Iterable[Cell], timing: Timing) -> None:
    """Keep a problem for each robot whose move may be given up, or count as done, before reports show it."""
    for cell in cells:
        for role, robot in cell.roles.items():
            if not robot.goes:
                continue  # a verb of a declared kind has a time of its own
            _check_patience(document, robot, timing)
            spare_s, needed_s = _spare_s(robot, _longest_s(cell, robot) / robot.pace, timing), _shown_s(robot)
            if spare_s < needed_s - ROUNDING_S:
                place: Place = ("cells", cell.name)
                key: Place = ("devices", role) if document.has((*place, "devices")) else (role,)
                document.problem((*place, *key), _sentence(robot, timing, spare_s, needed_s))


def _shown_s(robot: Robot) -> float:
    drives = robot.floor_grid and robot.evidence is Evidence.JOINTS
    return DRIVE_SHOWN_S if drives else SHOWN_S[robot.evidence]


def _check_patience(document: Document, robot: Robot, timing: Timing) -> None:
    needed_s = SHOWN_S[Evidence.STATE]
    if robot.evidence is Evidence.STATE and timing.stop_timeout_s < needed_s - ROUNDING_S:
        rule = f"must be at least {needed_s:g} for {robot.name}, which has evidence: state"
        why = "so late it may say that it moves, and a move of no length would count as done before"
        document.problem(("timing", "stop_timeout_s"), f"{rule}; {why}; is {timing.stop_timeout_s:g}")


def _spare_s(robot: Robot, longest_s: float, timing: Timing) -> float:
    """The least time that a deadline leaves a move beyond its computed time.

    The moves are all that take up to `longest_s`.
    """
    factor, floor_s = timing.deadline_factor, timing.deadline_floor_s
    # A move of up to `even_s` has `timeout_s`, however short it is. A longer move has more time than that.
    even_s = min(max((robot.timeout_s - floor_s) / factor, 0.0), longest_s)
    return max(robot.timeout_s, even_s * factor + floor_s) - even_s


def _longest_s(cell: Cell, robot: Robot) -> float:
    if robot.reference is not None and robot.joints:
        return robot.motion.travel_s(None, [robot.reference])
    space, grid = cell.reach[robot.name], robot.floor_grid
    nodes = range(grid.size)
    routes = [path.nodes for path in space.paths]
    if (
        routes and cell.drive_to_start
    ):  # a drive that is given anew leads to the start of its path and over it
        routes = [(*grid.route(node, route[0]), *route[1:]) for route in routes for node in nodes]
    goals = [pose.q for pose in space.poses if isinstance(pose.q, int)]
    routes += [grid.route(node, goal) for goal in goals for node in nodes]
    return max(robot.motion.travel_s(None, route) for route in routes)


def _sentence(robot: Robot, timing: Timing, spare_s: float, needed_s: float) -> str:
    keys = (
        f"timeout_s {robot.timeout_s:g}, deadline_factor {timing.deadline_factor:g}, "
        f"deadline_floor_s {timing.deadline_floor_s:g}"
    )
    what = f"a move may take only {spare_s:.3g} s longer than computed ({keys})"
    why = f"with evidence: {robot.evidence.value}, an arrival may show {needed_s:g} s later"
    return f"{what}; {why}: a deadline_floor_s of {needed_s:g} or more mends that"


def is_proven(document: Document, place: Place, kind: str, verb: DeviceVerb, evidence: Evidence) -> bool:
    """True if a device's reports, with this evidence, can show in the verb's time that the verb is done."""
    here = (*place, "evidence")
    spare_s, needed_s = verb.at_most_s - verb.takes_s, SHOWN_S[evidence]
    if verb.effect is Effect.QUERY and evidence is not Evidence.IDS:
        why = f"{verb.name} of {kind} is a query, and its answer has to name the command"
        document.problem(here, f"must be ids: {why}")
    elif verb.effect is Effect.MOTION and evidence is Evidence.JOINTS and not verb.sets_facts:
        document.problem(here, f"facts cannot prove {verb.name} of {kind}: it sets none")
    elif spare_s < needed_s - ROUNDING_S:
        what = f"{verb.name} of {kind} takes {verb.takes_s:g} s and has an at_most_s of {verb.at_most_s:g}"
        document.problem(place, f"{what}; its end may show {needed_s:g} s later, so give it that much more")
    else:
        return True
    return False
