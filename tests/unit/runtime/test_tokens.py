"""The file of tokens."""

from __future__ import annotations

import json
import stat
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.model.errors import StartError
from arboleda.runtime import tokens
from arboleda.runtime.state import StateDir
from arboleda.runtime.tokens import TOKENS, TokenFile
from arboleda.web.access.auth import Role


def test_tokens_are_made_once_long_and_for_their_owner_only(tmp_path: Path) -> None:
    known = tokens.read(tmp_path / "new")
    assert set(known) == set(Role) and len(set(known.values())) == len(Role)
    assert all(len(token) >= 32 for token in known.values())
    assert tokens.read(tmp_path / "new") == known
    assert stat.S_IMODE((tmp_path / "new" / TOKENS).stat().st_mode) == 0o600
    assert stat.S_IMODE((tmp_path / "new").stat().st_mode) == 0o700


def test_one_role_gets_a_new_token_and_the_other_keeps_its_own(tmp_path: Path) -> None:
    before, seen = tokens.read(tmp_path), TokenFile(tmp_path)
    assert seen() == before
    tokens.renew(tmp_path, [Role.VIEWER])
    assert seen()[Role.VIEWER] != before[Role.VIEWER]
    assert seen()[Role.OPERATOR] == before[Role.OPERATOR]
    tokens.renew(tmp_path, Role)
    assert not set(seen().values()) & set(before.values())


@pytest.mark.parametrize(
    "content",
    [
        "",
        "[]",
        "null",
        '{"viewer": "vvvvvvvvvvvvvvvvvvvvvvvv"}',
        '{"viewer": "short", "operator": "oooooooooooooooooooooooo"}',
        '{"viewer": 7, "operator": "oooooooooooooooooooooooo"}',
        '{"viewer": "same-same-same-same-same", "operator": "same-same-same-same-same"}',
    ],
)
def test_what_is_no_file_of_tokens_is_refused_with_the_way_out(tmp_path: Path, content: str) -> None:
    file = tmp_path / TOKENS
    file.touch(0o600)
    file.write_text(content)
    with pytest.raises(StartError, match="arboleda token --new"):
        tokens.read(tmp_path)
    tokens.renew(tmp_path, Role)
    assert set(tokens.read(tmp_path)) == set(Role)


@pytest.mark.parametrize("mode", [0o640, 0o604, 0o660])
def test_a_file_that_others_read_is_refused(tmp_path: Path, mode: int) -> None:
    tokens.read(tmp_path)
    (tmp_path / TOKENS).chmod(mode)
    with pytest.raises(StartError, match="Others can read the tokens"):
        tokens.read(tmp_path)


def test_a_state_directory_that_cannot_be_used_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(StartError, match="The tokens cannot be kept in"):
        tokens.renew(tmp_path / "file", Role)


def test_the_command_makes_nothing_where_no_plant_was(tmp_path: Path) -> None:
    for folder in (tmp_path / "typo", tmp_path):
        for words in (["operator"], ["--new"]):
            answer = CliRunner().invoke(cli, ["token", *words, "--state", str(folder)])
            assert isinstance(answer.exception, StartError), answer.output
            assert f"No plant keeps its state in {folder}" in str(answer.exception)
    assert list(tmp_path.iterdir()) == []


def test_the_command_shows_and_renews(tmp_path: Path) -> None:
    with StateDir(tmp_path):
        pass

    def said(*words: str) -> str:
        answer = CliRunner().invoke(cli, ["token", *words, "--state", str(tmp_path)])
        assert answer.exit_code == 0, answer.output
        return answer.output

    first = said("operator").strip()
    assert first == tokens.read(tmp_path)[Role.OPERATOR]
    assert first in said() and str(tmp_path / TOKENS) in said()
    assert said("operator", "--new").strip() not in ("", first)
    assert json.loads((tmp_path / TOKENS).read_text())["operator"] == said("operator").strip()


def test_an_unknown_role_is_bad_input(tmp_path: Path) -> None:
    assert CliRunner().invoke(cli, ["token", "admin", "--state", str(tmp_path)]).exit_code == 2


@pytest.mark.parametrize(
    "words",
    [("--host", "plant.example"), ("--port", "0"), ("--port", "65536"), ("--public-url", "plant.example")],
)
def test_an_address_that_cannot_be_is_bad_input(words: tuple[str, ...]) -> None:
    assert CliRunner().invoke(cli, ["up", "--no-ros", *words]).exit_code == 2
