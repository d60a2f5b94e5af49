"""The command `arboleda`."""

from __future__ import annotations

import json
import shlex
import sys
import time
from contextlib import suppress
from dataclasses import replace
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.live import Live
from rich.text import Text

from arboleda import __version__
from arboleda.adapters.broker_login import PASSWORD, TLS_PORT, USER, address, login
from arboleda.client.errors import Conflict, NoAnswer
from arboleda.core import text
from arboleda.model.errors import ArboledaError, ConfigError, QueueFull, StartError, TextError
from arboleda.model.messages import TaskState
from arboleda.model.outside import plain
from arboleda.model.plant_model import Link, PlantModel
from arboleda.model.sentence import Phrase
from arboleda.plant_file import loader
from arboleda.plant_file.urdf import robot_urdf
from arboleda.plant_file.versions import Versions
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.preamble import Recording
from arboleda.runtime import invocation
from arboleda.runtime.alarm_options import alarm_options
from arboleda.runtime.rate import check_rate
from arboleda.runtime.state import find_running, holder
from arboleda.runtime.web_options import WebOptions
from arboleda.web.access.names import DEFAULT_PORT, listen_address, public_origin

from . import (
    apply,
    backup,
    bench,
    certs,
    check,
    examples,
    exercise,
    fault,
    handover,
    logs,
    mcp,
    new,
    nodes,
    oee,
    prove,
    record,
    replay,
    report,
    service,
    site,
    tasks,
    token,
    tree,
    verbs,
    virtual,
)
from . import conformance as conformance
from . import firmware_config as firmware_config
from . import simulate as simulate
from .client import PlantClient, PlantGone
from .language import say, say_error, say_row, word
from .overview import Overview
from .plant_options import (
    PlantFile,
    RunningPlant,
    StateFolder,
    StoreAddress,
    TokensFile,
    client,
    folder,
)
from .screen import table

if TYPE_CHECKING:
    from arboleda.adapters.server_tls import ServerTls
    from arboleda.runtime.build import Options

FAILED, BAD_INPUT = 1, 2
UNDONE = {TaskState.FAILED.value, TaskState.CANCELLED.value}
LONGEST = 1000  # characters of a line on the terminal

TASK_OVER = Phrase("cli.task_over", "the task #{id} is over; give another id to do it once more")
IS_HELD = Phrase("cli.run.beside", "{held} To have it do this, type:")
ANOTHER_PLANT = Phrase(
    "cli.run.another",
    "Another plant beside it needs a directory and, on ROS 2, a domain of its own: "
    "ROS_DOMAIN_ID=N {command} ...",
)
NEEDS_CERTIFICATE = Phrase("cli.up.needs_certificate", "{option} needs a certificate: --tls-cert FILE")
CA_NEEDS_TLS = Phrase(
    "cli.up.ca_needs_tls", "--broker-ca is for boards that speak TLS: it needs --broker-tls"
)
TWO_BROKERS = Phrase(
    "cli.up.two_brokers",
    "--broker names another broker, --broker-host opens the plant's own: choose one",
)
HOST_AND_USERS = Phrase(
    "cli.up.host_and_users", "--broker-host and --broker-users go together: who may log in, and where"
)
TLS_NEEDS_HOST = Phrase(
    "cli.up.tls_needs_host", "--broker-tls is for boards of other machines: it needs --broker-host"
)
RATE_IS_VIRTUAL = Phrase("cli.up.rate", "--rate is for virtual boards; the others have the speed they have")
DEMO_IS_VIRTUAL = Phrase("cli.up.demo", "--demo has boards fail, so it is for virtual ones alone")
WITHOUT_ROS = Phrase("cli.up.without_ros", "Without ROS 2, over MQTT alone: {why}")
SIMULATED = Phrase("cli.up.simulated", "{names}: simulated; with --boards real their drivers reach them")

cli = typer.Typer(
    cls=Overview,
    help="Run robot cells by behavior trees: simulated on this machine, or real over MQTT and ROS 2.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
    context_settings={"help_option_names": ["-h", "--help"]},
)


class Boards(str, Enum):
    """The devices that answer on MQTT."""

    VIRTUAL = "virtual"
    LINUX = "linux"
    DRIVERS = "drivers"
    REAL = "real"


def _broker(value: str | None) -> str | None:
    return value if value is None else str(_or_bad_parameter(address, value))


def _host(value: str) -> str:
    return str(_or_bad_parameter(listen_address, value))


def _public_url(value: str | None) -> str | None:
    return value if value is None else str(_or_bad_parameter(public_origin, value))


def _rate(value: float) -> float:
    return float(_or_bad_parameter(check_rate, value))


def _or_bad_parameter(check: Any, value: Any) -> Any:
    try:
        return check(value)
    except StartError as error:
        raise typer.BadParameter(str(error)) from error


Ros = Annotated[
    bool | None,
    typer.Option(
        "--ros/--no-ros",
        help="Speak ROS 2, or MQTT alone. [default: ROS 2 where it is installed]",
    ),
]
RosLan = Annotated[
    bool, typer.Option("--ros-lan", help="Let other machines on the network take part in ROS 2.")
]
Broker = Annotated[
    str | None,
    typer.Option(
        metavar="[mqtts://]HOST:PORT",
        callback=_broker,
        help=f"MQTT broker to use, with TLS as mqtts://; login from ${USER} and ${PASSWORD}. "
        "[default: one of its own]",
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
BrokerTls = Annotated[
    bool,
    typer.Option(
        "--broker-tls",
        help=f"Have boards speak TLS to the plant's own broker, on port {TLS_PORT}; needs --broker-host and "
        "--tls-cert.",
    ),
]
BrokerCa = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="Have boards show a certificate of this authority as well, with their name; needs --broker-tls.",
    ),
]
TlsCert = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        envvar="ARBOLEDA_TLS_CERT",
        help="Certificate of this machine, e.g. of `arboleda certs`: page and HTTP API speak TLS with it.",
    ),
]
TlsKey = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        envvar="ARBOLEDA_TLS_KEY",
        help="Key of that certificate. [default: in the file of --tls-cert]",
        show_default=False,
    ),
]
BoardsOption = Annotated[
    Boards | None,
    typer.Option(
        "--boards",
        help="Which devices answer: virtual boards (virtual), the firmware as programs (linux, SCARA arms), "
        "real drivers beside virtual boards (drivers), or real ones (real). [default: virtual; real with "
        "--broker-host]",
    ),
]
Rate = Annotated[
    float, typer.Option(metavar="X", callback=_rate, help="Make the virtual robots X times as fast.")
]
Patience = Annotated[
    float,
    typer.Option(
        "--wait-for-devices",
        metavar="SECONDS",
        min=1.0,
        help="Wait so long for devices that are offline, then end and name them.",
    ),
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
        help="Address of a proxy before the HTTP API, e.g. https://plant.example; everybody then needs "
        "a token.",
    ),
]
Groot2 = Annotated[
    bool | None,
    typer.Option(
        "--groot2/--no-groot2",
        help="Show each cell's tree to Groot2, where the HTTP API listens: the first cell on port 1667, or "
        "on `groot2` of the plant file. [default: where the plant file has that]",
    ),
]
Standby = Annotated[
    bool,
    typer.Option(
        "--standby",
        help="Wait until nobody leads this plant, and lead it then; needs a store that both hosts reach.",
    ),
]
DemoOption = Annotated[
    bool,
    typer.Option("--demo", help="Give tasks without end, and have a virtual board fail now and then."),
]
Tasks = Annotated[
    list[str] | None, typer.Argument(metavar="TASK", help="Tasks to begin with, e.g. 'sis_a 0B 7'.")
]


@cli.command()
def up(
    tasks: Tasks = None,
    plant: PlantFile = None,
    ros: Ros = None,
    ros_lan: RosLan = False,
    broker: Broker = None,
    broker_host: BrokerHost = None,
    broker_users: BrokerUsers = None,
    broker_tls: BrokerTls = False,
    broker_ca: BrokerCa = None,
    boards: BoardsOption = None,
    rate: Rate = 1.0,
    host: Host = "127.0.0.1",
    port: Port = None,
    public_url: PublicUrl = None,
    tls_cert: TlsCert = None,
    tls_key: TlsKey = None,
    groot2: Groot2 = None,
    state: StateFolder = None,
    store: StoreAddress = "",
    standby: Standby = False,
    demo: DemoOption = False,
) -> None:
    """Run the plant until Ctrl-C; tasks come from here, `arboleda submit` or ROS 2 (/task_request)."""
    before = invocation.port_before()
    if before is not None:
        tasks = []  # they were given at the first start
    model, recording = _model(plant, tasks or [])
    shown = _Certificates(tls_cert, tls_key, broker_tls=broker_tls, broker_ca=broker_ca)
    web = WebOptions(
        host=host,
        port=port,
        public_url=public_url,
        tls=shown.by_web,
        usual_port=before or DEFAULT_PORT,
    )
    options = _options(broker, broker_host, broker_users, shown, rate, state, store, web, recording)
    options = replace(options, groot2=groot2, demo=demo, plant_file=plant)
    _run(model, tasks or [], options, boards=boards, ros=ros, lan=ros_lan, stay=True, standby=standby)


@cli.command()
def run(
    tasks: Annotated[
        list[str], typer.Argument(metavar="TASK", help="Tasks to do, e.g. 'sis_a 0B 7' 'sis_b 1C 3'.")
    ],
    plant: PlantFile = None,
    ros: Ros = None,
    ros_lan: RosLan = False,
    broker: Broker = None,
    broker_host: BrokerHost = None,
    broker_users: BrokerUsers = None,
    broker_tls: BrokerTls = False,
    broker_ca: BrokerCa = None,
    boards: BoardsOption = None,
    rate: Rate = 1.0,
    host: Host = "127.0.0.1",
    port: Port = None,
    public_url: PublicUrl = None,
    tls_cert: TlsCert = None,
    tls_key: TlsKey = None,
    groot2: Groot2 = None,
    state: StateFolder = None,
    store: StoreAddress = "",
    wait_for_devices: Patience = 10.0,
) -> None:
    """Start the plant, do the tasks, end. Exit status: 0 all done, 1 a task failed or could not begin, 2 bad
    input.

    Not for a plant that is up already: that takes tasks by `arboleda submit`.
    """
    model, recording = _model(plant, tasks)
    _refuse_beside(tasks, plant, state)
    shown = _Certificates(tls_cert, tls_key, broker_tls=broker_tls, broker_ca=broker_ca)
    web = WebOptions(host=host, port=port, public_url=public_url, tls=shown.by_web)
    options = _options(broker, broker_host, broker_users, shown, rate, state, store, web, recording)
    options = replace(options, groot2=groot2, plant_file=plant)
    _run(model, tasks, options, boards=boards, ros=ros, lan=ros_lan, stay=False, patience_s=wait_for_devices)


@cli.command()
def submit(
    task: Annotated[
        str, typer.Argument(metavar="TASK", help="The task, e.g. 'sis_a 0B 7' or 'sis_a 0B 7 #lot42'.")
    ],
    wait: Annotated[
        bool, typer.Option("--wait", help="Print what becomes of it until it has ended.")
    ] = False,
    plant: RunningPlant = None,
    state: StateFolder = None,
    store: StoreAddress = "",
    tokens: TokensFile = None,
) -> None:
    """Send a task to the plant that runs on this machine, or that another host leads.

    Exit status: 0 accepted, with --wait done; 1 a task of that id has failed or was cancelled before, with
    --wait also this one; 2 refused. Ctrl-C ends the waiting and not the task. Where another host takes the
    plant over meanwhile, --wait goes on there.
    """
    reached = client(plant, state, store, tokens)
    answer = reached.submit(task)
    _print_task(answer)
    if answer["state"] in UNDONE:
        _complain(ArboledaError(TASK_OVER(id=answer["id"])))
        raise typer.Exit(FAILED)
    if not wait:
        return
    last = answer
    for last in reached.follow(answer):
        _print_task(last)
    if last["state"] in UNDONE:
        raise typer.Exit(FAILED)


def _print_task(row: dict[str, Any]) -> None:
    choice = row.get("choice") if row["state"] == TaskState.QUEUED.value else ""
    remarks = "; ".join(each for each in (choice, say_row(row)) if each)
    line = f"{word('task_state', row['state'])}: {row['text']} (id {row['id']})" + (
        f"  {remarks}" if remarks else ""
    )
    print(plain(line, LONGEST), flush=True)


@cli.command()
def status(
    plant: RunningPlant = None,
    state: StateFolder = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print the whole snapshot as JSON.")] = False,
    watch: Annotated[bool, typer.Option("--watch", help="Show what changes, until Ctrl-C.")] = False,
    store: StoreAddress = "",
    tokens: TokensFile = None,
) -> None:
    """Show what the plant is doing that runs on this machine, or that another host leads.

    With --json and --watch each change is a line: its kind, and its row of the snapshot.
    """
    reached = client(plant, state, store, tokens)
    if watch:
        _watch(reached, as_json=as_json)
        return
    snapshot = reached.status()
    if as_json:
        print(json.dumps(snapshot, indent=2, ensure_ascii=False))
        return
    Console(highlight=False).print(table(snapshot))


def _watch(reached: PlantClient, *, as_json: bool) -> None:
    """Print the changes of the plant until it ends."""
    with suppress(PlantGone):
        if as_json:
            for kind, row in reached.changes():
                print(json.dumps({"kind": kind, "row": row}, ensure_ascii=False), flush=True)
            return
        with Live(console=Console(highlight=False), auto_refresh=False) as live:
            for _ in reached.changes():
                with suppress(NoAnswer):  # it may end between a change and the table of it
                    live.update(table(reached.status()), refresh=True)


token.add_to(cli)
simulate.add_to(cli)
prove.add_to(cli)
conformance.add_to(cli)
firmware_config.add_to(cli)
bench.add_to(cli)
verbs.add_to(cli)


check.add_to(cli)
cli.command()(tree.tree)
cli.command()(nodes.nodes)
cli.command()(new.new)
cli.command()(examples.examples)
cli.command()(apply.apply)
cli.command()(apply.versions)
cli.command()(tasks.tasks)
cli.command()(oee.oee)
cli.command()(certs.certs)
cli.command()(handover.handover)
cli.command()(fault.fault)
cli.command()(site.site)
backup.add_to(cli)
cli.add_typer(service.cli, name="service")
cli.add_typer(record.cli, name="record")
cli.add_typer(virtual.cli, name="virtual")
cli.add_typer(exercise.cli, name="exercise")
replay.add_to(cli)
report.add_to(cli)
mcp.add_to(cli)
logs.add_to(cli)


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
    print(robot_urdf(loader.load(plant), robot), end="")


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


def _model(plant: Path | None, tasks: list[str]) -> tuple[PlantModel, Recording | None]:
    """The plant and the limits of its record, with every task text checked before anything starts."""
    if plant is not None:
        Versions(plant).go_on()
    model, recording = loader.load_recorded(plant)
    problems = []
    for task in tasks:
        try:
            text.alternatives(task, model)
        except TextError as error:
            problems.append(f"'{task}': {error}")
    if problems:
        raise ConfigError(tuple(problems))
    return model, recording


def _refuse_beside(tasks: list[str], plant: Path | None, state: Path | None) -> None:
    """Raise StartError if a plant runs on that state directory, with the commands to give it the tasks."""
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
                say(IS_HELD(held=holder(where))),
                *(f"  {line}" for line in lines),
                say(ANOTHER_PLANT(command=beside)),
            ]
        )
    )


class _Certificates:
    """The certificates that the servers of this plant show, by the options; StartError if one is unusable."""

    def __init__(
        self, certificate: Path | None, key: Path | None, *, broker_tls: bool, broker_ca: Path | None
    ) -> None:
        self.by_web: ServerTls | None = None
        self.by_broker: ServerTls | None = None
        self.notes: tuple[str, ...] = ()
        if certificate is None and (key is not None or broker_tls):
            option = "--broker-tls" if broker_tls else "--tls-key"
            raise typer.BadParameter(say(NEEDS_CERTIFICATE(option=option)))
        if broker_ca is not None and not broker_tls:
            raise typer.BadParameter(say(CA_NEEDS_TLS()))
        if certificate is None:
            return
        from arboleda.adapters.server_tls import server_tls

        self.by_web = server_tls(certificate, key)
        if broker_tls:
            self.by_broker = server_tls(certificate, key, authority=broker_ca)
        note = self.by_web.note(time.time())
        self.notes = (note,) if note else ()


def _options(
    broker: str | None,
    host: str | None,
    users: Path | None,
    shown: _Certificates,
    rate: float,
    state: Path | None,
    store: str,
    web: WebOptions,
    recording: Recording | None,
) -> Options:
    from arboleda.runtime.build import Options  # slow to load, and only needed to run a plant

    if broker and host:
        raise typer.BadParameter(say(TWO_BROKERS()))
    if (host is None) != (users is None):
        raise typer.BadParameter(say(HOST_AND_USERS()))
    if shown.by_broker is not None and host is None:
        raise typer.BadParameter(say(TLS_NEEDS_HOST()))
    return Options(
        broker=broker,
        broker_host=host or "127.0.0.1",
        broker_users=loader.broker_users(users) if users else None,
        broker_tls=shown.by_broker,
        notes=shown.notes,
        credentials=login(),
        alarms=alarm_options(),
        rate=rate,
        state_dir=state,
        store=store,
        web=web,
        recording=recording,
    )


def _run(
    model: PlantModel,
    tasks: list[str],
    options: Options,
    *,
    boards: Boards | None,
    ros: bool | None,
    lan: bool,
    stay: bool,
    standby: bool = False,
    patience_s: float | None = None,
) -> None:
    from arboleda.runtime.build import OF_BOARDS, PARTS, build
    from arboleda.runtime.standby.process import take_over

    from . import session

    boards = boards or (Boards.REAL if options.broker_users else Boards.VIRTUAL)
    if boards is not Boards.VIRTUAL and options.rate != 1.0:
        raise typer.BadParameter(say(RATE_IS_VIRTUAL()))
    if boards is not Boards.VIRTUAL and options.demo:
        raise typer.BadParameter(say(DEMO_IS_VIRTUAL()))
    is_virtual = boards in (Boards.VIRTUAL, Boards.LINUX)
    if is_virtual:
        options = replace(options, notes=(*options.notes, *_virtual(model)))
        model, recording = _on_boards(model, options.recording)
        options = replace(options, recording=recording)
    left_out = {"broker"} if options.broker else set()
    left_out |= {"devices"} if boards is Boards.REAL else set()
    left_out |= set() if model.has_boards else OF_BOARDS
    link, without_ros = _ros(model, ros, lan=lan)
    options = replace(
        options,
        link=link,
        notes=(*options.notes, *without_ros),
        page=stay,
        keeps_waiting=stay,
        restarts=stay and not standby,
        firmware=boards is Boards.LINUX,
    )
    parts, console = set(PARTS) - left_out, Console(highlight=False)
    if standby:

        def again() -> tuple[PlantModel, Recording | None]:
            read = loader.load_recorded(options.plant_file)
            return _on_boards(*read) if is_virtual else read

        try:
            app = take_over(model, parts, options, lambda line: console.print(Text(line, style="dim")), again)
        except KeyboardInterrupt:
            raise typer.Exit from None
    else:
        app = build(model, parts, options)
    status = session.Session(app, tasks, console, stay=stay, patience_s=patience_s).run()
    if app.restart_wanted:
        invocation.restart(app.port)
    raise typer.Exit(status)


def _on_boards(model: PlantModel, recording: Recording | None) -> tuple[PlantModel, Recording | None]:
    """The same plant with virtual boards in place of its drivers."""
    return model.on_boards(Link.DRIVER), recording and replace(recording, virtual=True)


def _ros(model: PlantModel, wanted: bool | None, *, lan: bool) -> tuple[Any, tuple[str, ...]]:
    """The link to ROS 2, and the note that it is left out if it is not installed here."""
    from . import session

    if wanted is False:
        return None, ()
    try:
        return session.ros_link(lan=lan), ()
    except session.RosMissing as error:
        if wanted or lan or any(robot.link is Link.ROS for robot in model.robots.values()):
            raise
        return None, (say(WITHOUT_ROS(why=error.sentence)),)


def _virtual(model: PlantModel) -> tuple[str, ...]:
    """The note on devices whose drivers are not used."""
    names = tuple(robot.name for robot in model.driven)
    return (say(SIMULATED(names=names)),) if names else ()


def main() -> None:
    """The entry point: prints any trouble as one sentence on standard error."""
    try:
        cli(prog_name="arboleda")
    except (ConfigError, NoRecord, TextError, QueueFull, Conflict) as error:
        _complain(error)
        sys.exit(BAD_INPUT)
    except ArboledaError as error:
        _complain(error)
        sys.exit(FAILED)


def _complain(error: ArboledaError) -> None:
    lines = "\n".join(plain(line, LONGEST) for line in f"arboleda: {say_error(error)}".splitlines())
    Console(stderr=True, highlight=False).print(Text(lines, style="red"), soft_wrap=True)
