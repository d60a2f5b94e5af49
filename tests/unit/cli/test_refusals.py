"""What a command refuses, with a sentence, before anything starts."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from tests.packages import PACKAGES, leave_out
from tests.tls_lab import Lab

from arboleda.cli.main import main

Typed = Callable[..., tuple[int, str]]


@pytest.fixture
def typed(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> Typed:
    """Exit status of a command, and all that it says, as one line."""
    monkeypatch.setenv("COLUMNS", "200")

    def run(*words: str) -> tuple[int, str]:
        monkeypatch.setattr(sys, "argv", ["arboleda", *words])
        monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
        with pytest.raises(SystemExit) as ended:
            main()
        said = " ".join(" ".join(capsys.readouterr()).replace("│", " ").split())
        assert "Traceback" not in said and "broker: " not in said
        return int(ended.value.code or 0), said

    return run


@pytest.mark.parametrize(
    ("args", "sentence"),
    [
        (("sis_z 0B 7", "sis_a 0B 9"), "'sis_z' is not a cell"),
        (("sis_a 0B 9",), "'9' is not a station"),
        (("sis_a 0B 7", "--plant", "nowhere.yaml"), "nowhere.yaml: there is no such file"),
        (("sis_a 0B 7", "--rate", "0"), "0 is not a rate; allowed: 0.1 to 100"),
        (("sis_a 0B 7", "--broker", "host:port"), "is not a broker address"),
        ((), "--once does the tasks that are named, and ends"),
        (("sis_a 0B 7", "--demo"), "--once does the tasks that are named, and ends"),
    ],
    ids=["cell", "station", "plant", "rate", "broker", "no task", "no end"],
)
def test_up_once_refuses_bad_input(typed: Typed, args: tuple[str, ...], sentence: str) -> None:
    status, said = typed("up", "--once", *args)
    assert status == 2 and sentence in said


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, ...]:
    """The options that show a certificate."""
    certificate, key = Lab(tmp_path_factory.mktemp("tls") / "certs").sign("localhost")
    return "--tls-cert", str(certificate), "--tls-key", str(key)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--tls-key", "x"), "--tls-key needs a certificate: --tls-cert FILE"),
        (("--broker-tls",), "--broker-tls needs a certificate: --tls-cert FILE"),
        (("--broker-ca", "x"), "--broker-ca is for boards that speak TLS: it needs --broker-tls"),
        (("--broker-tls", "--shown"), "--broker-tls is for boards of other machines: it needs --broker-host"),
        (("--tls-cert", "none.crt"), "none.crt and its key in it are of no use (No such file or directory)"),
    ],
)
def test_options_of_tls_that_do_not_fit_are_refused(
    typed: Typed, shown: tuple[str, ...], words: tuple[str, ...], sentence: str
) -> None:
    given = [each for word in words for each in (shown if word == "--shown" else (word,))]
    status, said = typed("up", "--once", "sis_a 0B 7", "--no-ros", *given)
    assert status in (1, 2) and sentence in said


def test_without_their_package_the_firmwares_boards_are_refused_with_what_to_install(
    typed: Typed, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    leave_out(monkeypatch, tmp_path / "site", *PACKAGES)
    status, said = typed("up", "--once", "sis_a 0B 7", "--no-ros", "--boards", "linux")
    assert status == 1 and "--boards linux needs the package boards" in said


def test_a_demonstration_beside_real_boards_is_refused(typed: Typed) -> None:
    status, said = typed("up", "--no-ros", "--demo", "--boards", "real")
    assert status == 2 and "--demo has boards fail, so it is for virtual ones alone" in said


def test_a_png_is_not_poured_into_a_terminal(typed: Typed, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    status, said = typed("tree", "storage", "--format", "png")
    assert status == 2 and "add > storage.png" in said


@pytest.mark.parametrize(
    ("shell", "typed_so_far"),
    [
        ("bash", {"COMP_WORDS": "arboleda sub", "COMP_CWORD": "1"}),
        ("zsh", {"_TYPER_COMPLETE_ARGS": "arboleda sub"}),
        ("fish", {"_TYPER_COMPLETE_ARGS": "arboleda sub", "_TYPER_COMPLETE_FISH_ACTION": "get-args"}),
    ],
)
def test_shells_complete_the_command(
    typed: Typed, monkeypatch: pytest.MonkeyPatch, shell: str, typed_so_far: dict[str, str]
) -> None:
    for name, value in {"_ARBOLEDA_COMPLETE": f"complete_{shell}", **typed_so_far}.items():
        monkeypatch.setenv(name, value)
    status, said = typed()
    assert status == 0 and "submit" in said
