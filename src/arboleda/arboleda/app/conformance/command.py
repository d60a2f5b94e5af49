"""The command `arboleda conformance`: its options, what it says, how it ends."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.text import Text

from arboleda.adapters.broker_login import MQTT_PORT, Credentials, address, login
from arboleda.kinds.arm import Arm
from arboleda.model.errors import StartError
from arboleda.model.plant_model import Evidence, PlantModel

from .. import config
from ..where import PlantFile

if TYPE_CHECKING:
    from .judge import Finding, Judge

PASSED, FAILED = 0, 1
HELP = """Run the contract against an arm's board, of whatever kind, and say which level it reaches.

It moves the arm: from one limit to the other and to its reference. Nobody may be near it, no part in its
effector, and no plant on the broker. A halt in software is not a safety function: have the button that
removes motor power at hand.

Exit status: 0 it does all that belongs to the level it speaks at, 1 it does not, 2 bad input."""
MEANING = {
    Evidence.STATE: "0 and 1 only: moving or not",
    Evidence.JOINTS: "joints: where it is, too",
    Evidence.IDS: "ids: which command it accepted, refused and finished, too",
}

Robot = Annotated[str, typer.Option(metavar="NAME", help="The robot's name on MQTT, or in the plant file.")]
Broker = Annotated[
    str,
    typer.Option(metavar="HOST:PORT", help="The broker that the board is on; login as for `arboleda run`."),
]
Yes = Annotated[bool, typer.Option("--yes", help="Do not ask whether the arm may move.")]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""

    def conformance(
        robot: Robot, broker: Broker = f"127.0.0.1:{MQTT_PORT}", plant: PlantFile = None, yes: Yes = False
    ) -> None:
        arm = _arm(config.load(plant), robot)
        if not yes:
            typer.confirm(f"{arm.mqtt} will move from limit to limit. Is nobody near it?", abort=True)
        raise typer.Exit(_try(arm, broker, login()))

    cli.command("conformance", help=HELP, short_help=HELP.partition("\n")[0])(conformance)


def _arm(model: PlantModel, name: str) -> Arm:
    arms = {robot.mqtt: robot for robot in model.robots.values() if robot.has_joints}
    arms |= {robot.name: robot for robot in arms.values()}
    if name not in arms:
        raise typer.BadParameter(
            f"'{name}' is not an arm of this plant; there are {', '.join(sorted(arms))}", param_hint="--robot"
        )
    return arms[name]


def _try(arm: Arm, broker: str, credentials: Credentials | None) -> int:
    from .trial import Trial  # it takes a while to load, and only this command needs it

    console = Console(highlight=False)
    try:
        where = address(broker)
    except StartError as error:
        raise typer.BadParameter(str(error), param_hint="--broker") from error
    said = 0

    def told(judge: Judge) -> None:
        nonlocal said
        for finding in judge.findings[said:]:
            console.print(_line(finding), soft_wrap=True)
        said = len(judge.findings)

    trial = Trial(arm, where, credentials, told)
    trial.run()
    console.print(_verdict(arm, trial.judge), soft_wrap=True)
    return PASSED if trial.judge.reached is trial.judge.spoken else FAILED


def _line(finding: Finding) -> Text:
    name = f"{finding.check.name:18}"
    if finding.wrong:
        return Text(f"WRONG      {name}{finding.wrong}", style="red")
    if finding.untried:
        return Text(f"not tried  {name}{finding.untried}", style="yellow")
    return Text(f"good       {name}{(finding.check.steps.__doc__ or '').strip()}")


def _verdict(arm: Arm, judge: Judge) -> Text:
    from .judge import CHECKS, LEVELS

    wrong = [finding.check.name for finding in judge.findings if finding.wrong]
    if judge.reached is None:
        return Text(f"{arm.mqtt} reaches no level; wrong: {', '.join(wrong)}", style="red")
    level = f"{arm.mqtt} reaches the level {judge.reached.value} ({MEANING[judge.reached]})"
    made = sum(finding.untried is None for finding in judge.findings)
    needed = sum(LEVELS.index(check.level) <= LEVELS.index(judge.spoken) for check in CHECKS)
    count = f"{made} of {needed} checks made"
    if not wrong:
        return Text(f"{level}; {count}", style="green")
    return Text(
        f"{level}, speaks as one of {judge.spoken.value}; {count}; wrong: {', '.join(wrong)}", style="red"
    )
