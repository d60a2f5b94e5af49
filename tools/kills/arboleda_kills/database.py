"""A PostgreSQL server in a directory of its own, run by a user without rights."""

from __future__ import annotations

import os
import pwd
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import psycopg

USER, PASSWORD, DATABASE = "arboleda", "not-for-logs", "plants"
PROGRAMS = sorted(Path("/usr/lib/postgresql").glob("*/bin"), key=lambda path: float(path.parent.name))
SETTINGS = {
    "fsync": "off",  # nobody pulls the plug of a test
    "max_connections": "40",
    "shared_buffers": "16MB",
    "unix_socket_directories": "",
}
LOOK_S, LOOKS = 0.1, 100


class NoServer(Exception):
    """PostgreSQL is not installed here."""


def programs() -> Path:
    """The folder with the programs of the newest server; NoServer where there is none."""
    found = shutil.which("postgres")
    if found is None and not PROGRAMS:
        raise NoServer("postgresql is not installed")
    return Path(found).parent if found else PROGRAMS[-1]


class Server:
    """The server of a run; `address` is that of its one database.

    `before` is what its commands begin with, `others` the network from which it is reached beside 127.0.0.1.
    """

    def __init__(self, port: int, *, before: Sequence[str] = (), others: str = "") -> None:
        self.port = port
        self._programs = programs()
        self._others = others
        self._folder = Path(tempfile.mkdtemp(prefix="arboleda-pg-", dir="/tmp"))
        self._before = [*before, *self._without_rights()]
        self._process: subprocess.Popen[bytes] | None = None
        self._make()

    @property
    def address(self) -> str:
        return f"postgresql://{USER}@127.0.0.1:{self.port}/{DATABASE}"

    def start(self) -> None:
        settings = SETTINGS | {"listen_addresses": "*" if self._others else "127.0.0.1"}
        options = [option for key, value in settings.items() for option in ("-c", f"{key}={value}")]
        self._process = self._started("postgres", "-D", str(self._data), "-p", str(self.port), *options)
        self.wait()

    def wait(self) -> None:
        """Until it answers."""
        for _ in range(LOOKS):
            try:
                with self.connection("postgres"):
                    return
            except psycopg.OperationalError:
                assert self.runs, f"postgres has ended: {self.last_words()}"
                time.sleep(LOOK_S)
        raise AssertionError(f"postgres does not answer: {self.last_words()}")

    @property
    def runs(self) -> bool:
        """True if its process is there."""
        return self._process is not None and self._process.poll() is None

    def last_words(self, lines: int = 20) -> str:
        """The end of its log, and its exit status where it has ended."""
        status = None if self._process is None else self._process.poll()
        log = (self._folder / "log").read_text(errors="replace").splitlines()
        return "\n".join([f"exit status {status}", *log[-lines:]])

    def stop(self, how: signal.Signals = signal.SIGQUIT) -> None:
        """End it: at once, as in a crash, unless asked otherwise; idempotent."""
        if self._process is not None:
            self._process.send_signal(how)
            self._process.wait(20)
            self._process = None

    def freeze(self, *, on: bool) -> None:
        """Stop every process of it where it is, or let them go on."""
        assert self._process is not None
        children = Path(f"/proc/{self._process.pid}/task/{self._process.pid}/children").read_text().split()
        for each in (self._process.pid, *map(int, children)):
            os.kill(each, signal.SIGSTOP if on else signal.SIGCONT)

    def remove(self) -> None:
        self.stop()
        shutil.rmtree(self._folder, ignore_errors=True)

    def connection(self, database: str = DATABASE) -> psycopg.Connection:
        """To look into it, or to spoil something."""
        return psycopg.connect(
            f"postgresql://{USER}@127.0.0.1:{self.port}/{database}", password=PASSWORD, autocommit=True
        )

    @property
    def _data(self) -> Path:
        return self._folder / "data"

    def _without_rights(self) -> list[str]:
        """The beginning of a command so that not root runs it, which PostgreSQL refuses."""
        if os.geteuid() != 0:
            return []
        user = pwd.getpwnam(_user())
        shutil.chown(self._folder, user.pw_uid, user.pw_gid)
        return ["setpriv", f"--reuid={user.pw_uid}", f"--regid={user.pw_gid}", "--clear-groups"]

    def _make(self) -> None:
        secret = self._folder / "secret"
        secret.write_text(PASSWORD)
        self._started(
            "initdb", "-D", str(self._data), "-U", USER, "--no-sync", "--auth=scram-sha-256",
            f"--pwfile={secret}", "--encoding=UTF8", "--locale=C",
        ).wait(60)  # fmt: skip
        if self._others:
            with (self._data / "pg_hba.conf").open("a") as rules:
                rules.write(f"host all all {self._others} scram-sha-256\n")
        self.start()
        with self.connection("postgres") as db:
            db.execute(f"CREATE DATABASE {DATABASE}")

    def _started(self, program: str, *words: str) -> subprocess.Popen[bytes]:
        with (self._folder / "log").open("ab") as log:
            return subprocess.Popen(
                [*self._before, self._programs / program, *words], stdout=log, stderr=log, cwd="/"
            )


def _user() -> str:
    """The user who runs it in root's place."""
    names = {each.pw_name for each in pwd.getpwall()}
    return "postgres" if "postgres" in names else "nobody"
