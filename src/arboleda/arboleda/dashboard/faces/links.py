"""The links: who is heard, how often, since which boot, and what was refused."""

from __future__ import annotations

from typing import Any

from arboleda.model.facts import shown
from arboleda.views.view import devices_once

from ..wording import Words
from . import Face
from .moment import Moment, seconds

Row = dict[str, Any]
MOVING = 1  # MotionState.MOVING: no trouble, though no other command may go there now
FRESH_S = 1.0  # a telemetry younger than this is called fresh, so that its age does not flicker


def face(moment: Moment) -> Face:
    found: Face = {
        "text/broker": _broker(moment),
        "text/ros": _ros(moment),
        "text/standbys": _standbys(moment),
        "text/memory": memory(moment),
        "text/strays": _strays(moment),
        "list/standbys": [[each["host"], each["url"]] for each in moment.links["standbys"] if each["url"]],
        "rows/links": [robot["name"] for robot in moment.snapshot["robots"]],
    }
    robots = {robot["name"]: robot for robot in moment.snapshot["robots"]}
    for cell, device in devices_once(moment.snapshot["cells"]):
        robot = robots[device["name"]]
        found[f"row/links/{robot['name']}"] = _row(moment, robot, cell, device["position"])
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


def _standbys(moment: Moment) -> list[str]:
    hosts = [each["host"] for each in moment.links["standbys"]]
    return [moment.words("links.standbys", hosts=", ".join(hosts)), "online"] if hosts else ["", ""]


def memory(moment: Moment) -> list[str]:
    """The sentence about slow commits and their effect; empty while they are fast."""
    pace = moment.links.get("memory")
    if not pace or not pace["is_slow"]:
        return ["", ""]
    typical, worst = (f"{pace[key]:.2f}" for key in ("typical_s", "worst_s"))
    return [moment.words("links.memory_slow", typical=typical, worst=worst), "warning"]


def _strays(moment: Moment) -> list[str]:
    stray = moment.links["refused"].get("", {"count": 0, "last": None})
    if not stray["count"]:
        return ["", ""]
    key = "links.stray" if stray["count"] == 1 else "links.strays"
    return [moment.words(key, count=stray["count"], last=stray["last"] or ""), "warning"]


def _row(moment: Moment, robot: Row, cell: str, position: str | None) -> Row:
    """The row of a robot; `position` names its position, None if it goes nowhere and needs no homing."""
    words = moment.words
    presence = "online" if robot["online"] else "offline"
    return {
        "state": state(robot),
        "cell": cell,
        "texts": [
            robot["name"],
            words.of("device_kind", robot["kind"]),
            words(f"links.{presence}"),
            _telemetry(moment, robot),
            _readiness(moment, robot, moves=position is not None),
            "" if position is None else _yes_or_no(moment, robot["homed"]),
            says(words, robot),
            command(moment, robot),
            _refused(moment, robot),
        ],
    }


def state(robot: Row) -> str:
    if not robot["online"]:
        return "offline"
    if robot["state"] == MOVING:
        return "running"
    return "warning" if robot["obstacle"] else "online"


def _readiness(moment: Moment, robot: Row, *, moves: bool) -> str:
    if robot["online"] and robot["state"] == MOVING:
        return moment.words("links.moving" if moves else "links.working")
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


def says(words: Words, robot: Row) -> str:
    """The facts of a robot by name, also those without a word on the page; the part that it may hold; and,
    for a shared device, the cell that has it."""
    known = robot["facts"].items()
    facts = [f"{words.of('fact', name)} {_fact(words, name, value)}" for name, value in known]
    holding = [words("links.holding")] if robot["holding"] else []
    held = [words("links.held_by", cell=robot["holder"])] if robot["holder"] else []
    return ", ".join([*facts, *holding, *held])


def _fact(words: Words, name: str, value: Any) -> str:
    """A fact in its own words if there are some, such as `on` of an effector."""
    if value is None:
        return words("links.unsaid")
    return words.flat.get(f"fact_said.{name}.{shown(value)}") or value_words(words, value)


def value_words(words: Words, value: Any) -> str:
    """A fact or an answer for people."""
    if isinstance(value, bool):
        return words("links.yes" if value else "links.no")
    return shown(value)


def command(moment: Moment, robot: Row) -> str:
    """The last command to a robot with its state and, if it was a question, its answer."""
    row = robot["command"]
    if row is None:
        return ""
    words = moment.words
    state = words.of("command_state", row["state"])
    answer = "" if robot["answer"] is None else f" ({value_words(words, robot['answer'])})"
    return f"{words.say(row['what'])}: {state}{answer}, {words('links.ago', time=seconds(row['age_s']))}"


def _refused(moment: Moment, robot: Row) -> str:
    """The number of commands that a robot refused, and of unreadable messages of its board."""
    messages = moment.links["refused"].get(robot["name"], {"count": 0, "last": None})
    count = robot["rejected"]["count"] + messages["count"]
    last = messages["last"] or robot["rejected"]["last"]
    return f"{count}: {moment.words.say(last)}" if count and last else str(count)
