"""`arboleda tasks`, `backup` and `restore` on the memory of a plant that does not run."""

from __future__ import annotations

import csv
import json
import time
from dataclasses import replace
from io import StringIO
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.cli.tasks import moment
from arboleda.core.choosing import LATER
from arboleda.model.errors import StartError
from arboleda.model.messages import Check, Reason, TaskAnswer, TaskChanged, TaskState
from arboleda.model.sentence import OWN
from arboleda.model.task import UNCHECKED
from arboleda.runtime.state import StateDir
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import TaskQuery

NOW = time.time()


@pytest.fixture
def state(tmp_path: Path) -> Path:
    """The state of a plant that did one task, failed one, and has one that waits."""
    with Store(tmp_path / "plant.sqlite") as store:
        for id, text, ago_s in (("a", "sis_a 0B 1", 7200), ("b", "sis_b 0B 2", 60), ("c", "sis_a 1B 3", 30)):
            queued = TaskChanged(task=id, text=text, cell=text.split()[0], state=TaskState.QUEUED)
            store.tasks.keep(queued, "storage", NOW - ago_s)
        store.tasks.keep(told("a", TaskState.RUNNING), "", NOW - 7200)
        store.tasks.keep(told("a", TaskState.DONE), "", NOW - 7190)
        late = told("b", TaskState.FAILED, reason=Reason.DEADLINE, sentence=OWN(text="ra2: too late"))
        store.tasks.keep(late, "", NOW - 50)
    return tmp_path


def told(id: str, state: TaskState, **why: object) -> TaskChanged:
    return TaskChanged(task=id, text="", cell=None, state=state, **why)  # type: ignore[arg-type]


def said(*args: str, state: Path) -> str:
    outcome = CliRunner().invoke(cli, ["tasks", *args, "--state", str(state)], catch_exceptions=False)
    assert outcome.exit_code == 0, outcome.output
    return outcome.output


def ids(*args: str, state: Path) -> list[str]:
    return [json.loads(line)["id"] for line in said(*args, "--json", state=state).splitlines()]


def test_an_id_is_whole_in_one_line_of_a_narrow_terminal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    id, why = (
        "t-1795485914-1043",
        OWN(text="ra2: did not finish within 5.0 s while switching the effector on"),
    )
    with Store(tmp_path / "plant.sqlite") as store:
        queued = TaskChanged(task=id, text="sis_b 0B 2", cell="sis_b", state=TaskState.QUEUED)
        store.tasks.keep(queued, "storage", NOW)
        store.tasks.keep(told(id, TaskState.FAILED, reason=Reason.DEADLINE, sentence=why), "", NOW)
    assert id in said(state=tmp_path)


def test_all_tasks_are_shown_with_why_they_failed(state: Path) -> None:
    shown = said(state=state)
    assert "ra2: too late" in " ".join(shown.split()) and "10.0 s" in shown
    places = [shown.index(text) for text in ("sis_a 0B 1", "sis_b 0B 2", "sis_a 1B 3")]
    assert places == sorted(places)


@pytest.mark.parametrize(
    ("args", "expected"),
    [
        ((), ["a", "b", "c"]),
        (("--cell", "sis_a"), ["a", "c"]),
        (("--status", "failed"), ["b"]),
        (("--since", "1h"), ["b", "c"]),
        (("--until", "1h"), ["a"]),
        (("0b",), ["a", "b"]),
        (("--limit", "1"), ["c"]),
        (("--recipe", "palletizing"), []),
    ],
)
def test_tasks_are_filtered(args: tuple[str, ...], expected: list[str], state: Path) -> None:
    assert ids(*args, state=state) == expected


def test_a_table_for_other_programs_has_a_line_of_names(state: Path) -> None:
    rows = list(csv.DictReader(StringIO(said("--csv", state=state))))
    assert [(row["id"], row["state"]) for row in rows] == [("a", "done"), ("b", "failed"), ("c", "queued")]


def test_what_was_answered_is_in_the_list_where_anything_was(state: Path) -> None:
    assert "answers" not in said(state=state)
    with Store(state / "plant.sqlite") as store:
        heard = [
            TaskAnswer(by="ana", asked="Is it full?", answer=True),
            TaskAnswer(by="eye", asked="look", answer=2),
        ]
        store.tasks.keep(told("c", TaskState.DONE), "", NOW, answers=heard)
    shown = " ".join(said("--limit", "1", state=state).split())
    assert "why answers" in shown and "full?: yes; eye, look: 2" in shown
    (row,) = [json.loads(line) for line in said("--limit", "1", "--json", state=state).splitlines()]
    assert row["answers"][1] == {"by": "eye", "asked": "look", "answer": 2}
    (row,) = csv.DictReader(StringIO(said("--csv", "--limit", "1", state=state)))
    assert json.loads(row["answers"])[0]["by"] == "ana"


def test_why_a_task_is_done_in_its_cell_is_in_the_list(state: Path) -> None:
    why = LATER(cell="sis_b", seconds=12.5)
    with Store(state / "plant.sqlite") as store:
        store.tasks.keep(replace(told("d", TaskState.QUEUED), cell="sis_b", choice=why), "storage", NOW)
    assert "sis_b in 12 s" in " ".join(said("--limit", "1", state=state).split())
    (row,) = [json.loads(line) for line in said("--limit", "1", "--json", state=state).splitlines()]
    assert row["choice"]["key"] == "choice.later" and row["choice"]["english"] == "sis_b in 12 s"


def test_what_of_a_done_task_nobody_confirmed_is_in_the_list(state: Path) -> None:
    with Store(state / "plant.sqlite") as store:
        checks = (Check.GRIP,)
        done = told("c", TaskState.DONE, sentence=UNCHECKED[checks](), unchecked=checks)
        store.tasks.keep(done, "", NOW)
    why = "not checked: whether the part was gripped"
    assert why in " ".join(said("--limit", "1", state=state).split())
    (row,) = [json.loads(line) for line in said("--limit", "1", "--json", state=state).splitlines()]
    assert (row["state"], row["unchecked"], row["sentence"]) == ("done", ["grip"], why)
    (row,) = csv.DictReader(StringIO(said("--csv", "--limit", "1", state=state)))
    assert row["unchecked"] == "grip"


def test_where_nothing_was_kept_it_says_so(tmp_path: Path) -> None:
    assert said(state=tmp_path) == "no such task was kept\n"


@pytest.mark.parametrize("text", ["yesterday", "2026-13-01", "7", ""])
def test_what_is_no_time_is_refused_with_how_to_write_one(text: str) -> None:
    with pytest.raises(typer.BadParameter, match="write how long ago, as 30m"):
        moment(text)


def test_a_backup_is_the_memory_and_a_restore_puts_it_back(state: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy.sqlite"
    for command in (["backup", str(copy)], ["restore", str(copy)]):
        with Store(state / "plant.sqlite") as store:
            store.tasks.forget(NOW if command[0] == "restore" else 0.0)
        outcome = CliRunner().invoke(cli, [*command, "--state", str(state)], catch_exceptions=False)
        assert outcome.exit_code == 0, outcome.output
    assert ids(state=state) == ["a", "b", "c"]
    with Store(state / "plant.sqlite.before-restore") as store:
        assert [row.id for row in store.tasks.select(TaskQuery())] == ["c"]


def test_a_backup_overwrites_nothing(state: Path, tmp_path: Path) -> None:
    copy = tmp_path / "copy.sqlite"
    copy.write_text("mine")
    with pytest.raises(StartError, match="exists already; give the backup another name"):
        CliRunner().invoke(cli, ["backup", str(copy), "--state", str(state)], catch_exceptions=False)
    assert copy.read_text() == "mine"


@pytest.mark.parametrize(
    ("content", "sentence"),
    [(b"no database" * 200, "is no backup of a plant's memory"), (b"", "has lost its content")],
)
def test_what_is_no_backup_is_refused_and_changes_nothing(
    content: bytes, sentence: str, state: Path, tmp_path: Path
) -> None:
    wrong = tmp_path / "wrong.sqlite"
    wrong.write_bytes(content)
    with pytest.raises(StartError, match=sentence):
        CliRunner().invoke(cli, ["restore", str(wrong), "--state", str(state)], catch_exceptions=False)
    assert ids(state=state) == ["a", "b", "c"]


def test_nothing_is_restored_under_a_plant_that_runs(state: Path, tmp_path: Path) -> None:
    with StateDir(state), pytest.raises(StartError, match="End it first"):
        CliRunner().invoke(
            cli, ["restore", str(tmp_path / "x"), "--state", str(state)], catch_exceptions=False
        )


@pytest.mark.parametrize("verb", ["backup", "restore"])
def test_of_a_memory_in_a_database_no_file_is_made_and_what_does_it_is_said(
    verb: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("arboleda.cli.backup.store_of", lambda _plant: "postgresql://db/plants")
    command = [verb, str(tmp_path / "copy"), "--state", str(tmp_path)]
    with pytest.raises(
        StartError, match=r"is in postgresql://db/plants: `pg_dump .* pg_restore puts it back"
    ):
        CliRunner().invoke(cli, command, catch_exceptions=False)
    assert not (tmp_path / "copy").exists()
