"""The command `arboleda conformance`: its options, its output, its exit status."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.text import Text

from arboleda.adapters.broker_login import MQTT_PORT, Credentials, address, login
from arboleda.cli.language import allowed, finding, say_error
from arboleda.drivers import Evidence, Robot, quoted
from arboleda.extension import Phrase, PlantFile, Sentence, StartError, load, say
from arboleda.model.plant_model import Link, PlantModel

if TYPE_CHECKING:
    from arboleda_boards.conformance.judge import Finding, Judge

PASSED, FAILED = 0, 1
HELP = """Test the board of an arm or of a declared kind against the contract, and say which level it reaches.

It moves the arm: from one limit to the other and to its reference. Of a device of a declared kind it tries
every verb, as often as it has to. Nobody may be near it, no part in its effector or its clamp, and no plant
on the broker. Stop (software) is not a safety function. A hard-wired latching button that removes motor power
is required: have it at hand.

Exit status: 0 it does all that belongs to the level it speaks at, 1 it does not or is gone, 2 bad input."""
MEANING = {
    Evidence.STATE: Phrase("cli.conformance.state", "0 and 1 only: moving or not")(),
    Evidence.JOINTS: Phrase("cli.conformance.joints", "joints: where it is, too")(),
    Evidence.IDS: Phrase(
        "cli.conformance.ids", "ids: which command it accepted, refused and finished, too"
    )(),
}
DEVICE_MEANING = {**MEANING, Evidence.JOINTS: Phrase("cli.conformance.facts", "facts: how it is, too")()}
MAY_IT_MOVE = Phrase("cli.conformance.may_it_move", "{name} will {deeds}. Is nobody near it?")
TO_LIMITS = Phrase("cli.conformance.to_limits", "move from limit to limit")
ALL_VERBS = Phrase("cli.conformance.all_verbs", "do all that a {kind} can: {verbs}")
NO_BOARD = Phrase(
    "cli.conformance.no_board",
    "{name} is neither an arm nor a device of a declared kind with link mqtt; {others}",
)
WRONG, UNTRIED, GOOD = (
    Phrase("cli.conformance.wrong", "WRONG")(),
    Phrase("cli.conformance.untried", "not tried")(),
    Phrase("cli.conformance.good", "good")(),
)
NO_LEVEL = Phrase("cli.conformance.no_level", "{name} reaches no level; wrong: {wrong}")
REACHES = Phrase("cli.conformance.reaches", "{name} reaches the level {level} ({meaning})")
MADE = Phrase("cli.conformance.made", "{reaches}; {made} of {needed} checks made")
LESS_THAN_SPOKEN = Phrase(
    "cli.conformance.less_than_spoken",
    "{reaches}, speaks as one of {spoken}; {made} of {needed} checks made; wrong: {wrong}",
)
IS_GONE = Phrase(
    "cli.conformance.is_gone",
    "{name} is gone since {check}, and not judged: look at its power and its connection to the broker, then"
    " begin anew",
)

Name = Annotated[str, typer.Option(metavar="NAME", help="The robot's name on MQTT, or in the plant file.")]
Broker = Annotated[
    str,
    typer.Option(metavar="HOST:PORT", help="The broker that the board is on; login as for `arboleda up`."),
]
Yes = Annotated[bool, typer.Option("--yes", help="Do not ask whether it may move.")]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""

    def conformance(
        robot: Name, broker: Broker = f"127.0.0.1:{MQTT_PORT}", plant: PlantFile = None, yes: Yes = False
    ) -> None:
        tried = _named(load(plant), robot)
        if not yes:
            typer.confirm(say(MAY_IT_MOVE(name=tried.mqtt, deeds=_deeds(tried))), abort=True)
        raise typer.Exit(_try(tried, broker, login()))

    cli.command("conformance", help=HELP, short_help=HELP.partition("\n")[0])(conformance)


def _named(model: PlantModel, name: str) -> Robot:
    robots = {robot.mqtt: robot for robot in model.robots.values() if _has_board(robot)}
    robots |= {robot.name: robot for robot in robots.values()}
    if name not in robots:
        wrong = NO_BOARD(name=quoted(name), others=allowed(name, sorted(robots)))
        raise typer.BadParameter(say(wrong), param_hint="--robot")
    return robots[name]


def _has_board(robot: Robot) -> bool:
    return robot.has_effector or (robot.link is Link.MQTT and bool(robot.verb_names))


def _deeds(robot: Robot) -> Sentence:
    if robot.joints:
        return TO_LIMITS()
    return ALL_VERBS(kind=robot.kind_name, verbs=tuple(robot.verb_names))


def _try(robot: Robot, broker: str, credentials: Credentials | None) -> int:
    from arboleda_boards.conformance.broker_bench import (
        Trial,  # it takes a while to load, and only this command needs it
    )

    console = Console(highlight=False)
    try:
        where = address(broker)
    except StartError as error:
        raise typer.BadParameter(say_error(error), param_hint="--broker") from error
    shown = 0

    def report(judge: Judge) -> None:
        nonlocal shown
        for found in judge.findings[shown:]:
            console.print(_line(found), soft_wrap=True)
        shown = len(judge.findings)

    trial = Trial(robot, where, credentials, report)
    trial.run()
    console.print(_verdict(robot, trial.judge), soft_wrap=True)
    judge = trial.judge
    return PASSED if judge.reached is judge.spoken and not judge.is_gone else FAILED


def _line(found: Finding) -> Text:
    name = f"{found.check.name:18}"
    if found.wrong:
        return Text(f"{_result(WRONG)}{name}{finding(found.wrong)}", style="red")
    if found.untried:
        return Text(f"{_result(UNTRIED)}{name}{finding(found.untried)}", style="yellow")
    return Text(f"{_result(GOOD)}{name}{finding((found.check.steps.__doc__ or '').strip())}")


def _result(of: Sentence) -> str:
    """The result of a check, as wide as all of them."""
    width = max(len(say(each)) for each in (WRONG, UNTRIED, GOOD)) + 2
    return f"{say(of):{width}}"


def _verdict(robot: Robot, judge: Judge) -> Text:
    from arboleda_boards.conformance.judge import LEVELS

    if judge.is_gone:
        return Text(say(IS_GONE(name=robot.mqtt, check=judge.findings[-1].check.name)), style="red")
    wrong = tuple(found.check.name for found in judge.findings if found.wrong)
    if judge.reached is None:
        return Text(say(NO_LEVEL(name=robot.mqtt, wrong=wrong)), style="red")
    meaning, level_name = _level(robot, judge.reached)
    reaches = REACHES(name=robot.mqtt, level=level_name, meaning=meaning)
    made = sum(found.untried is None for found in judge.findings)
    needed = sum(LEVELS.index(check.level) <= LEVELS.index(judge.spoken) for check in judge.checks)
    if not wrong:
        return Text(say(MADE(reaches=reaches, made=made, needed=needed)), style="green")
    spoken = _level(robot, judge.spoken)[1]
    said = LESS_THAN_SPOKEN(reaches=reaches, spoken=spoken, made=made, needed=needed, wrong=wrong)
    return Text(say(said), style="red")


def _level(robot: Robot, level: Evidence) -> tuple[Sentence, str]:
    """The meaning of a level for a robot, and the level's name in the plant file."""
    if robot.joints:
        return MEANING[level], level.value
    return DEVICE_MEANING[level], "facts" if level is Evidence.JOINTS else level.value
