"""A memory that is older than what the plant has told is refused, whichever of its files was damaged."""

from __future__ import annotations

import random
import shutil
import sqlite3 as sql
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from tests.lengths import length

from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.messages import Fact, Remember
from arboleda.store import backups, main_file, sqlite
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import TaskQuery

from .memory_samples import ACT, LATCH, ended, queued

HEADER = 32  # bytes of a log, which SQLite syncs before it writes over the log of before
PAGE = 4096  # bytes of a page of a memory
BLOCK = 512  # bytes that a disk writes as a whole
ENDS = ("kill", "power cut")
FILES = ("plant.sqlite", "plant.sqlite-wal", "plant.sqlite-shm", "plant.sqlite-ahead", "plant.told")
FEW = 12  # commits after which these memories fold their logs

Kept = tuple[object, ...]


def kept(store: Store) -> Kept:
    """All that people may have heard of."""
    tasks = [(row.id, row.state) for row in store.tasks.select(TaskQuery(limit=None))]
    return [store.facts(fact) for fact in Fact], tasks, [act.unix_s for act in store.acts.last()]


@dataclass
class Life:
    """A plant's memory at work: what it kept after each write, how many of them were told, and what a power
    cut leaves of its files."""

    folder: Path
    chance: random.Random
    states: list[Kept] = field(default_factory=list)
    last: int = 0  # the last write that was told
    told: int = 0  # the last one of which the mark says so that is left
    log: bytes = b""  # as it was synced
    marks: list[tuple[bytes, int]] = field(default_factory=lambda: [(b"", 0)])  # those that it may leave

    def run(self, acts: int) -> Store:
        store = Store(self.folder / "plant.sqlite")
        store.open()
        store.begin()
        self.states.append(kept(store))
        for number in range(acts):
            self._write(store, number)
            self._see_the_log()
            self.states.append(kept(store))
            if self.chance.random() < 0.4:
                self._tell(store)
            if self.chance.random() < 0.3:
                self._fold(store)
        return store

    def _write(self, store: Store, number: int) -> None:
        value = self.chance.choice(("on", "off", None))
        deeds: Sequence[Callable[[], object]] = (
            lambda: store.keep(Remember(fact=Fact.LATCH, name=f"ra{number % 3}", value=value)),
            lambda: store.note(Remember(fact=Fact.STEP, name=f"t{number % 3}", value=str(number))),
            lambda: store.acts.keep(ACT, float(number)),
            lambda: store.tasks.keep(queued(f"t{number}"), "storage", float(number)),
            lambda: store.tasks.keep(ended(f"t{number // 2}"), "storage", float(number)),
        )
        self.chance.choice(deeds)()
        if self.chance.random() < 0.7:
            store.settle()

    def _tell(self, store: Store) -> None:
        store.settle()
        store.sync()
        self.last = self.told = len(self.states) - 1
        self.log = self._file("plant.sqlite-wal")
        self.marks.append((self._file("plant.told"), self.told))

    def _fold(self, store: Store) -> None:
        before = (self.folder / "plant.sqlite").read_bytes()
        store.fold()
        if self._file("plant.sqlite") != before and self._file("plant.told") != self.marks[-1][0]:
            self.marks = [(self._file("plant.told"), self.told)]

    def _see_the_log(self) -> None:
        begun = self._file("plant.sqlite-wal")[:HEADER]
        self.log = begun + self.log[HEADER:]

    def _file(self, name: str) -> bytes:
        path = self.folder / name
        return path.read_bytes() if path.exists() else b""

    def end(self, how: str, place: Path) -> None:
        """Leave in another place what a kill or a power cut leaves of the files."""
        shutil.copytree(self.folder, place)
        if how == "power cut":
            (place / "plant.sqlite-wal").write_bytes(self._torn(self.log, self._file("plant.sqlite-wal")))
            mark, self.told = self.chance.choice(self.marks)
            (place / "plant.told").write_bytes(mark)
            (place / "plant.sqlite-shm").unlink()

    def _torn(self, synced: bytes, written: bytes) -> bytes:
        """A file of which some blocks were written after it was synced."""
        blocks = range(0, len(written), BLOCK)
        torn = [self.chance.choice((synced, written))[at : at + BLOCK].ljust(BLOCK, b"\0") for at in blocks]
        return b"".join(torn)


def flipped(path: Path, chance: random.Random) -> None:
    content = bytearray(path.read_bytes())
    if content:
        content[chance.randrange(len(content))] ^= 1 << chance.randrange(8)
        path.write_bytes(content)


def cut(path: Path, chance: random.Random) -> None:
    content = path.read_bytes()
    path.write_bytes(content[: chance.choice((0, len(content) // 2, max(0, len(content) - 100)))])


def removed(path: Path, _: random.Random) -> None:
    path.unlink()


DAMAGES = {"flip": flipped, "cut": cut, "removal": removed}


@pytest.fixture(autouse=True)
def _short_log(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sqlite, "FOLDED", FEW)


def ended_life(tmp_path: Path, how: str, seed: int, monkeypatch: pytest.MonkeyPatch) -> tuple[Life, Path]:
    """A memory whose plant has ended, and the place of what is left of it."""
    (tmp_path / "at work").mkdir()
    life, place = Life(tmp_path / "at work", random.Random(seed)), tmp_path / "left"
    store = life.run(life.chance.randrange(5, 40))
    life.end(how, place)
    store.close()
    if how == "power cut":
        monkeypatch.setattr(sqlite, "this_boot", lambda: "the next one")
    return life, place


def opened(place: Path) -> Kept | str:
    """What the next start finds, or the sentence with which it is refused."""
    try:
        with Store(place / "plant.sqlite") as store:
            return kept(store)
    except ArboledaError as refusal:
        return str(refusal)


@pytest.mark.parametrize("seed", range(length(6, 300)))
@pytest.mark.parametrize("how", ENDS)
def test_an_end_that_loses_nothing_that_was_told_is_followed_by_a_start(how, seed, tmp_path, monkeypatch):
    life, place = ended_life(tmp_path, how, seed, monkeypatch)
    found = opened(place)
    assert found in life.states[life.last :], found


@pytest.mark.parametrize("seed", range(length(2, 60)))
@pytest.mark.parametrize("damage", DAMAGES)
@pytest.mark.parametrize("file", FILES)
@pytest.mark.parametrize("how", ENDS)
def test_a_damaged_memory_has_all_that_was_told_or_is_refused(how, file, damage, seed, tmp_path, monkeypatch):
    life, place = ended_life(tmp_path, how, seed, monkeypatch)
    if not (place / file).exists():
        return
    DAMAGES[damage](place / file, life.chance)
    found = opened(place)
    if isinstance(found, str):
        assert found.startswith("The plant's memory ") and "\n" not in found
    else:
        assert found in life.states[life.told :]


def test_a_memory_whose_folding_was_cut_short_is_whole(tmp_path: Path) -> None:
    """A folding writes pages one after the other, the first one with the new length of the file."""
    (tmp_path / "at work").mkdir()
    store = Store(tmp_path / "at work" / "plant.sqlite")
    store.open()
    store.begin()
    for number in range(60):
        store.tasks.keep(queued(f"t{number}"), "x" * 300, float(number))
        if number in (20, 59):
            store.sync()
            before, left = (tmp_path / "at work" / "plant.sqlite").read_bytes(), tmp_path / f"after {number}"
            shutil.copytree(tmp_path / "at work", left)
            store.fold()
    after = (tmp_path / "at work" / "plant.sqlite").read_bytes()
    store.close()
    assert len(after) > len(before) + PAGE
    for written in range(0, len(after) + 1, PAGE):
        place = tmp_path / f"{written} written"
        shutil.copytree(left, place)
        (place / "plant.sqlite").write_bytes(after[:written] + before[written:])
        found = opened(place)
        assert isinstance(found, tuple) and len(found[1]) == 60, found


def half(path: Path) -> None:
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def one_bit(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


LOSSES = {"one bit": one_bit, "half": half, "removed": Path.unlink}


@pytest.fixture
def killed(tmp_path: Path) -> Path:
    """The memory of a plant that was killed after it had told of a latch."""
    (tmp_path / "work").mkdir()
    with Store(tmp_path / "work" / "plant.sqlite") as store:
        store.begin()
        store.acts.keep(ACT, 5.0)
        store.keep(LATCH)
        store.sync()
        shutil.copytree(tmp_path / "work", tmp_path / "killed")
    return tmp_path / "killed" / "plant.sqlite"


def log_of(memory: Path) -> Path:
    return Path(f"{memory}-wal")


@pytest.mark.parametrize("lose", LOSSES.values(), ids=LOSSES)
def test_a_start_whose_log_has_lost_a_latch_is_refused_and_changes_nothing(lose, killed):
    lose(log_of(killed))
    left = {path.name: path.read_bytes() for path in killed.parent.iterdir() if "shm" not in path.name}
    with pytest.raises(StartError, match="is older than what the plant has told"):
        Store(killed).open()
    assert {name: (killed.parent / name).read_bytes() for name in left} == left


@pytest.mark.parametrize("lose", LOSSES.values(), ids=LOSSES)
def test_the_advice_leads_out_and_keeps_what_was_there(lose, killed, tmp_path):
    lose(log_of(killed))
    log = log_of(killed).read_bytes() if log_of(killed).exists() else b""
    backups.back_up(killed, tmp_path / "copy")
    with backups.opened(tmp_path / "copy") as source:
        backups.restore(source, tmp_path / "copy", killed)
    assert (killed.parent / "plant.sqlite.before-restore-wal").read_bytes() == log
    with Store(killed) as store:
        assert store.facts(Fact.LATCH) == {}


def test_a_memory_that_was_removed_is_not_taken_for_a_new_one(killed):
    with Store(killed):
        pass
    killed.unlink()
    with pytest.raises(StartError, match=r"is gone, but .*plant\.told is there: put it back, or move"):
        Store(killed).open()


def test_an_older_copy_in_the_place_of_a_memory_is_refused_and_restored_on_purpose(killed, tmp_path):
    backups.back_up(killed, tmp_path / "monday")
    with Store(killed) as store:
        store.tasks.keep(queued("a"), "storage", 5.0)
        store.sync()
    shutil.copy(tmp_path / "monday", killed)
    with pytest.raises(StartError, match="is older"):
        Store(killed).open()
    with backups.opened(tmp_path / "monday") as source:
        backups.restore(source, tmp_path / "monday", killed)
    with Store(killed) as store:
        assert store.facts(Fact.LATCH) == {"ra1": "on"}
        store.sync()
    with Store(killed):
        pass


def long_work(store: Store) -> None:
    for number in range(FEW):
        store.keep(Remember(fact=Fact.STEP, name="t1", value=str(number)))
    store.sync()
    store.fold()


@pytest.mark.parametrize(
    "spoil",
    [
        lambda path, _: path.write_bytes(b""),
        lambda path, _: path.write_bytes(b"\xaa" * path.stat().st_size),
        lambda path, before: path.write_bytes(before),
    ],
    ids=["emptied", "overwritten", "an older copy"],
)
def test_a_file_that_is_written_by_another_program_is_noticed_and_refused_from_then_on(spoil, killed):
    before = killed.read_bytes()
    with Store(killed) as store:
        long_work(store)
        store.look()
        spoil(killed, before)
        with suppress(ArboledaError):
            long_work(store)  # which does not fold into it
        with pytest.raises(ArboledaError, match=r"another program has written into it.*arboleda restore"):
            store.look()
        with suppress(ArboledaError):
            long_work(store)
    with pytest.raises(StartError, match="is not what the plant has kept"):
        Store(killed).open()


def cannot_open(_: Path) -> None:
    raise sql.OperationalError("unable to open database file")


def test_a_file_that_another_program_has_written_as_it_was_is_no_trouble(killed, monkeypatch):
    with Store(killed) as store:
        long_work(store)
        killed.write_bytes(killed.read_bytes())
        with monkeypatch.context() as patch:
            patch.setattr(main_file, "read_only", cannot_open)
            store.look()
        store.look()
        long_work(store)
        store.look()
    with Store(killed) as again:
        assert again.facts(Fact.STEP) == {"t1": str(FEW - 1)}


def test_a_note_that_is_damaged_is_refused_where_a_kill_left_it(killed):
    note = Path(f"{killed}-ahead")
    with Store(killed) as store:
        store.begin()
        store.note(Remember(fact=Fact.EFFECTOR, name="ra1", value="switching"))
        content = note.read_bytes()
        shutil.copytree(killed.parent, killed.parent / "left")
    left = killed.parent / "left" / note.name
    left.write_bytes(content[:-1] + b"?")
    with pytest.raises(
        StartError, match="is not as it was written, and it may say what robots were told last"
    ):
        Store(left.with_name(killed.name)).open()
    left.unlink()
    Store(left.with_name(killed.name)).open()


def test_a_memory_of_before_is_brought_up_and_counts_from_then_on(killed):
    with Store(killed) as store:
        store.keep(LATCH)
    with sql.connect(killed) as db:
        db.execute("DROP TABLE written")
        db.execute("PRAGMA user_version = 12")
    killed.with_suffix(".told").unlink()
    with Store(killed) as store:
        store.keep(LATCH)
        store.sync()
    assert killed.with_suffix(".told").exists()
