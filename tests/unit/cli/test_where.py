"""Which plant a command finds, and what is said where it finds none."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import ExitStack
from importlib.resources import files
from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml
from tests.added_package import install

from arboleda.cli import remote_plant
from arboleda.cli import submit as command
from arboleda.cli.client import PlantClient
from arboleda.cli.main import main
from arboleda.cli.plant_options import located
from arboleda.model.errors import ArboledaError
from arboleda.runtime.state import StateDir, default_state, running_plants
from arboleda.store import schemes

Typed = Callable[..., tuple[int, str, str]]
SHIPPED = files("arboleda").joinpath("plants/plant.yaml")


@pytest.fixture
def up(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[[str], Path]:
    """Has a plant of that name run on its default state directory."""
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    with ExitStack() as stack:
        yield lambda name: stack.enter_context(StateDir(default_state(name))).path


@pytest.fixture
def typed(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Typed:
    """Exit status, output and complaint of a command."""

    def run(*words: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["arboleda", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        return (int(ended.value.code or 0), *capsys.readouterr())

    return run


def test_the_only_plant_that_runs_is_found_and_named(up, capsys: pytest.CaptureFixture[str]) -> None:
    path = up("greenhouse")
    assert located(None, None) == path
    assert capsys.readouterr().err == "plant greenhouse, the only one that runs\n"


def test_the_shipped_plant_is_meant_where_it_runs(up, capsys: pytest.CaptureFixture[str]) -> None:
    shipped = [up(name) for name in ("greenhouse", "arboleda")][-1]
    assert located(None, None) == shipped
    assert capsys.readouterr().err == ""


def test_who_names_a_plant_means_no_other(up, tmp_path: Path) -> None:
    up("greenhouse")
    assert located(None, tmp_path / "elsewhere") == tmp_path / "elsewhere"
    with pytest.raises(ArboledaError) as refused:
        PlantClient(tmp_path / "elsewhere").status()
    assert str(refused.value) == (
        f"No plant is running on {tmp_path}/elsewhere; "
        f"the one that runs is greenhouse (--state {tmp_path}/arboleda/greenhouse)."
    )


def test_of_two_plants_none_is_guessed_and_both_are_named(up, typed: Typed, tmp_path: Path) -> None:
    for name in ("greenhouse", "attic"):
        up(name)
    assert [path.name for path in running_plants()] == ["attic", "greenhouse"]
    status, _, said = typed("stop")
    own = tmp_path / "arboleda"
    assert status == 1
    assert said.endswith(
        f"those that run are attic (--state {own}/attic), greenhouse (--state {own}/greenhouse).\n"
    )


def left_behind(path: Path, store: str = "") -> Path:
    """A plant ran there."""
    with StateDir(path, plant=path.name, store=store):
        return path


def test_where_nothing_runs_the_only_plant_that_other_hosts_may_lead_is_found_and_named(
    up, capsys: pytest.CaptureFixture[str]
) -> None:
    left_behind(default_state("attic"))
    path = left_behind(default_state("greenhouse"), "postgresql://db")
    assert located(None, None) == path
    assert capsys.readouterr().err == "plant greenhouse, the only one here whose memory is in a database\n"
    shipped = left_behind(default_state("arboleda"), "postgresql://db")
    assert located(None, None) == shipped
    assert capsys.readouterr().err == ""


class Others:
    """Nobody leads."""

    name = "the database"

    def leader(self) -> SimpleNamespace:
        return SimpleNamespace(leads=False, standbys=0)

    def close(self) -> None: ...


@pytest.mark.parametrize(
    ("options", "asked"),
    [
        ((), ("postgresql://last", "greenhouse")),
        (("--store", "postgresql://named"), ("postgresql://named", "greenhouse")),
        (("--plant", "FILE"), ("shelf://file", "attic")),
    ],
)
def test_the_database_is_the_one_that_is_named_else_of_the_file_else_of_the_last_start(
    up,
    typed: Typed,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    options: tuple[str, ...],
    asked: tuple[str, str],
) -> None:
    monkeypatch.syspath_prepend(tmp_path / "site")
    install(tmp_path / "site", "shelf", "class Shelf: ...", group=schemes.GROUP, what="Shelf")
    state = left_behind(default_state("greenhouse"), "postgresql://last")
    file = tmp_path / "plant.yaml"
    shipped = yaml.safe_load(SHIPPED.read_text())
    file.write_text(yaml.safe_dump(shipped | {"name": "attic", "store": "shelf://file"}))
    found: list[tuple[str, str]] = []
    monkeypatch.setattr(remote_plant, "leadership_of", lambda *which: found.append(which) or Others())
    chosen = [str(file) if word == "FILE" else word for word in options]
    status, _, said = typed("status", "--state", str(state), *chosen)
    assert (status, found) == (1, [asked])
    assert f"No plant is running on {state}. Nobody leads the plant of the database now." in said


def test_without_any_plant_it_is_said_how_to_start_or_name_one(up, typed: Typed) -> None:
    status, _, said = typed("status")
    assert status == 1
    assert "start one with `arboleda up`, or name its directory where it was started with --state" in said


def test_what_a_plant_left_behind_is_not_taken_for_one_that_runs(up, tmp_path: Path) -> None:
    (tmp_path / "arboleda" / "old").mkdir(parents=True)
    (tmp_path / "arboleda" / "old" / "plant.lock").touch()
    assert running_plants() == []


def test_tasks_beside_a_plant_that_is_up_says_what_to_type(up, typed: Typed, tmp_path: Path) -> None:
    up("arboleda")
    status, _, said = typed("up", "--once", "--no-ros", "sis_a 0B 7", "sis_b 1C 3 #lot")
    lines = said.splitlines()
    assert status == 1
    assert lines[0].startswith("arboleda: A plant is already running on ")
    assert lines[0].endswith("To have it do this, type:")
    assert lines[1:3] == ["  arboleda submit 'sis_a 0B 7'", "  arboleda submit 'sis_b 1C 3 #lot'"]
    assert lines[3].endswith("ROS_DOMAIN_ID=N arboleda up --once --state DIR ...")


def test_up_once_names_the_state_directory_that_was_given(up, typed: Typed, tmp_path: Path) -> None:
    with StateDir(tmp_path / "own place"):
        _, _, said = typed("up", "--once", "--state", str(tmp_path / "own place"), "sis_a 0B 7")
    assert f"  arboleda submit --state '{tmp_path}/own place' 'sis_a 0B 7'" in said.splitlines()


class Answers:
    """A plant that knows the task already."""

    def __init__(self, state: str) -> None:
        self.state = state

    def submit(self, text: str) -> dict[str, str]:
        return {"id": "lot42", "text": "sis_a 0B 7", "state": self.state, "sentence": ""}


@pytest.mark.parametrize(
    ("state", "status"), [("queued", 0), ("running", 0), ("done", 0), ("failed", 1), ("cancelled", 1)]
)
def test_submit_of_an_id_whose_task_failed_ends_with_1(
    state: str, status: int, typed: Typed, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(command, "client", lambda *_: Answers(state))
    ended, out, said = typed("submit", "sis_a 0B 7 #lot42")
    assert (ended, out) == (status, f"{state}: sis_a 0B 7 (id lot42)\n")
    assert ("give another id" in said) is (status == 1)


def test_the_environment_names_the_plant(
    typed: Typed, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("ARBOLEDA_PLANT", str(tmp_path / "lab.yaml"))
    status, _, said = typed("up")
    assert status == 2 and str(tmp_path / "lab.yaml") in said


def test_the_environment_names_the_state_directory(
    typed: Typed, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("ARBOLEDA_STATE", str(tmp_path))
    assert f"No plant is running on {tmp_path};" in typed("status")[2]
    assert "No plant is running on /elsewhere;" in typed("status", "--state", "/elsewhere")[2]


@pytest.fixture
def own_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """The working directory, with a plant file of a plant called own."""
    folder = tmp_path / "own"
    folder.mkdir()
    said = yaml.safe_load(SHIPPED.read_text("utf-8"))
    (folder / "plant.yaml").write_text(yaml.safe_dump({**said, "name": "own"}), "utf-8")
    monkeypatch.chdir(folder)
    return folder


def test_the_plant_of_the_working_directory_is_meant_where_it_runs(up, own_folder: Path) -> None:
    up("arboleda")
    own = up("own")
    assert located(None, None) == own


def test_the_plant_of_the_working_directory_is_left_out_where_it_does_not_run(up, own_folder: Path) -> None:
    shipped = up("arboleda")
    assert located(None, None) == shipped


def test_the_plant_file_of_the_working_directory_is_checked(typed: Typed, own_folder: Path) -> None:
    status, out, _ = typed("check")
    assert (status, out.splitlines()[0][:35]) == (0, "plant.yaml: good: plant own; cells ")


def test_where_there_is_no_plant_file_the_one_to_check_has_to_be_named(
    typed: Typed, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    status, _, complaint = typed("check")
    assert status == 2
    assert "there is no plant.yaml in this folder; name the file to check" in " ".join(complaint.split())


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The plant file that the environment names; other.yaml stands beside it."""
    for name in ("lab", "other"):
        (tmp_path / f"{name}.yaml").write_text(SHIPPED.read_text("utf-8").replace("arboleda", name), "utf-8")
    monkeypatch.setenv("ARBOLEDA_PLANT", str(tmp_path / "lab.yaml"))
    return tmp_path / "lab.yaml"


def test_the_plant_of_the_environment_is_checked_where_none_is_named(lab: Path, typed: Typed) -> None:
    other = str(lab.with_name("other.yaml"))
    for words, file in (((), str(lab)), ((other,), other), (("--plant", other), other)):
        status, out, complaint = typed("check", *words)
        assert (status, out.split(": good")[0]) == (0, file), complaint
