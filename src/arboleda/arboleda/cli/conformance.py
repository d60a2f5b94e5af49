"""The command `arboleda conformance`: its options, its output, its exit status."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.text import Text

from arboleda.adapters.broker_login import MQTT_PORT, Credentials, address, login
from arboleda.model.errors import StartError
from arboleda.model.plant_model import Evidence, Link, PlantModel, Robot
from arboleda.plant_file import loader

from .plant_options import PlantFile

if TYPE_CHECKING:
    from arboleda.board_kit.conformance.judge import Finding, Judge

PASSED, FAILED = 0, 1
HELP = """Test the board of an arm or of a declared kind against the contract, and say which level it reaches.

It moves the arm: from one limit to the other and to its reference. Of a device of a declared kind it tries
every verb, as often as it has to. Nobody may be near it, no part in its effector or its clamp, and no plant
on the broker. A halt in software is not a safety function: have the button that removes power at hand.

Exit status: 0 it does all that belongs to the level it speaks at, 1 it does not, 2 bad input."""
MEANING = {
    Evidence.STATE: "0 and 1 only: moving or not",
    Evidence.JOINTS: "joints: where it is, too",
    Evidence.IDS: "ids: which command it accepted, refused and finished, too",
}
DEVICE_MEANING = {**MEANING, Evidence.JOINTS: "facts: how it is, too"}

Name = Annotated[str, typer.Option(metavar="NAME", help="The robot's name on MQTT, or in the plant file.")]
Broker = Annotated[
    str,
    typer.Option(metavar="HOST:PORT", help="The broker that the board is on; login as for `arboleda run`."),
]
Yes = Annotated[bool, typer.Option("--yes", help="Do not ask whether it may move.")]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""

    def conformance(
        robot: Name, broker: Broker = f"127.0.0.1:{MQTT_PORT}", plant: PlantFile = None, yes: Yes = False
    ) -> None:
        tried = _named(loader.load(plant), robot)
        if not yes:
            typer.confirm(f"{tried.mqtt} will {_deeds(tried)}. Is nobody near it?", abort=True)
        raise typer.Exit(_try(tried, broker, login()))

    cli.command("conformance", help=HELP, short_help=HELP.partition("\n")[0])(conformance)


def _named(model: PlantModel, name: str) -> Robot:
    robots = {robot.mqtt: robot for robot in model.robots.values() if _has_board(robot)}
    robots |= {robot.name: robot for robot in robots.values()}
    if name not in robots:
        raise typer.BadParameter(
            f"'{name}' is neither an arm nor a device of a declared kind with link mqtt; "
            f"there are {', '.join(sorted(robots))}",
            param_hint="--robot",
        )
    return robots[name]


def _has_board(robot: Robot) -> bool:
    return robot.has_effector or (robot.link is Link.MQTT and bool(robot.verb_names))


def _deeds(robot: Robot) -> str:
    if robot.joints:
        return "move from limit to limit"
    return f"do all that a {robot.kind_name} can: {', '.join(robot.verb_names)}"


def _try(robot: Robot, broker: str, credentials: Credentials | None) -> int:
    from arboleda.board_kit.conformance.broker_bench import (
        Trial,
    )  # it takes a while to load, and only this command needs it

    console = Console(highlight=False)
    try:
        where = address(broker)
    except StartError as error:
        raise typer.BadParameter(str(error), param_hint="--broker") from error
    shown = 0

    def report(judge: Judge) -> None:
        nonlocal shown
        for finding in judge.findings[shown:]:
            console.print(_line(finding), soft_wrap=True)
        shown = len(judge.findings)

    trial = Trial(robot, where, credentials, report)
    trial.run()
    console.print(_verdict(robot, trial.judge), soft_wrap=True)
    return PASSED if trial.judge.reached is trial.judge.spoken else FAILED


def _line(finding: Finding) -> Text:
    name = f"{finding.check.name:18}"
    if finding.wrong:
        return Text(f"WRONG      {name}{finding.wrong}", style="red")
    if finding.untried:
        return Text(f"not tried  {name}{finding.untried}", style="yellow")
    return Text(f"good       {name}{(finding.check.steps.__doc__ or '').strip()}")


def _verdict(robot: Robot, judge: Judge) -> Text:
    from arboleda.board_kit.conformance.judge import LEVELS

    wrong = [finding.check.name for finding in judge.findings if finding.wrong]
    if judge.reached is None:
        return Text(f"{robot.mqtt} reaches no level; wrong: {', '.join(wrong)}", style="red")
    meaning, level_name = _level(robot, judge.reached)
    level = f"{robot.mqtt} reaches the level {level_name} ({meaning})"
    made = sum(finding.untried is None for finding in judge.findings)
    needed = sum(LEVELS.index(check.level) <= LEVELS.index(judge.spoken) for check in judge.checks)
    count = f"{made} of {needed} checks made"
    if not wrong:
        return Text(f"{level}; {count}", style="green")
    return Text(
        f"{level}, speaks as one of {_level(robot, judge.spoken)[1]}; {count}; wrong: {', '.join(wrong)}",
        style="red",
    )


def _level(robot: Robot, level: Evidence) -> tuple[str, str]:
    """The meaning of a level for a robot, and the level's name in the plant file."""
    if robot.joints:
        return MEANING[level], level.value
    return DEVICE_MEANING[level], "facts" if level is Evidence.JOINTS else level.value
