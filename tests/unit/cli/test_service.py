"""`arboleda service`: what systemd is given and asked, and what is said where it does not do it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from arboleda.cli.main import main

Typed = Callable[..., tuple[int, str, str]]


class Systemd:
    """Does all but what `fails` names, and keeps what it was asked."""

    def __init__(self) -> None:
        self.asked: list[str] = []
        self.fails = "nothing"

    def run(self, command: Sequence[str], **_: object) -> CompletedProcess[str]:
        words = " ".join(command[1:])
        self.asked.append(words)
        if self.fails in words:
            return CompletedProcess(command, 1, "", "System has not been booted with systemd\n")
        return CompletedProcess(command, 0, "", "")


@pytest.fixture
def systemd(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Systemd:
    tools = tmp_path / "tools"
    tools.mkdir()
    (tools / "systemctl").touch(0o755)
    made = Systemd()
    monkeypatch.setattr(subprocess, "run", made.run)
    monkeypatch.setenv("PATH", str(tools))
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("XDG_STATE_HOME", raising=False)
    return made


@pytest.fixture
def typed(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Typed:
    """Exit status, output and complaint of `arboleda service`."""

    def run(*words: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["arboleda", "service", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        return (int(ended.value.code or 0), *capsys.readouterr())

    return run


@pytest.fixture
def written(tmp_path: Path) -> Path:
    return tmp_path / ".config/systemd/user/arboleda-arboleda.service"


def test_a_plant_is_installed_and_started(
    systemd: Systemd, typed: Typed, written: Path, tmp_path: Path
) -> None:
    status, said, _ = typed("install", "--", "--no-ros", "--rate", "2")
    assert status == 0 and str(written) in said and "loginctl enable-linger" in said
    assert [line for line in written.read_text().splitlines() if line.startswith("ExecStart=")] == [
        f"ExecStart={Path(sys.executable).with_name('arboleda')} up "
        f"--state {tmp_path}/.local/state/arboleda/arboleda --no-ros --rate 2"
    ]
    assert (tmp_path / ".local/state/arboleda/arboleda").is_dir()
    assert systemd.asked == [
        "--user daemon-reload",
        "--user enable arboleda-arboleda.service",
        "--user restart arboleda-arboleda.service",
    ]


def test_what_was_installed_is_looked_at_and_removed(systemd: Systemd, typed: Typed, written: Path) -> None:
    typed("install")
    assert typed("status")[0] == 0
    status, said, _ = typed("remove")
    assert status == 0 and not written.exists() and "state directory is as it was" in said
    assert systemd.asked[3:] == [
        "--user status --no-pager arboleda-arboleda.service",
        "--user disable --now arboleda-arboleda.service",
        "--user daemon-reload",
    ]


@pytest.mark.parametrize("fails", ["daemon-reload", "enable", "restart"])
@pytest.mark.parametrize("before", [None, "[Unit]\nDescription=an older one\n"])
def test_where_systemd_refuses_all_is_as_it_was(
    systemd: Systemd, typed: Typed, written: Path, fails: str, before: str | None
) -> None:
    if before is not None:
        written.parent.mkdir(parents=True)
        written.write_text(before)
    systemd.fails = fails
    status, _, said = typed("install")
    assert status == 1 and said.count("\n") == 1
    assert f"systemctl {fails}" in said and "System has not been booted with systemd" in said
    assert (written.read_text() if written.exists() else None) == before


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--", "--bords", "real"), "No such option: --bords"),
        (("--", "--state", "x"), "--state stands before --"),
        (("--plant", "/nowhere.yaml"), "/nowhere.yaml: there is no such file"),
    ],
)
def test_bad_input_is_refused_before_anything_is_written(
    systemd: object, typed: Typed, written: Path, words: tuple[str, ...], sentence: str
) -> None:
    status, _, said = typed("install", *words)
    assert status == 2 and sentence in said
    assert not written.exists()


@pytest.mark.parametrize("verb", ["status", "remove"])
def test_a_plant_that_is_no_service_is_named(systemd: object, typed: Typed, verb: str) -> None:
    status, _, said = typed(verb)
    assert status == 1 and said.startswith("arboleda: arboleda is no service here") and said.count("\n") == 1


def test_a_machine_without_systemd_is_told_what_else_there_is(
    typed: Typed, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    status, _, said = typed("install", "--state", str(tmp_path / "state"))
    assert status == 1 and "this machine has no systemd" in said and "`arboleda up`" in said


def test_a_user_that_is_not_there_is_refused(systemd: object, typed: Typed) -> None:
    status, _, said = typed("install", "--print", "--system", "--user", "nobody-here")
    assert status == 1 and "no user nobody-here" in said
