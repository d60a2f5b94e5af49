"""Options of a start: the choices of the command line or the ROS parameters."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from arboleda.adapters.broker_login import Credentials
from arboleda.model.recording import Recording

from .web_options import WebOptions

if TYPE_CHECKING:  # slow to load, and only needed for TLS
    from arboleda.adapters.server_tls import ServerTls

Kind = TypeVar("Kind")


@dataclass(frozen=True, kw_only=True)
class Options:
    """The choices of the command line or the ROS parameters; `link` is the ROS 2 link, None without ROS.

    `of_parts` has the options that one part alone needs, each of a class of its own: `of` finds them.
    """

    link: Any | None = None
    broker: str | None = None
    broker_host: str = "127.0.0.1"
    broker_users: dict[str, str] | None = None
    broker_tls: ServerTls | None = None
    credentials: Credentials | None = None
    rate: float = 1.0
    firmware: bool = False  # boards that can be are the firmware's, compiled for Linux
    state_dir: Path | None = None
    store: str = ""  # the address of a database; "": what the plant file says
    web: WebOptions = field(default_factory=WebOptions)
    log_name: str = "arboleda.log"
    keeps_waiting: bool = True  # for the next start; else what waits at the end is cancelled
    page: bool = True  # the API needs none, and a page takes a second to load
    recording: Recording | None = None  # None: no record is written
    plant_file: Path | None = None  # None: the shipped one, which nobody changes
    restarts: bool = False  # whoever runs it starts it again, where `App.restart_wanted`
    groot2: bool | None = None  # whether trees are shown to Groot2; None: where the plant file says so
    notes: tuple[str, ...] = ()  # what else a person should know of this start
    of_parts: tuple[object, ...] = ()

    def of(self, kind: type[Kind]) -> Kind | None:
        """The options of this class; None where there are none."""
        return next((each for each in self.of_parts if isinstance(each, kind)), None)
