"""The users file of the embedded broker: NAME:PASSWORD lines."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.plant_file import user_file


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
