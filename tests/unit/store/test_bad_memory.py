"""A memory that cannot be used: one sentence, an exit status and nothing half done, by whatever command."""

from __future__ import annotations

import resource
import sqlite3
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path

import pytest
from tests.rights import modes_count

from arboleda.cli import main, session
from arboleda.model.messages import Fact, Remember, TaskChanged, TaskState
from arboleda.runtime import build
from arboleda.store import row_sums
from arboleda.store.memory_file import VERSION
from arboleda.store.sqlite import Store

STARTS = ("up", "up --once")
ALL = (*STARTS, "tasks", "backup", "restore")
SHIPPED = files("arboleda").joinpath("plants/plant.yaml")
LATCH = Remember(fact=Fact.LATCH, name="ra1", value="on")


class Refused(Exception):
    """A plant that must not have started did."""


@pytest.fixture(autouse=True)
def _at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nobody waits for a lock, no plant runs whose memory was not refused, a process has one page at most."""
    monkeypatch.setattr(build, "PARTS", tuple(part for part in build.PARTS if part != "web"))
    for module in ("sqlite", "memory_file", "backups"):
        monkeypatch.setattr(f"arboleda.store.{module}.BUSY_S", 0)

    def run(_: session.Session) -> int:
        raise Refused

    monkeypatch.setattr(session.Session, "run", run)


@pytest.fixture(scope="module")
def filled(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The memory of a plant with tasks."""
    path = tmp_path_factory.mktemp("filled") / "plant.sqlite"
    fill(path)
    return path.read_bytes()


@pytest.fixture
def memory(tmp_path: Path, filled: bytes) -> Path:
    """That of a plant with a task, in its state directory; beside that, a good backup of it."""
    for name in ("state", "other"):
        (tmp_path / name).mkdir()
    path = tmp_path / "state" / "plant.sqlite"
    path.write_bytes(filled)
    (tmp_path / "backup.sqlite").write_bytes(filled)
    return path


def fill(path: Path, plant: str = "arboleda") -> None:
    with Store(path, plant) as store:
        store.keep(LATCH)
        for number in range(50):
            text = f"sis_a 0B {number % 9}"
            store.tasks.keep(
                TaskChanged(task=f"t{number}", text=text, cell="sis_a", state=TaskState.QUEUED),
                "storage",
                1.0,
            )


def carried_out(
    command: str, memory: Path, capsys: pytest.CaptureFixture[str], *more: str
) -> tuple[int, str]:
    """Exit status and standard error of a command on the memory."""
    folder = memory.parent.parent
    words = {
        "up": ["--no-ros"],
        "up --once": ["--no-ros", "sis_a 0B 1"],
        "tasks": [],
        "backup": [str(folder / "other" / "new.sqlite")],
        "restore": [str(folder / "backup.sqlite")],
    }
    status = 0
    with pytest.MonkeyPatch.context() as patch:
        where = ["--state", str(memory.parent)]
        patch.setattr(sys, "argv", ["arboleda", *command.split(), *words[command], *where, *more])
        try:
            main.main()
        except SystemExit as end:
            status = int(end.code or 0)
    return status, capsys.readouterr().err


def refusal(command: str, memory: Path, capsys: pytest.CaptureFixture[str], *more: str) -> str:
    """The one sentence, after it is seen that nothing has changed."""
    before = contents(memory.parent.parent)
    status, said = carried_out(command, memory, capsys, *more)
    assert status == 1
    assert said.startswith("arboleda: ") and said.count("\n") == 1 and said.endswith(".\n")
    assert contents(memory.parent.parent) == before
    return said


def contents(folder: Path) -> dict[str, bytes]:
    """All files but the lock of the state directory, and what SQLite makes for who reads."""
    passing = ("plant.lock", "plant.sqlite-shm", "plant.sqlite-wal", "backup.sqlite-shm", "backup.sqlite-wal")
    files = [path for path in folder.rglob("*") if path.is_file() and path.name not in passing]
    return {str(path.relative_to(folder)): path.read_bytes() for path in files}


@contextmanager
def full_disk(bytes_: int = 0) -> Iterator[None]:
    """The limit for the size of files stands for it."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def spoil(change: Callable[[sqlite3.Connection], object]) -> Callable[[Path], None]:
    def spoiled(path: Path) -> None:
        db = sqlite3.connect(path)
        change(db)
        db.commit()
        db.close()

    return spoiled


def overwrite(path: Path) -> None:
    """All but the first page, which says what it is."""
    size = path.stat().st_size
    path.write_bytes(path.read_bytes()[:4096] + b"\xaa" * (size - 4096))


BAD: dict[str, tuple[Callable[[Path], object], str]] = {
    "corrupt": (overwrite, "malformed"),
    "no database": (lambda path: path.write_bytes(b"Dear diary, " * 500), "file is not a database"),
    "empty": (lambda path: path.write_bytes(b""), "has lost its content, or is another program's"),
    "newer": (
        spoil(lambda db: db.execute(f"PRAGMA user_version = {VERSION + 1}")),
        f"is of a newer Arboleda (format {VERSION + 1}, known: {VERSION})",
    ),
}


@pytest.mark.parametrize("what", BAD)
@pytest.mark.parametrize("command", ALL)
def test_a_memory_that_is_none_is_refused(
    command: str, what: str, memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`restore` is what one does about it: there it is the backup that is bad."""
    spoiled, sentence = BAD[what]
    spoiled(memory.parent.parent / "backup.sqlite" if command == "restore" else memory)
    assert sentence in refusal(command, memory, capsys)


@pytest.mark.parametrize("what", BAD)
def test_a_good_backup_takes_the_place_of_whatever_is_there(
    what: str, memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    BAD[what][0](memory)
    bad = memory.read_bytes()
    assert carried_out("restore", memory, capsys) == (0, "")
    with Store(memory) as store:
        assert store.facts(Fact.LATCH) == {"ra1": "on"}
    assert memory.with_name("plant.sqlite.before-restore").read_bytes() == bad


@pytest.mark.parametrize("command", ALL)
def test_a_memory_that_another_program_has_locked_is_refused(
    command: str, memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    other = sqlite3.connect(memory, isolation_level=None)
    other.execute("PRAGMA locking_mode = EXCLUSIVE")
    other.execute("BEGIN EXCLUSIVE")
    try:
        said = refusal(command, memory, capsys)
        assert "(database is locked): close the other program" in said
    finally:
        other.close()


@pytest.mark.sampled(3)
@pytest.mark.parametrize("command", [*STARTS, "restore"])
def test_a_memory_that_may_not_be_written_is_refused(
    command: str, memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    memory.chmod(0o444)
    memory.parent.chmod(0o555)
    with modes_count():
        assert "cannot be used: Permission denied" in refusal(command, memory, capsys)
    memory.parent.chmod(0o755)


@pytest.mark.parametrize("command", ["tasks", "backup"])
def test_a_memory_that_may_not_be_written_is_read(
    command: str, memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    memory.chmod(0o444)
    memory.parent.chmod(0o555)
    (memory.parent.parent / "other").chmod(0o777)
    with modes_count():
        assert carried_out(command, memory, capsys) == (0, "")
    memory.parent.chmod(0o755)


@pytest.mark.parametrize("command", [*STARTS, "backup", "restore"])
def test_a_full_disk_is_refused(command: str, memory: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with full_disk():
        assert "make room" in refusal(command, memory, capsys)


def test_a_disk_that_gets_full_in_the_middle_of_a_restore_leaves_what_was_there(
    memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with full_disk(8192):
        assert "cannot be written" in refusal("restore", memory, capsys)


@pytest.mark.parametrize("command", [*STARTS, "restore"])
def test_a_memory_of_another_plant_is_refused(
    command: str, memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    memory.unlink()
    fill(memory, "bakery")
    assert "'bakery'" in refusal(command, memory, capsys)


@pytest.mark.parametrize("command", ["tasks", "backup"])
def test_who_names_a_plant_is_refused_the_memory_of_another_one(
    command: str, memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    memory.unlink()
    fill(memory, "bakery")
    named = ("--plant", str(SHIPPED))
    assert "is of the plant 'bakery', and this is 'arboleda'" in refusal(command, memory, capsys, *named)
    assert carried_out(command, memory, capsys)[0] == 0, "who names only the directory has what is there"


@pytest.mark.parametrize("command", ["tasks", "backup"])
def test_who_names_the_plant_has_its_memory(
    command: str, memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert carried_out(command, memory, capsys, "--plant", str(SHIPPED)) == (0, "")


def test_a_backup_of_another_plant_is_refused(memory: Path, capsys: pytest.CaptureFixture[str]) -> None:
    backup = memory.parent.parent / "backup.sqlite"
    backup.unlink()
    fill(backup, "bakery")
    assert "is of the plant 'bakery', and this is 'arboleda'" in refusal("restore", memory, capsys)


def test_a_memory_without_a_name_becomes_that_of_its_plant(
    memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    spoil(lambda db: db.execute("DELETE FROM fact WHERE fact = 'plant'"))(memory)
    with pytest.raises(Refused):
        carried_out("up", memory, capsys)
    with Store(memory) as store:
        store.keep(LATCH)
    with pytest.raises(Exception, match="is of the plant 'arboleda', and this is 'bakery'"):
        Store(memory, "bakery").open()


@pytest.mark.parametrize("command", ["up", "tasks", "backup"])
def test_a_row_that_is_not_as_it_was_written_is_one_sentence(
    command: str, memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    spoil(lambda db: db.execute("UPDATE task SET text = 'sis_a 0B 5' WHERE number = 3"))(memory)
    assert "(a row is not as it was written): move it away" in refusal(command, memory, capsys)


def test_a_row_of_another_type_is_one_sentence(memory: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def change(db: sqlite3.Connection) -> None:
        row_sums.know(db)
        row_sums.watch(db)
        db.execute("UPDATE task SET accepted_s = 'noon' WHERE number = 3")

    spoil(change)(memory)
    assert "'t2' what is of another type than it wrote" in refusal("tasks", memory, capsys)


def test_a_memory_of_an_older_format_is_not_read_before_the_plant_brings_it_up(
    memory: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    spoil(lambda db: db.execute(f"PRAGMA user_version = {VERSION - 1}"))(memory)
    assert "is of an older Arboleda: start the plant once" in refusal("tasks", memory, capsys)
