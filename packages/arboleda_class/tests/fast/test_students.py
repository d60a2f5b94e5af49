"""`arboleda class`: a plant for each student, and what lets teacher and students in."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from arboleda.cli.main import cli
from arboleda.plant_file import loader
from arboleda.runtime import tokens
from arboleda.runtime.endpoints import tokens_of
from arboleda.web.access.auth import Role


def write(folder: Path, *words: str) -> Result:
    options = ["--folder", str(folder), "--address", "10.0.0.5"]
    return CliRunner().invoke(cli, ["class", *words, *options])


def test_each_student_has_a_plant_and_what_lets_in_both(tmp_path: Path) -> None:
    said = write(tmp_path, "ana", "luis")
    assert said.exit_code == 0, said.output
    shown = tokens_of(tmp_path / "tokens")
    for name, address in (("ana", "http://10.0.0.5:8081"), ("luis", "http://10.0.0.5:8082")):
        assert loader.load(tmp_path / name / "plant.yaml").name == name
        inside = tokens.TokenFile(tmp_path / name / "state")()
        assert shown[address] == inside[Role.VIEWER]
        assert f"{address}  {inside[Role.OPERATOR]}" in said.output
        assert f"--port {address[-4:]} --plant {tmp_path / name / 'plant.yaml'}" in said.output
        assert inside[Role.VIEWER] not in said.output
    assert f"site http://10.0.0.5:8081 http://10.0.0.5:8082 --tokens {tmp_path / 'tokens'}" in said.output


def test_called_again_it_adds_and_leaves_work_tokens_and_addresses_as_they_are(tmp_path: Path) -> None:
    write(tmp_path, "ana")
    work, file = tmp_path / "ana/recipes.py", tmp_path / "tokens"
    work.write_text("# mine\n", "utf-8")
    file.write_text(file.read_text("utf-8").replace("10.0.0.5:8081", "10.0.0.9:8080"), "utf-8")
    before = {each: each.read_bytes() for each in tmp_path.rglob("*") if each.is_file() and each != file}
    said = write(tmp_path, "luis", "ana")
    assert said.exit_code == 0 and "http://10.0.0.9:8080  " in said.output
    assert {each: each.read_bytes() for each in before} == before
    assert list(tokens_of(file)) == ["http://10.0.0.9:8080", "http://10.0.0.5:8081"]


def test_wrong_names_are_refused_all_at_once_and_nothing_is_written(tmp_path: Path) -> None:
    (tmp_path / "eva").mkdir()
    said = write(tmp_path, "ana", "José", "luis", "luis", "eva")
    assert said.exit_code != 0
    assert [each.name for each in tmp_path.iterdir()] == ["eva"]
    problems = str(said.exception)
    assert len(problems.splitlines()) == 3
    assert "'José' cannot be the name of a plant" in problems
    assert "luis is there 2 times" in problems and "eva is there already" in problems


@pytest.mark.parametrize("words", [("--port", "65535", "luis"), ("--address", "the lab")])
def test_wrong_addresses_are_refused_with_nothing_written(tmp_path: Path, words: tuple[str, ...]) -> None:
    options = ["--folder", str(tmp_path / "class"), "--address", "10.0.0.5"]
    said = CliRunner().invoke(cli, ["class", "ana", *options, *words])
    assert said.exit_code != 0 and str(said.exception)
    assert not (tmp_path / "class").exists()


def test_without_a_network_the_address_has_to_be_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("arboleda.web.access.names.interface_addresses", lambda: ["127.0.0.1"])
    said = CliRunner().invoke(cli, ["class", "ana", "--folder", str(tmp_path / "class")])
    assert "--address" in str(said.exception) and not (tmp_path / "class").exists()
