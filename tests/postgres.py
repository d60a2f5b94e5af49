"""A PostgreSQL server in a directory of its own, run by a user without rights."""

from __future__ import annotations

import os
import pwd
import shutil
import signal
import subprocess
import tempfile
from pathlib import Path

import psycopg
import pytest

USER, PASSWORD, DATABASE = "arboleda", "not-for-logs", "plants"
PROGRAMS = sorted(Path("/usr/lib/postgresql").glob("*/bin"), key=lambda path: float(path.parent.name))
SETTINGS = {
    "fsync": "off",  # nobody pulls the plug of a test
    "listen_addresses": "127.0.0.1",
    "max_connections": "40",
    "shared_buffers": "16MB",
    "unix_socket_directories": "",
}


def programs() -> Path:
    """Where the programs of the newest server are; the test is skipped where there is none."""
    found = shutil.which("postgres")
    if found is None and not PROGRAMS:
        pytest.skip("postgresql is not installed")
    return Path(found).parent if found else PROGRAMS[-1]


class Server:
    """The server of a test run; `address` is that of its one database."""

    def __init__(self, port: int) -> None:
        self.port = port
        self._programs = programs()
        self._folder = Path(tempfile.mkdtemp(prefix="arboleda-pg-", dir="/tmp"))
        self._as = {"user": _user(), "group": _user(), "extra_groups": []} if os.geteuid() == 0 else {}
        self._process: subprocess.Popen[bytes] | None = None
        if self._as:
            shutil.chown(self._folder, self._as["user"], pwd.getpwnam(self._as["user"]).pw_gid)
            self._as["group"] = pwd.getpwnam(self._as["user"]).pw_gid
        self._make()

    @property
    def address(self) -> str:
        return f"postgresql://{USER}@127.0.0.1:{self.port}/{DATABASE}"

    def start(self) -> None:
        options = [option for key, value in SETTINGS.items() for option in ("-c", f"{key}={value}")]
        self._process = self._started("postgres", "-D", str(self._data), "-p", str(self.port), *options)
        self.wait()

    def wait(self) -> None:
        """Until it answers."""
        for _ in range(100):
            try:
                with self.connection("postgres"):
                    return
            except psycopg.OperationalError:
                assert self._process is not None and self._process.poll() is None, "postgres has ended"
                signal.sigtimedwait([], 0.1)
        raise AssertionError("postgres does not answer")

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

    def _make(self) -> None:
        secret = self._folder / "secret"
        secret.write_text(PASSWORD)
        self._started(
            "initdb", "-D", str(self._data), "-U", USER, "--no-sync", "--auth=scram-sha-256",
            f"--pwfile={secret}", "--encoding=UTF8", "--locale=C",
        ).wait(60)  # fmt: skip
        self.start()
        with self.connection("postgres") as db:
            db.execute(f"CREATE DATABASE {DATABASE}")

    def _started(self, program: str, *words: str) -> subprocess.Popen[bytes]:
        with (self._folder / "log").open("ab") as log:
            return subprocess.Popen(
                [self._programs / program, *words], stdout=log, stderr=log, cwd="/", **self._as
            )


def _user() -> str:
    """Who runs it where tests are run by root, which PostgreSQL refuses."""
    names = {each.pw_name for each in pwd.getpwall()}
    return "postgres" if "postgres" in names else "nobody"
