"""Whatever a person names as a file, and the users of a broker: read, or refused at once with a sentence."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError
from arboleda.plant_file import user_file

READS = {
    "check": lambda file: ["check", file],
    "plant": lambda file: ["up", "--once", "sis_a 0B 7", "--no-ros", "--plant", file],
    "users": lambda file: ["up", "--no-ros", "--broker-host", "127.0.0.1", "--broker-users", file],
}


def sparse(path: Path) -> str:
    with path.open("wb") as file:
        file.truncate(30_000_000)
    return str(path)


def pipe(path: Path) -> str:
    os.mkfifo(path)
    return str(path)


def directory(path: Path) -> str:
    path.mkdir()
    return str(path)


def latin_1(path: Path) -> str:
    path.write_bytes("contraseña: sí\n".encode("latin-1"))
    return str(path)


STRANGE = {
    "pipe": (pipe, "is not a regular file"),
    "device": (lambda path: "/dev/zero", "is not a regular file"),
    "directory": (directory, "is a directory"),
    "huge": (sparse, "is larger than"),
    "latin-1": (latin_1, "is not UTF-8 text; save it as UTF-8"),
}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("words", READS.values(), ids=READS)
@pytest.mark.parametrize(("make", "sentence"), STRANGE.values(), ids=STRANGE)
def test_a_strange_file_is_refused_at_once(
    tmp_path: Path, words: Callable[[str], list[str]], make: Callable[[Path], str], sentence: str
) -> None:
    answer = CliRunner().invoke(cli, words(make(tmp_path / "strange.json")))
    assert isinstance(answer.exception, ConfigError), answer.output
    assert sentence in str(answer.exception) and len(answer.exception.problems) == 1


def test_a_name_that_no_file_can_have_is_refused(tmp_path: Path) -> None:
    for name in ("x" * 300, "a\0b"):
        with pytest.raises(ConfigError):
            user_file.read_bytes(tmp_path / name, 10)
        with pytest.raises(ConfigError):
            user_file.check_writable(tmp_path / name)


def test_the_largest_file_is_read_and_a_target_is_made(tmp_path: Path) -> None:
    file = tmp_path / "file"
    user_file.check_writable(file)
    file.write_bytes(b"\xef\xbb\xbf1234")
    user_file.check_writable(file)
    assert user_file.read_bytes(file, 7) == b"\xef\xbb\xbf1234"
    assert user_file.read_text(file, 7) == "1234"
    with pytest.raises(ConfigError, match="is larger than 0 KiB"):
        user_file.read_bytes(file, 6)


def write(tmp_path: Path, raw: bytes) -> Path:
    file = tmp_path / "users"
    file.write_bytes(raw)
    return file


def test_lines_are_names_and_passwords(tmp_path: Path) -> None:
    file = write(tmp_path, b"# boards\nra_1:a:b #c\r\n\n rm_sis_a :x\n")
    assert user_file.broker_users(file) == {"ra_1": "a:b #c", "rm_sis_a": "x"}


@pytest.mark.parametrize(
    ("raw", "sentences"),
    [
        (b"ra_1\n:secret\nra_2:\n", ["1:1: must be NAME", "2:1: must be NAME", "3:1: must be NAME"]),
        (b"a:secret\na:secret\n", ['2:1: the user "a" is there twice']),
        (b"\n", [" names no user"]),
        (b"a:\xff\n", [" is not UTF-8 text"]),
    ],
    ids=["half a line", "twice", "empty", "not text"],
)
def test_a_bad_file_is_refused_without_showing_a_password(
    tmp_path: Path, raw: bytes, sentences: list[str]
) -> None:
    file = write(tmp_path, raw)
    with pytest.raises(ConfigError) as refusal:
        user_file.broker_users(file)
    for problem, sentence in zip(refusal.value.problems, sentences, strict=True):
        assert problem.startswith(f"{file}:{sentence}")
    assert "secret" not in str(refusal.value)
