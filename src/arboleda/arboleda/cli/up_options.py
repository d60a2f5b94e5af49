"""Options of the command that runs a plant, `arboleda up`."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Annotated, Any

import typer

from arboleda.adapters.broker_login import PASSWORD, TLS_PORT, USER, address
from arboleda.model.errors import StartError
from arboleda.runtime.rate import check_rate
from arboleda.web.access.names import listen_address, public_origin


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
        help="Certificate of this machine, e.g. by mkcert: page and HTTP API speak TLS with it.",
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
        help="With --once, wait so long for devices that are offline, then end and name them.",
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
Once = Annotated[
    bool,
    typer.Option(
        "--once",
        help="Do the tasks that are named, and end. Exit status: 0 all done, 1 a task failed or could not "
        "begin, 2 bad input. Not for a plant that is up already: that takes tasks by `arboleda submit`.",
    ),
]
DemoOption = Annotated[
    bool,
    typer.Option("--demo", help="Give tasks without end, and have a virtual board fail now and then."),
]
Tasks = Annotated[
    list[str] | None,
    typer.Argument(metavar="TASK", help="Tasks to begin with, e.g. 'sis_a 0B 7' 'sis_b 1C 3'."),
]
