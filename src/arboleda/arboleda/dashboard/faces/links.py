"""The links: who is heard, how often, since which boot, and what was refused."""

from __future__ import annotations

from typing import Any

from . import Face
from .moment import Moment, seconds

Row = dict[str, Any]
MOVING = 1  # MotionState.MOVING: no trouble, though no other command may go there now
FRESH_S = 1.0  # a telemetry younger than this is called fresh, so that its age does not flicker


def face(moment: Moment) -> Face:
    found: Face = {
        "text/broker": _broker(moment),
        "text/ros": _ros(moment),
        "text/strays": _strays(moment),
        "rows/links": [robot["name"] for robot in moment.snapshot["robots"]],
    }
    for robot in moment.snapshot["robots"]:
        found[f"row/links/{robot['name']}"] = _row(moment, robot)
    return found


def _broker(moment: Moment) -> list[str]:
    broker = moment.links["broker"]
    if broker is None:
        return [moment.words("links.no_broker"), "unknown"]
    state = "online" if broker["connected"] else "offline"
    return [moment.words(f"links.broker_{state}", address=broker["address"]), state]


def _ros(moment: Moment) -> list[str]:
    ros = moment.links["ros"]
    if ros is None:
        return [moment.words("links.no_ros"), "unknown"]
    return [moment.words("links.ros"), "online"]


def _strays(moment: Moment) -> list[str]:
    stray = moment.links["refused"].get("", {"count": 0, "last": None})
    if not stray["count"]:
        return ["", ""]
    key = "links.stray" if stray["count"] == 1 else "links.strays"
    return [moment.words(key, count=stray["count"], last=stray["last"] or ""), "warning"]


def _row(moment: Moment, robot: Row) -> Row:
    words = moment.words
    state = "online" if robot["online"] else "offline"
    return {
        "state": _state(robot),
        "cell": next(
            cell["name"]
            for cell in moment.snapshot["cells"]
            if robot["name"] in (cell["arm"], cell["mobile"])
        ),
        "texts": [
            robot["name"],
            words(f"links.{state}"),
            _telemetry(moment, robot),
            _readiness(moment, robot),
            _yes_or_no(moment, robot["homed"]),
            _effector(moment, robot),
            _command(moment, robot["command"]),
            str(robot["boot_id"]) if robot["boot_id"] is not None else "",
            _refused(moment, robot),
        ],
    }


def _state(robot: Row) -> str:
    if not robot["online"]:
        return "offline"
    if robot["state"] == MOVING:
        return "running"
    return "warning" if robot["obstacle"] else "online"


def _readiness(moment: Moment, robot: Row) -> str:
    if robot["online"] and robot["state"] == MOVING:
        return moment.words("links.moving")
    return moment.words.say(robot["obstacle"]) if robot["obstacle"] else moment.words("links.ready")


def _telemetry(moment: Moment, robot: Row) -> str:
    if robot["age_s"] is None:
        return moment.words("links.never")
    rate = "" if robot["telemetry_hz"] is None else f"{robot['telemetry_hz']:.1f} Hz, "
    fresh = robot["age_s"] < FRESH_S
    return rate + (
        moment.words("links.fresh") if fresh else moment.words("links.age", time=seconds(robot["age_s"]))
    )


def _yes_or_no(moment: Moment, value: bool | None) -> str:
    return moment.words({None: "links.unsaid", True: "links.yes", False: "links.no"}[value])


def _effector(moment: Moment, robot: Row) -> str:
    if robot["holding"] is None:
        return ""
    words = moment.words
    grip = words({None: "links.unsaid", True: "links.on", False: "links.off"}[robot["effector"]])
    return f"{grip}, {words('links.holding')}" if robot["holding"] else grip


def _command(moment: Moment, command: Row | None) -> str:
    if command is None:
        return ""
    words = moment.words
    state = words.of("command_state", command["state"])
    return f"{words.say(command['what'])}: {state}, {words('links.ago', time=seconds(command['age_s']))}"


def _refused(moment: Moment, robot: Row) -> str:
    """Commands that the robot refused, and messages of its board that nobody could read."""
    messages = moment.links["refused"].get(robot["name"], {"count": 0, "last": None})
    count = robot["rejected"]["count"] + messages["count"]
    last = messages["last"] or robot["rejected"]["last"]
    return f"{count}: {moment.words.say(last)}" if count and last else str(count)
