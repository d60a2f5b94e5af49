"""The command `arboleda up`: a plant, with or without an end of its own."""

from __future__ import annotations

import shlex
import time
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer
from rich.console import Console
from rich.text import Text

from arboleda.adapters.broker_login import login
from arboleda.model import text
from arboleda.model.errors import ConfigError, StartError, TextError
from arboleda.model.plant_model import Link, PlantModel
from arboleda.model.recording import Recording
from arboleda.model.sentence import Phrase
from arboleda.runtime import invocation
from arboleda.runtime.alarm_options import alarm_options
from arboleda.runtime.demo_options import DemoOptions
from arboleda.runtime.state import find_running, holder
from arboleda.runtime.web_options import WebOptions
from arboleda.web.access.names import DEFAULT_PORT

from .language import say
from .loading import loading
from .plant_options import PlantFile, StateFolder, StoreAddress, folder
from .up_options import (
    Boards,
    BoardsOption,
    Broker,
    BrokerCa,
    BrokerHost,
    BrokerTls,
    BrokerUsers,
    DemoOption,
    Groot2,
    Host,
    Once,
    Patience,
    Port,
    PublicUrl,
    Rate,
    Ros,
    RosLan,
    Standby,
    Tasks,
    TlsCert,
    TlsKey,
)
from .working import working

if TYPE_CHECKING:
    from arboleda.adapters.server_tls import ServerTls
    from arboleda.runtime.build import Options

LOADING = Phrase("cli.up.loading", "Loading the plant ...")
IS_HELD = Phrase("cli.run.beside", "{held} To have it do this, type:")
ANOTHER_PLANT = Phrase(
    "cli.run.another",
    "Another plant beside it needs a directory and, on ROS 2, a domain of its own: "
    "ROS_DOMAIN_ID=N {command} ...",
)
IN_QUOTES = Phrase("cli.up.in_quotes", "a task of several words needs quotes: {task}")
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
ONCE = Phrase("cli.up.once", "--once does the tasks that are named, and ends: not with --demo or --standby")
WITHOUT_ROS = Phrase("cli.up.without_ros", "Without ROS 2, over MQTT alone: {why}")
SIMULATED = Phrase("cli.up.simulated", "{names}: simulated; with --boards real their drivers reach them")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(up)


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
    once: Once = False,
    wait_for_devices: Patience = 10.0,
) -> None:
    """Run the plant until Ctrl-C, or until the tasks that are named have ended (`--once`).

    Tasks come from here, `arboleda submit` or ROS 2 (/task_request).
    """
    tasks = tasks or []
    before = invocation.port_before()
    if before is not None:
        tasks = []  # they were given at the first start
    elif once and (demo or standby or not tasks):
        raise typer.BadParameter(say(ONCE()))
    if not once:
        typer.echo(say(LOADING()))  # before anything that is slow to load
    with working():
        model, recording = _model(plant, tasks)
    if once:
        _refuse_beside(tasks, plant, state)
    shown = _Certificates(tls_cert, tls_key, broker_tls=broker_tls, broker_ca=broker_ca)
    web = WebOptions(
        host=host,
        port=port,
        public_url=public_url,
        tls=shown.by_web,
        usual_port=before or DEFAULT_PORT,
    )
    options = _options(broker, broker_host, broker_users, shown, rate, state, store, web, recording)
    wanted = (*options.of_parts, DemoOptions()) if demo else options.of_parts
    options = replace(options, groot2=groot2, of_parts=wanted, plant_file=plant)
    _run(
        model,
        tasks,
        options,
        boards=boards,
        ros=ros,
        lan=ros_lan,
        stay=not once,
        standby=standby,
        patience_s=wait_for_devices if once else None,
    )


def _model(plant: Path | None, tasks: list[str]) -> tuple[PlantModel, Recording | None]:
    """The plant and the limits of its record, with every task text checked before anything starts."""
    with loading():
        from arboleda.plant_file import loader
        from arboleda.plant_file.versions import Versions

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
        whole = " ".join(tasks)
        if _is_task(whole, model):
            problems = [say(IN_QUOTES(task=shlex.quote(whole)))]
        raise ConfigError(tuple(problems))
    return model, recording


def _is_task(words: str, model: PlantModel) -> bool:
    try:
        text.alternatives(words, model)
    except TextError:
        return False
    return True


def _refuse_beside(tasks: list[str], plant: Path | None, state: Path | None) -> None:
    """Raise StartError if a plant runs on that state directory, with the commands to give it the tasks."""
    where = folder(plant, state)
    if find_running(where) is None:
        return
    chosen = ["--plant", str(plant)] if plant else []
    chosen += ["--state", str(state)] if state else []
    lines = [shlex.join(["arboleda", "submit", *chosen, task]) for task in tasks]
    beside = shlex.join(
        ["arboleda", "up", "--once", *(["--plant", str(plant)] if plant else []), "--state", "DIR"]
    )
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
    with loading():
        from arboleda.plant_file import user_file
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
        broker_users=user_file.broker_users(users) if users else None,
        broker_tls=shown.by_broker,
        notes=shown.notes,
        credentials=login(),
        of_parts=(alarm_options(),),
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

    from . import session

    boards = boards or (Boards.REAL if options.broker_users else Boards.VIRTUAL)
    if boards is not Boards.VIRTUAL and options.rate != 1.0:
        raise typer.BadParameter(say(RATE_IS_VIRTUAL()))
    if boards is not Boards.VIRTUAL and options.of(DemoOptions) is not None:
        raise typer.BadParameter(say(DEMO_IS_VIRTUAL()))
    is_virtual = boards in (Boards.VIRTUAL, Boards.LINUX)
    if is_virtual:
        options = replace(options, notes=(*options.notes, *_virtual(model)))
        model, recording = _on_boards(model, options.recording)
        options = replace(options, recording=recording)
    left_out = {"broker"} if options.broker else set()
    left_out |= {"devices"} if boards is Boards.REAL else set()
    left_out |= set() if model.has_boards else OF_BOARDS
    with working():
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
        from arboleda.plant_file import loader
        from arboleda.runtime.standing_by import take_over

        def again() -> tuple[PlantModel, Recording | None]:
            read = loader.load_recorded(options.plant_file)
            return _on_boards(*read) if is_virtual else read

        try:
            app = take_over(model, parts, options, lambda line: console.print(Text(line, style="dim")), again)
        except KeyboardInterrupt:
            raise typer.Exit from None
    else:
        with working():
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
