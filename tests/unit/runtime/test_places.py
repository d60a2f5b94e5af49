"""Which token a plant of a site is shown, and which files of tokens are refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError, StartError
from arboleda.runtime import endpoints
from arboleda.runtime.endpoints import Place, named, tokens_of, with_tokens

HERE = Place(url="http://127.0.0.1:8080", plant="here", token="h" * 20, certificate="PEM")


@pytest.fixture(autouse=True)
def _one_here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(endpoints, "of_this_machine", lambda: [HERE])


def test_a_plant_of_this_machine_is_shown_what_its_own_commands_show() -> None:
    (found,) = with_tokens(named(["http://127.0.0.1:8080/"]), {})()
    assert (found.token, found.certificate) == (HERE.token, "PEM")


def test_a_file_of_tokens_knows_plants_by_address_and_by_name(tmp_path: Path) -> None:
    file = tmp_path / "tokens"
    file.write_text("# ours\nhttp://a.lab:8080/ one\n\nsecond two  # by its name\n")
    file.chmod(0o600)
    known = tokens_of(file)
    find = with_tokens(
        lambda: [Place(url="http://a.lab:8080"), Place(url="http://b:1", plant="second"), Place(url="x")],
        known,
    )
    assert [place.token for place in find()] == ["one", "two", ""]


def test_a_file_that_others_can_read_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "tokens"
    file.write_text("a b\n")
    file.chmod(0o644)
    with pytest.raises(ConfigError, match="others can read the tokens"):
        tokens_of(file)


def test_a_line_that_is_no_pair_is_named(tmp_path: Path) -> None:
    file = tmp_path / "tokens"
    file.write_text("a b\nhttp://a.lab:8080\n")
    file.chmod(0o600)
    with pytest.raises(ConfigError, match="line 2: write the address or name of a plant, and its token"):
        tokens_of(file)


def test_what_is_no_address_is_refused() -> None:
    with pytest.raises(StartError, match="is not the address of a plant"):
        named(["a.lab:8080"])
