"""`arboleda certs`: an authority of a lab's own, and what it signs for a plant and its boards."""

from __future__ import annotations

import os
import re
import socket
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import datetime, timedelta, timezone
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from arboleda.adapters.broker_login import CA as MQTT_CA
from arboleda.adapters.broker_login import CERTIFICATE as MQTT_CERTIFICATE
from arboleda.adapters.broker_login import KEY as MQTT_KEY
from arboleda.model.errors import StartError
from arboleda.model.outside import quoted
from arboleda.model.plant_model import Link, PlantModel
from arboleda.model.sentence import Phrase, Sentence
from arboleda.plant_file import loader
from arboleda.plant_file.user_file import read_bytes
from arboleda.runtime import invocation
from arboleda.web.access.names import own_addresses, own_names

from . import mosquitto_files
from .language import say
from .plant_options import PlantFile

if TYPE_CHECKING:  # most installs are without its library
    from arboleda.adapters.authority import Authority, Pair

CA, PLANT, BOARDS, BROKER, MOSQUITTO = "ca", "plant", "boards", "broker", "mosquitto"
DAYS = 825  # what browsers and their systems take at most
SOON = timedelta(days=30)
LARGEST = 100_000  # bytes of a file of certificates
NAME = re.compile(
    r"(?=.{1,253}$)[A-Za-z0-9]([A-Za-z0-9-]*[A-Za-z0-9])?(\.[A-Za-z0-9]([A-Za-z0-9-]*[A-Za-z0-9])?)*"
)
ADDRESS = re.compile(r"[0-9.]+|[0-9A-Fa-f:.]*:[0-9A-Fa-f:.]*")

NAME_TAKEN = Phrase(
    "cli.certs.name_taken", "a board cannot have the MQTT name {name} here: it is that of another"
)
UNKNOWN = Phrase("cli.certs.unknown", "nobody here is called {name}; there are {known}")
BELIEVED = Phrase("cli.certs.believed", "who believes it believes the others")
LACKS = Phrase(
    "cli.certs.lacks", "{path}.crt is there and does not have {name}; --renew {user} makes it anew"
)
AND_NOT = Phrase("cli.certs.and_not", "{names}; not {new}, which this machine is called now: --renew {user}")
SAYS_ELSE = Phrase(
    "cli.certs.says_else", "{path} is there and says something else; move it away to have it written anew"
)
NOT_WRITTEN = Phrase("cli.certs.not_written", "{folder} cannot be written: {why}")
NOT_OF = Phrase("cli.certs.not_of", "{path}.crt is not of {authority}.crt; --renew {user} makes it anew")
MADE = Phrase("cli.certs.made", "made")
WAS_THERE = Phrase("cli.certs.was_there", "was there")
UNTIL = Phrase("cli.certs.until", "until {day}")
EXPIRES = Phrase("cli.certs.expires", "expires {day}: {how}")
HAS_EXPIRED = Phrase("cli.certs.has_expired", "HAS EXPIRED {day}: {how}")
RENEW = Phrase("cli.certs.renew", "--renew {user}")
NEW_FOLDER = Phrase("cli.certs.new_folder", "a new folder, and its ca.crt to everybody")
AUTHORITY_EXPIRED = Phrase("cli.certs.authority_expired", "has expired on {day}; make a new folder")
HALF = Phrase("cli.certs.half", "{there} is there without {other}; put it back, or move {there} away")
NO_NAME = Phrase(
    "cli.certs.no_name", "{name} is neither a name of a machine nor an address; write e.g. plant.lab"
)
ABOUT = Phrase("cli.certs.about", "{file} {why}")
NO_LIBRARY = Phrase(
    "cli.certs.no_library",
    "certificates are made with the library {library}, which is not installed here; type "
    "`{install} 'arboleda[certs]'`",
)
SIGNS = Phrase(
    "cli.certs.signs", "{file} signs: who has it is believed by all of them. Keep it off the network."
)
TO_EVERYBODY = Phrase(
    "cli.certs.to_everybody",
    "{file} goes to everybody who is to believe this plant: boards, browsers, other machines ({variable}).",
)
STAYS = Phrase(
    "cli.certs.stays",
    "{file} and .key stay on this machine, for --tls-cert and --tls-key of `arboleda up`.",
)
TO_BOARDS = Phrase("cli.certs.to_boards", "{file} and .key go to the board of that name, and nowhere else.")
TO_BROKER = Phrase(
    "cli.certs.to_broker",
    "{folder} goes to {at} of the broker's machine, owned by the user that mosquitto has there: "
    "mosquitto -c {configuration}",
)
USES_BROKER = Phrase(
    "cli.certs.uses_broker", "The plant uses it with --broker mqtts://NAME, {ca}, {certificate} and {key}"
)

Folder = Annotated[Path, typer.Argument(metavar="FOLDER", help="Folder of the certificates.")]
Names = Annotated[
    list[str] | None,
    typer.Option(
        "--name",
        metavar="NAME",
        help="One more name or address of this machine; those that it has itself are added anyhow.",
    ),
]
Mosquitto = Annotated[
    list[str] | None,
    typer.Option(
        metavar="NAME",
        help="Write a folder `mosquitto` as well, for a broker with that name or address: its certificate, "
        "its configuration, and who may do what there.",
    ),
]
At = Annotated[
    Path, typer.Option(metavar="PATH", help="Path that the folder will have on the machine of that broker.")
]
Days = Annotated[
    int, typer.Option(metavar="N", min=1, max=3650, help="For how long a new certificate is valid.")
]
Renew = Annotated[
    list[str] | None,
    typer.Option(metavar="WHO", help="Make that one anew: plant, or a board's MQTT name."),
]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(certs)


def certs(
    folder: Folder = Path("certs"),
    name: Names = None,
    mosquitto: Mosquitto = None,
    at: At = Path("/etc/mosquitto/arboleda"),
    days: Days = DAYS,
    renew: Renew = None,
    plant: PlantFile = None,
) -> None:
    """Make a small authority for a lab, and certificates for the plant on this machine and for each board.

    Certificates that exist already stay as they are; a board that is new in the plant file gets its own.

    Exit status: 0 all of them are there, 1 they could not be made, and nothing is changed; 2 bad input.
    """
    model = loader.load(plant, recipes=False)
    named, of_broker = ([_checked(each) for each in names or ()] for names in (name, mosquitto))
    boards = _boards(model)
    if taken := {PLANT, BROKER} & set(boards):
        raise StartError(NAME_TAKEN(name=taken.pop()))
    hosts = (PLANT, BROKER) if of_broker else (PLANT,)
    if unknown := sorted(set(renew or ()) - {*hosts, *boards}):
        raise typer.BadParameter(say(UNKNOWN(name=quoted(unknown[0]), known=(*hosts, *boards))))
    now = datetime.now(timezone.utc).replace(microsecond=0)
    with _library():
        found = _found(folder, now)
    lab = _Lab(folder=folder, authority=found, now=now, days=days, renewed=frozenset(renew or ()))
    own = ["localhost", *sorted(own_names()), *own_addresses(), "::1"]
    lab.host(folder / PLANT, PLANT, named, own)
    for board in boards:
        lab.board(board)
    if of_broker:
        lab.host(folder / MOSQUITTO / BROKER, BROKER, of_broker, ())
        for called, text in mosquitto_files.texts(at, PLANT).items():
            lab.text(folder / MOSQUITTO / called, text.encode())
        lab.text(folder / MOSQUITTO / f"{CA}.crt", found.pair.certificate)
    lab.write()
    print("\n".join([*lab.lines, "", *_next(folder, boards), *(_of_broker(folder, at) if of_broker else ())]))


@dataclass(kw_only=True)
class _Lab:
    """The certificates of a lab: those that it has, and those that are to be written."""

    folder: Path
    authority: Authority
    now: datetime
    days: int
    renewed: frozenset[str]
    lines: list[str] = field(default_factory=list)  # one of each certificate, for a person
    _fresh: list[tuple[Path, bytes, int]] = field(default_factory=list)  # with its mode

    def __post_init__(self) -> None:
        path = self.folder / CA
        made = not path.with_suffix(".crt").exists()
        if made:
            self._add(path, self.authority.pair)
        self._say(path, made, self.authority.until, BELIEVED())

    def host(self, path: Path, user: str, named: Sequence[str], own: Sequence[str]) -> None:
        """Make the certificate of a server, with the names given by a person and those that it has itself."""
        names = list(dict.fromkeys([*named, *(each for each in own if _is_name(each))]))
        there = self._there(path, user)
        if there is None:
            self._make(path, self.authority.host(user, names, self.now, self.days), " ".join(names))
            return
        until, has = there
        if lacks := [each for each in named if each not in has]:
            raise StartError(LACKS(path=str(path), name=quoted(lacks[0]), user=user))
        new = [each for each in names if each not in has]
        names_there = " ".join(has)
        says = AND_NOT(names=names_there, new=" ".join(new), user=user) if new else names_there
        self._say(path, False, until, says, user)

    def board(self, user: str) -> None:
        """Make the certificate with which a board logs in."""
        path = self.folder / BOARDS / user
        there = self._there(path, user)
        if there is None:
            self._make(path, self.authority.client(user, self.now, self.days), user)
        else:
            self._say(path, False, there[0], user, user)

    def text(self, path: Path, content: bytes) -> None:
        """Add another file; StartError if one of that name has another content."""
        if not os.path.lexists(path):
            self._fresh.append((path, content, 0o644))
        elif read_bytes(path, LARGEST) != content:
            raise StartError(SAYS_ELSE(path=str(path)))

    def write(self) -> None:
        """Write all new files; StartError, and nothing changed, if the machine refuses."""
        done: list[tuple[Path, Path]] = []
        try:
            self._makedirs()
            for path, content, mode in self._fresh:
                fresh = path.with_name(f".{path.name}.{os.getpid()}")
                done.append((fresh, path))
                with os.fdopen(os.open(fresh, os.O_WRONLY | os.O_CREAT | os.O_EXCL, mode), "wb") as file:
                    file.write(content)
            for fresh, path in done:
                os.replace(fresh, path)
        except OSError as error:
            raise StartError(NOT_WRITTEN(folder=str(self.folder), why=str(error.strerror))) from error
        finally:
            for fresh, _ in done:
                fresh.unlink(missing_ok=True)

    def _makedirs(self) -> None:
        for each in sorted({self.folder, *(path.parent for path, _, _ in self._fresh)}):
            each.mkdir(mode=0o700, parents=True, exist_ok=True)

    def _there(self, path: Path, user: str) -> tuple[datetime, tuple[str, ...]] | None:
        """The end and the names of the certificate in those files; None if it has to be made."""
        if user in self.renewed or not _is_there(path):
            return None
        with _about(f"{path}.crt"):
            facts = self.authority.signed(read_bytes(Path(f"{path}.crt"), LARGEST))
        if facts is None:
            raise StartError(NOT_OF(path=str(path), authority=str(self.folder / CA), user=user))
        return facts.until, facts.names

    def _make(self, path: Path, pair: Pair, says: str) -> None:
        self._add(path, pair)
        facts = self.authority.signed(pair.certificate)
        assert facts is not None
        self._say(path, True, facts.until, says)

    def _add(self, path: Path, pair: Pair) -> None:
        self._fresh += [
            (Path(f"{path}.key"), pair.key, 0o600),
            (Path(f"{path}.crt"), pair.certificate, 0o644),
        ]

    def _say(self, path: Path, made: bool, until: datetime, says: Sentence | str, user: str = "") -> None:
        day = f"{until:%Y-%m-%d}"
        held = UNTIL(day=day)
        if until < self.now + SOON:
            how = RENEW(user=user) if user else NEW_FOLDER()
            held = (HAS_EXPIRED if until < self.now else EXPIRES)(day=day, how=how)
        was = MADE() if made else WAS_THERE()
        self.lines.append(f"{path}.crt  {say(was)}, {say(held)}  {say(says)}")


def _found(folder: Path, now: datetime) -> Authority:
    """The authority of that folder; a new one if it has none."""
    from arboleda.adapters import authority

    path = folder / CA
    if not _is_there(path):
        return authority.new(f"{socket.gethostname()[:40]} {now:%Y-%m-%d}", now)
    pair = [read_bytes(Path(f"{path}{ending}"), LARGEST) for ending in (".crt", ".key")]
    with _about(f"{path}.crt"):
        known = authority.Authority(authority.Pair(certificate=pair[0], key=pair[1]))
        if known.until <= now:
            raise StartError(AUTHORITY_EXPIRED(day=f"{known.until:%Y-%m-%d}"))
    return known


def _is_there(path: Path) -> bool:
    """True if both files of a certificate exist; StartError if only one of them does."""
    there = [ending for ending in (".crt", ".key") if os.path.lexists(f"{path}{ending}")]
    if len(there) == 1:
        other = ".key" if there == [".crt"] else ".crt"
        raise StartError(HALF(there=f"{path}{there[0]}", other=f"{path}{other}"))
    return bool(there)


def _boards(model: PlantModel) -> list[str]:
    """The MQTT names of the robots reached over MQTT; those behind drivers of one's own are left out."""
    return [robot.mqtt for robot in model.robots.values() if robot.link is Link.MQTT]


def _checked(name: str) -> str:
    if not _is_name(name):
        raise typer.BadParameter(say(NO_NAME(name=quoted(name))))
    return name.lower()


def _is_name(text: str) -> bool:
    if ADDRESS.fullmatch(text):
        family = socket.AF_INET6 if ":" in text else socket.AF_INET
        try:
            return socket.inet_ntop(family, socket.inet_pton(family, text)) == text.lower()
        except OSError:
            return False
    return NAME.fullmatch(text) is not None


@contextmanager
def _about(file: str) -> Iterator[None]:
    """Put the name of the file before the sentence of an error about it."""
    try:
        yield
    except StartError as error:
        raise StartError(ABOUT(file=file, why=error.sentence)) from error


@contextmanager
def _library() -> Iterator[None]:
    try:
        yield
    except ModuleNotFoundError as error:
        raise StartError(NO_LIBRARY(library=str(error.name), install=invocation.pip_install())) from error


def _next(folder: Path, boards: Sequence[str]) -> list[str]:
    """The instructions for using the files."""
    lines = [
        SIGNS(file=f"{folder}/{CA}.key"),
        TO_EVERYBODY(file=f"{folder}/{CA}.crt", variable=f"${MQTT_CA}"),
        STAYS(file=f"{folder}/{PLANT}.crt"),
    ]
    if boards:
        lines.append(TO_BOARDS(file=f"{folder}/{BOARDS}/NAME.crt"))
    return [say(line) for line in lines]


def _of_broker(folder: Path, at: Path) -> list[str]:
    """The instructions for using the files of mosquitto."""
    configuration = f"{at}/{mosquitto_files.CONFIGURATION}"
    to_broker = TO_BROKER(folder=f"{folder}/{MOSQUITTO}/", at=str(at), configuration=configuration)
    uses = USES_BROKER(
        ca=f"${MQTT_CA}={folder}/{CA}.crt",
        certificate=f"${MQTT_CERTIFICATE}={folder}/{PLANT}.crt",
        key=f"${MQTT_KEY}={folder}/{PLANT}.key",
    )
    return [say(to_broker), say(uses)]
