"""The command `arboleda`."""

from __future__ import annotations

import json
import shlex
import sys
from dataclasses import replace
from enum import Enum
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.text import Text

from arboleda import __version__
from arboleda.adapters.web.names import listen_address, public_origin
from arboleda.core import text
from arboleda.core.errors import ArboledaError, ConfigError, QueueFull, StartError, TextError
from arboleda.core.messages import TaskState
from arboleda.core.model import PlantModel
from arboleda.core.outside import plain

from . import bench_command, config, layout_check, new_command, session, token_command, tree_command, verbs
from .build import OF_BOARDS, PARTS, Options, build
from .client import Refused
from .conformance import command as conformance
from .parts.broker import PASSWORD, USER, address, login
from .rate import check_rate
from .screen import table
from .simulate import command as simulate
from .state import find_running, holder
from .urdf import robot_urdf
from .web_options import WebOptions
from .where import PlantFile, StateFolder, client, folder

FAILED, BAD_INPUT = 1, 2
OVER = {TaskState.FAILED.value, TaskState.CANCELLED.value}
LONGEST = 1000  # characters of a line on the terminal

cli = typer.Typer(
    help="Run robot cells by behavior trees: simulated on this machine, or real over MQTT and ROS 2.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    add_completion=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


class Boards(str, Enum):
    """Who answers on MQTT."""

    VIRTUAL = "virtual"
    LINUX = "linux"
    REAL = "real"


def _broker(value: str | None) -> str | None:
    return value if value is None else str(_or_bad_parameter(address, value))


def _host(value: str) -> str:
    return str(_or_bad_parameter(listen_address, value))


def _public_url(value: str | None) -> str | None:
    return value if value is None else str(_or_bad_parameter(public_origin, value))


def _rate(value: float) -> float:
    return _or_bad_parameter(check_rate, value)


def _or_bad_parameter(check: Any, value: Any) -> Any:
    try:
        return check(value)
    except StartError as error:
        raise typer.BadParameter(str(error)) from error


NoRos = Annotated[bool, typer.Option("--no-ros", help="Leave ROS 2 out; the plant speaks MQTT directly.")]
RosLan = Annotated[
    bool, typer.Option("--ros-lan", help="Let other machines on the network take part in ROS 2.")
]
Broker = Annotated[
    str | None,
    typer.Option(
        metavar="HOST:PORT",
        callback=_broker,
        help=f"MQTT broker to use; login from ${USER} and ${PASSWORD}. [default: one of its own]",
    ),
]
BrokerHost = Annotated[
    str | None,
    typer.Option(
        metavar="ADDRESS",
        help="Open the plant's own broker to boards on this address, e.g. 0.0.0.0; needs --broker-users.",
    ),
]
BrokerUsers = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Lines of NAME:PASSWORD for the plant's own broker; a board's name is its MQTT name, e.g. ra_1.",
    ),
]
BoardsOption = Annotated[
    Boards | None,
    typer.Option(
        "--boards",
        help="Start virtual boards, the firmware's as programs (SCARA), or expect real ones. "
        "[default: virtual; real with --broker-host]",
    ),
]
Rate = Annotated[
    float, typer.Option(metavar="X", callback=_rate, help="Make the virtual robots X times as fast.")
]
Host = Annotated[
    str,
    typer.Option(
        metavar="ADDRESS",
        callback=_host,
        help="Where the HTTP API listens; with 0.0.0.0 or any other address of a network, everybody needs "
        "a token.",
    ),
]
Port = Annotated[
    int | None,
    typer.Option(
        metavar="N",
        min=1,
        max=65535,
        help="Port of the HTTP API. [default: 8080, or a free one if it is taken]",
    ),
]
PublicUrl = Annotated[
    str | None,
    typer.Option(
        metavar="URL",
        callback=_public_url,
        help="How people reach a proxy before the HTTP API, e.g. https://plant.example; demands a token.",
    ),
]
Tasks = Annotated[list[str] | None, typer.Argument(help="Tasks to begin with, e.g. 'sis_a 0B 7'.")]


@cli.command()
def up(
    tasks: Tasks = None,
    plant: PlantFile = None,
    no_ros: NoRos = False,
    ros_lan: RosLan = False,
    broker: Broker = None,
    broker_host: BrokerHost = None,
    broker_users: BrokerUsers = None,
    boards: BoardsOption = None,
    rate: Rate = 1.0,
    host: Host = "127.0.0.1",
    port: Port = None,
    public_url: PublicUrl = None,
    state: StateFolder = None,
) -> None:
    """Run the plant until Ctrl-C; tasks come from here, `arboleda submit` or ROS 2 (/task_request)."""
    model = _model(plant, tasks or [])
    web = WebOptions(host=host, port=port, public_url=public_url)
    options = _options(broker, broker_host, broker_users, rate, state, web)
    _run(model, tasks or [], options, boards=boards, ros=not no_ros, lan=ros_lan, stay=True)


@cli.command()
def run(
    tasks: Annotated[list[str], typer.Argument(help="Tasks to do, e.g. 'sis_a 0B 7' 'sis_b 1C 3'.")],
    plant: PlantFile = None,
    no_ros: NoRos = False,
    ros_lan: RosLan = False,
    broker: Broker = None,
    broker_host: BrokerHost = None,
    broker_users: BrokerUsers = None,
    boards: BoardsOption = None,
    rate: Rate = 1.0,
    host: Host = "127.0.0.1",
    port: Port = None,
    public_url: PublicUrl = None,
    state: StateFolder = None,
) -> None:
    """Start the plant, do the tasks, end. Exit status: 0 all done, 1 a task failed, 2 bad input.

    Not for a plant that is up already: that takes tasks by `arboleda submit`.
    """
    model = _model(plant, tasks)
    _refuse_beside(tasks, plant, state)
    web = WebOptions(host=host, port=port, public_url=public_url)
    options = _options(broker, broker_host, broker_users, rate, state, web)
    _run(model, tasks, options, boards=boards, ros=not no_ros, lan=ros_lan, stay=False)


@cli.command()
def submit(
    task: Annotated[str, typer.Argument(help="The task, e.g. 'sis_a 0B 7' or 'sis_a 0B 7 #lot42'.")],
    plant: PlantFile = None,
    state: StateFolder = None,
) -> None:
    """Send a task to the plant that runs on this machine.

    Exit status: 0 accepted, 1 a task of that id has failed or was cancelled before, 2 refused.
    """
    answer = client(plant, state).submit(task)
    sentence = f"  {answer['sentence']}" if answer["sentence"] else ""
    print(plain(f"{answer['state']}: {answer['text']} (id {answer['id']}){sentence}", LONGEST))
    if answer["state"] in OVER:
        _complain(ArboledaError(f"the task #{answer['id']} is over; give another id to do it once more"))
        raise typer.Exit(FAILED)


@cli.command()
def status(
    plant: PlantFile = None,
    state: StateFolder = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the whole snapshot as JSON.")] = False,
) -> None:
    """Show what the plant that runs on this machine is doing."""
    snapshot = client(plant, state).status()
    if as_json:
        print(json.dumps(snapshot, indent=2, ensure_ascii=False))
        return
    Console(highlight=False).print(table(snapshot))


token_command.add_to(cli)
simulate.add_to(cli)
conformance.add_to(cli)
bench_command.add_to(cli)
verbs.add_to(cli)


@cli.command()
def check(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="The plant file to check.")],
) -> None:
    """Check a plant file; every problem at once, each with its line. Exit status: 0 good, 2 problems."""
    model = config.load(file)
    for note in config.notes(model):
        print(f"{file}: note: {note}")
    for warning in (*config.warnings(model), *layout_check.warnings(model)):
        print(f"{file}: warning: {warning}")
    print(f"{file}: good: plant {model.name}; cells {', '.join(cell.name for cell in model.cells)}")


cli.command()(tree_command.tree)
cli.command()(new_command.new)


@cli.command()
def urdf(
    robot: Annotated[
        str, typer.Argument(metavar="ROBOT", help="A robot of the plant, e.g. ra1 or rm_sis_a.")
    ],
    plant: PlantFile = None,
) -> None:
    """Print a robot of the plant as URDF.

    To keep it: `arboleda urdf ra1 > ra1.urdf`. Joints have the names of /joint_states, limits and speeds are
    those of the plant file. The root link is base_link of an arm and grid_link of a mobile robot; where it
    stands is not part of it.

    Exit status: 0 printed, 1 the xacro library is missing, 2 bad input.
    """
    print(robot_urdf(config.load(plant), robot), end="")


def _version(wanted: bool) -> None:
    if wanted:
        print(f"arboleda {__version__}")
        raise typer.Exit


@cli.callback()
def common(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Run robot cells by behavior trees: simulated on this machine, or real over MQTT and ROS 2."""


def _model(plant: Path | None, tasks: list[str]) -> PlantModel:
    """The plant, with every task text checked before anything starts."""
    model = config.load(plant)
    problems = []
    for task in tasks:
        try:
            text.parse(task, model)
        except TextError as error:
            problems.append(f"'{task}': {error}")
    if problems:
        raise ConfigError(tuple(problems))
    return model


def _refuse_beside(tasks: list[str], plant: Path | None, state: Path | None) -> None:
    """StartError where a plant runs already on that state directory: what to type to have it do the tasks."""
    where = folder(plant, state)
    if find_running(where) is None:
        return
    chosen = ["--plant", str(plant)] if plant else []
    chosen += ["--state", str(state)] if state else []
    lines = [shlex.join(["arboleda", "submit", *chosen, task]) for task in tasks]
    beside = shlex.join(["arboleda", "run", *(["--plant", str(plant)] if plant else []), "--state", "DIR"])
    raise StartError(
        "\n".join(
            [
                f"{holder(where)} To have it do this, type:",
                *(f"  {line}" for line in lines),
                f"Another plant beside it needs a directory and, on ROS 2, a domain of its own: "
                f"ROS_DOMAIN_ID=N {beside} ...",
            ]
        )
    )


def _options(
    broker: str | None,
    host: str | None,
    users: Path | None,
    rate: float,
    state: Path | None,
    web: WebOptions,
) -> Options:
    if broker and host:
        raise typer.BadParameter(
            "--broker names another broker, --broker-host opens the plant's own: choose one"
        )
    if (host is None) != (users is None):
        raise typer.BadParameter("--broker-host and --broker-users go together: who may log in, and where")
    return Options(
        broker=broker,
        broker_host=host or "127.0.0.1",
        broker_users=config.broker_users(users) if users else None,
        credentials=login(),
        rate=rate,
        state_dir=state,
        web=web,
    )


def _run(
    model: PlantModel,
    tasks: list[str],
    options: Options,
    *,
    boards: Boards | None,
    ros: bool,
    lan: bool,
    stay: bool,
) -> None:
    boards = boards or (Boards.REAL if options.broker_users else Boards.VIRTUAL)
    if boards is not Boards.VIRTUAL and options.rate != 1.0:
        raise typer.BadParameter("--rate is for virtual boards; the others have the speed they have")
    left_out = {"broker"} if options.broker else set()
    left_out |= {"devices"} if boards is Boards.REAL else set()
    left_out |= set() if model.has_boards else OF_BOARDS
    link = session.ros_link(lan=lan) if ros else None
    options = replace(options, link=link, page=stay, firmware=boards is Boards.LINUX)
    app = build(model, set(PARTS) - left_out, options)
    raise typer.Exit(session.Session(app, tasks, Console(highlight=False), stay=stay).run())


def main() -> None:
    """The entry point: whatever goes wrong is one sentence on standard error."""
    try:
        cli()
    except (ConfigError, TextError, QueueFull, Refused) as error:
        _complain(error)
        sys.exit(BAD_INPUT)
    except ArboledaError as error:
        _complain(error)
        sys.exit(FAILED)


def _complain(error: ArboledaError) -> None:
    lines = "\n".join(plain(line, LONGEST) for line in f"arboleda: {error}".splitlines())
    Console(stderr=True, highlight=False).print(Text(lines, style="red"), soft_wrap=True)
