"""The plant's memory in SQLite files, where nobody else is at work."""

from __future__ import annotations

import errno
import json
import os
import random
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from operator import attrgetter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.lengths import length, sample
from tests.rights import modes_count

from arboleda.core.choosing import LATER
from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.messages import Check, Course, Fact, Remember
from arboleda.store import row_sums, sqlite
from arboleda.store.sqlite import Store
from arboleda.store.task_rows import TaskHistory, TaskQuery, choice_of, course_of, unchecked_of

from .memory_samples import ACT, LATCH, ended, queued


@pytest.fixture
def path(tmp_path):
    return tmp_path / "plant.sqlite"


@pytest.fixture
def store(path):
    with Store(path) as opened:
        yield opened


@pytest.fixture
def on_connect(monkeypatch):
    """Has something done to every connection from now on."""
    connect = sqlite3.connect

    def register(do: Callable[[sqlite3.Connection], object]) -> None:
        def connected(*args, **options):
            db = connect(*args, **options)
            do(db)
            return db

        monkeypatch.setattr(sqlite3, "connect", connected)

    return register


@pytest.fixture
def small_disk(on_connect):
    """From now on a database may have so many pages."""
    return lambda pages: on_connect(lambda db: db.execute(f"PRAGMA max_page_count = {pages}"))


def everything(path: Path) -> tuple:
    with Store(path) as store:
        return [store.facts(fact) for fact in Fact], store.acts.last()


def refusal(path: Path) -> str:
    with pytest.raises(StartError) as refused:
        Store(path).open()
    assert str(refused.value).startswith(f"The plant's memory {path} ")
    assert "\n" not in str(refused.value)
    return str(refused.value)


def test_of_facts_that_are_kept_together_all_are_kept_or_none(path, small_disk):
    both = LATCH, Remember(fact=Fact.LATCH, name="ra2", value="on")
    with Store(path) as store:
        store.keep(*both)
        assert store.facts(Fact.LATCH) == {"ra1": "on", "ra2": "on"}
        store.keep(replace(both[0], value=None), replace(both[1], value="cleared"))
        assert store.facts(Fact.LATCH) == {"ra2": "cleared"}
        pages = sqlite3.connect(path).execute("PRAGMA page_count").fetchone()[0]
    small_disk(pages)
    with Store(path) as store:
        too_much = replace(LATCH, value="x" * 100_000)
        with pytest.raises(ArboledaError):
            store.keep(*both, too_much)
        assert store.facts(Fact.LATCH) == {"ra2": "cleared"}


NAMES = st.sampled_from(["ra1", "ra2", "mesa ñ 'x'"])
FACTS = st.builds(
    Remember, fact=st.sampled_from(Fact), name=NAMES, value=st.sampled_from(["on", "off", "", None])
)


@given(st.lists(FACTS, max_size=20))
def test_the_last_word_on_each_fact_counts(facts):
    with Store(Path(":memory:")) as store:
        for fact in facts:
            store.keep(fact)
        last = {fact.fact: {} for fact in facts}
        for fact in facts:
            last[fact.fact][fact.name] = fact.value
        for kind, values in last.items():
            assert store.facts(kind) == {name: value for name, value in values.items() if value is not None}


def test_open_and_close_may_be_called_twice(path):
    store = Store(path)
    store.close()
    store.open()
    store.open()
    store.keep(LATCH)
    store.close()
    store.close()
    with pytest.raises(ArboledaError, match="is closed"):
        store.keep(LATCH)
    assert os.listdir(path.parent) == [path.name]


def test_a_log_that_breaks_off_costs_only_what_was_being_written(path, tmp_path):
    copy = tmp_path / "copy.sqlite"
    log = Path(f"{copy}-wal")
    with Store(path) as store:
        store.keep(LATCH)
        store.keep(Remember(fact=Fact.EFFECTOR, name="ra1", value="on"))
        shutil.copy(path, copy)
        shutil.copy(f"{path}-wal", log)
    os.truncate(log, log.stat().st_size - 100)
    assert everything(copy)[0][0] == {"ra1": "on"} and not any(everything(copy)[0][1:])


def test_a_reader_neither_waits_nor_makes_wait(store, path):
    store.keep(LATCH)
    reader = sqlite3.connect(path, timeout=0, isolation_level=None)
    reader.execute("BEGIN")
    query = "SELECT name FROM fact"
    assert reader.execute(query).fetchall() == [("ra1",)]
    store.keep(Remember(fact=Fact.LATCH, name="ra2", value="on"))
    assert reader.execute(query).fetchall() == [("ra1",)]
    reader.execute("COMMIT")
    assert reader.execute(query).fetchall() == [("ra1",), ("ra2",)]
    reader.close()


def test_a_file_that_another_program_writes_is_said_to_be(path, monkeypatch):
    monkeypatch.setattr("arboleda.store.sqlite.BUSY_S", 0)
    with Store(path) as store:
        writer = sqlite3.connect(path, isolation_level=None)
        writer.execute("BEGIN IMMEDIATE")
        with pytest.raises(ArboledaError, match=r"\(database is locked\): close the other program"):
            store.keep(LATCH)
        writer.execute("ROLLBACK")
        store.keep(LATCH)
    writer.close()


def test_a_commit_waits_for_no_disk_and_a_sync_has_the_log_written_to_it(path, monkeypatch):
    synced: list[str] = []
    monkeypatch.setattr(sqlite, "sync_data", lambda file: synced.append(os.readlink(f"/proc/self/fd/{file}")))
    with Store(path) as store:
        store.keep(LATCH)
        store.acts.keep(ACT, 5.0)
        assert synced == []
        store.sync()
    assert synced == [f"{path}-wal"]


def long_work(store):
    for number in range(sqlite.FOLDED):
        store.keep(Remember(fact=Fact.STEP, name=f"task {number % 10}", value=f"{number}" + 20_000 * "x"))


def test_a_long_log_is_folded_into_the_file_by_no_commit_but_by_who_asks_for_it(path, tmp_path):
    alone = tmp_path / "alone.sqlite"
    with Store(path) as store:
        before = path.stat().st_size
        long_work(store)
        assert path.stat().st_size == before
        store.fold()
        shutil.copy(path, alone)
    with Store(alone) as store:
        assert len(store.facts(Fact.STEP)) == 10


def test_a_short_log_is_not_folded(path):
    with Store(path) as store:
        before = path.read_bytes()
        store.keep(LATCH)
        store.fold()
        assert path.read_bytes() == before


def test_a_log_that_cannot_be_folded_keeps_nobody_from_writing(path):
    with Store(path) as store, closing(sqlite3.connect(path)) as reader:
        reader.execute("BEGIN")
        reader.execute("SELECT * FROM fact").fetchall()
        long_work(store)
        store.fold()
        store.keep(LATCH)
        assert store.facts(Fact.LATCH) == {LATCH.name: LATCH.value}


def test_a_sync_of_a_memory_that_is_not_in_its_place_is_refused(path):
    with Store(path) as store:
        store.keep(LATCH)
        path.rename(path.with_name("moved.sqlite"))
        with pytest.raises(ArboledaError, match="was deleted or moved away"):
            store.sync()


GRIP = Remember(fact=Fact.EFFECTOR, name="ra1", value="switching")


def left_behind(path):
    """A copy of the folder, as it is left where the process ends in this moment."""
    return shutil.copytree(path.parent, path.parent / "left", ignore=shutil.ignore_patterns("left"))


def test_facts_that_were_noted_are_there_after_the_process_was_killed(path):
    with Store(path) as store:
        store.note(GRIP)
        killed = left_behind(path)
    with Store(killed / path.name) as store:
        assert store.facts(Fact.EFFECTOR) == {"ra1": "switching"}


def test_facts_that_were_noted_are_taken_in_once(path):
    with Store(path) as store:
        store.note(GRIP)
        killed = left_behind(path)
    with Store(killed / path.name) as store:
        store.keep(replace(GRIP, value="on"))
    with Store(killed / path.name) as store:
        assert store.facts(Fact.EFFECTOR) == {"ra1": "on"}


def test_who_ends_leaves_the_note_of_another_plant_in_the_same_place(path):
    note = Path(f"{path}-ahead")
    with Store(path) as store:
        store.note(GRIP)
        store.settle()
        note.unlink()
        note.write_bytes(b"of another")
    assert note.read_bytes() == b"of another"


def test_facts_that_were_noted_are_lost_with_the_power_of_the_host(path, monkeypatch):
    with Store(path) as store:
        store.note(GRIP)
        cut = left_behind(path)
    monkeypatch.setattr(sqlite, "this_boot", lambda: "the next one")
    with Store(cut / path.name) as store:
        assert store.facts(Fact.EFFECTOR) == {}


@pytest.mark.parametrize("length", [0, 7, 8, 9, 50])
def test_a_note_that_was_not_written_to_its_end_is_none(path, length):
    with Store(path) as store:
        store.note(GRIP)
        killed = left_behind(path)
    note = killed / f"{path.name}-ahead"
    assert len(note.read_bytes()) > length
    os.truncate(note, length)
    with Store(killed / path.name) as store:
        assert store.facts(Fact.EFFECTOR) == {}


def test_what_is_written_after_a_note_comes_after_it(path):
    with Store(path) as store:
        store.note(GRIP)
        store.keep(Remember(fact=Fact.EFFECTOR, name="ra1", value="on"))
        store.settle()
        assert store.facts(Fact.EFFECTOR) == {"ra1": "on"}
    assert not Path(f"{path}-ahead").exists()


def test_facts_that_cannot_be_noted_are_committed(path, monkeypatch):
    def full(*_):
        raise OSError("no space left on device")

    with Store(path) as store, monkeypatch.context() as patch:
        patch.setattr(os, "pwrite", full)
        store.note(GRIP)
        assert store.facts(Fact.EFFECTOR) == {"ra1": "switching"}


def on_boot(boot: str, path: Path, monkeypatch: pytest.MonkeyPatch) -> Store:
    monkeypatch.setattr(sqlite, "this_boot", lambda: boot)
    store = Store(path)
    store.open()
    return store


def test_a_memory_lacks_the_last_writes_only_where_its_host_was_switched_off_meanwhile(path, monkeypatch):
    killed = on_boot("monday", path, monkeypatch)
    assert not killed.may_lack_writes
    killed.begin()
    assert not on_boot("monday", path, monkeypatch).may_lack_writes
    after = on_boot("tuesday", path, monkeypatch)
    assert after.may_lack_writes
    after.close()
    assert on_boot("tuesday", path, monkeypatch).may_lack_writes  # until a start has made up for it
    begun = on_boot("tuesday", path, monkeypatch)
    begun.begin(GRIP)
    assert begun.facts(Fact.EFFECTOR) == {"ra1": "switching"}
    assert not on_boot("tuesday", path, monkeypatch).may_lack_writes


def test_a_memory_that_was_closed_lacks_nothing(path, monkeypatch):
    ended = on_boot("monday", path, monkeypatch)
    ended.begin()
    ended.close()
    assert not on_boot("tuesday", path, monkeypatch).may_lack_writes


def test_a_memory_whose_sync_failed_may_lack_writes_although_it_was_closed(path, monkeypatch):
    ended = on_boot("monday", path, monkeypatch)
    ended.begin()
    monkeypatch.setattr(sqlite, "sync_data", fail_to_sync)
    with pytest.raises(ArboledaError):
        ended.sync()
    ended.close()
    assert on_boot("tuesday", path, monkeypatch).may_lack_writes


def fail_to_sync(_: int) -> None:
    raise OSError(errno.EIO, os.strerror(errno.EIO))


def test_a_sync_that_fails_is_one_sentence(path, monkeypatch):
    monkeypatch.setattr(sqlite, "sync_data", fail_to_sync)
    with Store(path) as store, pytest.raises(ArboledaError, match=r"cannot be used \(Input/output error\)"):
        store.sync()


@pytest.mark.parametrize("version", [1, 2, 3])
def test_a_file_of_an_older_format_is_brought_up_and_keeps_what_it_has(path, version):
    with Store(path) as store:
        store.keep(LATCH)
        store.acts.keep(ACT, 5.0)
    brought_back(path, version)
    with Store(path) as store:
        assert store.facts(Fact.LATCH) == {"ra1": "on"}
        (old,) = store.acts.last()
        assert (old.sentence, old.cell) == (str(ACT.sentence), None)
        assert (old.said is None) is (version < 3)
        store.tasks.keep(queued("a"), "storage", 5.0)
        assert [row.id for row in store.tasks.select(TaskQuery())] == ["a"]
        store.acts.keep(replace(ACT, cell="sis_a"), 6.0)
        newest = store.acts.last()[0]
        assert newest.cell == "sis_a" and json.loads(newest.said) == ACT.sentence.data()


OLDER = {  # the formats of before, each with what makes a file of the one after it one of it
    12: ("DROP TABLE written",),
    11: ("DROP INDEX task_ran", "ALTER TABLE task DROP COLUMN ran_s"),
    10: ("ALTER TABLE task DROP COLUMN unchecked",),
    9: [f"ALTER TABLE {table} DROP COLUMN crc" for table in row_sums.KEYS],
    8: ("ALTER TABLE task DROP COLUMN course",),
    7: ("ALTER TABLE task DROP COLUMN choice",),
    6: ("DROP TABLE down", "DROP TABLE run"),
    5: ("ALTER TABLE task DROP COLUMN answers",),
    4: ("ALTER TABLE task DROP COLUMN asked_by", "ALTER TABLE task DROP COLUMN attempts"),
    3: ("DROP TABLE task",),
    2: ("ALTER TABLE journal DROP COLUMN said",),
    1: ("ALTER TABLE journal DROP COLUMN cell",),
}


def brought_back(path, version):
    """Make the file one of an older format."""
    with closing(sqlite3.connect(path)) as db:
        for format, statements in OLDER.items():
            for statement in statements if format >= version else ():
                db.execute(statement)
        db.execute(f"PRAGMA user_version = {version}")


@pytest.mark.parametrize(("version", "kept"), [(4, (None, 0, None)), (5, ("page", 0, None))])
def test_tasks_of_an_older_format_have_neither_who_asked_nor_answers(path, version, kept):
    with Store(path) as store:
        store.tasks.keep(queued("a"), "storage", 5.0, "page")
    brought_back(path, version)
    with Store(path) as store:
        (old,) = store.tasks.select(TaskQuery())
        assert (old.id, old.asked_by, old.attempts, old.answers) == ("a", *kept)


WHY, COURSE = LATER(cell="sis_b", seconds=12.5), Course(seconds=31.5, begun={"0.0.1": 0.0, "0.1": 2.25})
CHECKS = (Check.GRIP, Check.RELEASE)


@pytest.mark.parametrize(
    ("version", "new", "read", "found"),
    [
        (7, replace(queued("c"), choice=WHY), choice_of, (WHY, None)),
        (8, ended("b", course=COURSE), course_of, (COURSE, None)),
        (10, ended("b", unchecked=CHECKS), unchecked_of, (CHECKS, ())),
        (10, ended("b", unchecked=CHECKS), attrgetter("unchecked"), ("grip release", None)),
    ],
    ids=["choice", "course", "checks", "checks as they are kept"],
)
def test_tasks_of_an_older_format_lack_what_new_ones_say(path, version, new, read, found):
    with Store(path) as store:
        for name in ("a", "b"):
            store.tasks.keep(queued(name), "storage", 5.0)
    brought_back(path, version)
    with Store(path) as store:
        store.tasks.keep(new, "storage", 6.0)
        rows = {row.id: read(row) for row in store.tasks.select(TaskQuery())}
    assert (rows[new.task], rows["a"]) == found


def test_tasks_of_an_older_format_are_as_old_as_the_count_of_their_age(path):
    with Store(path) as store:
        for name in ("ended", "open"):
            store.tasks.keep(queued(name), "storage", 5.0)
        store.tasks.keep(ended("ended"), "storage", 6.0, ran_s=9_000.0)
    brought_back(path, 10)
    with Store(path) as store:
        assert store.tasks.ran_s() == 0.0
        store.tasks.forget(0.5)
        assert [row.id for row in store.tasks.select(TaskQuery())] == ["open"]


def test_a_file_without_times_of_cells_gets_them(path):
    with Store(path) as store:
        store.tasks.keep(queued("a"), "storage", 5.0)
    brought_back(path, 6)
    with Store(path) as store:
        store.times.began(10.0)
        store.times.stands("sis_a", "held", 11.0)
        assert [row.id for row in store.tasks.select(TaskQuery())] == ["a"]
    assert times(path) == ([(10.0, 10.0, 0)], [("sis_a", "held", 11.0, None)])


def times(path):
    """The starts of the plant, and when its cells did no work."""
    db = sqlite3.connect(path)
    runs = db.execute("SELECT since_s, seen_s, ended FROM run ORDER BY number").fetchall()
    downs = db.execute("SELECT cell, state, since_s, until_s FROM down ORDER BY number").fetchall()
    db.close()
    return runs, downs


@pytest.fixture(scope="module")
def long_history(tmp_path_factory):
    """A file with thousands of tasks that are over."""
    path = tmp_path_factory.mktemp("history") / "plant.sqlite"
    with Store(path):
        pass
    db = sqlite3.connect(path)
    row_sums.know(db)
    row_sums.watch(db)
    columns = "id, text, cell, recipe, state, accepted_s, ended_s"
    rows = ((f"n{n}", "sis_a 0B 1", "sis_a", "storage", "done", float(n), float(n)) for n in range(2, 5_000))
    db.executemany(f"INSERT INTO task ({columns}) VALUES (?, ?, ?, ?, ?, ?, ?)", rows)
    db.commit()
    db.close()
    return path


@pytest.mark.parametrize(
    "ask",
    [
        lambda store: store.tasks.select(TaskQuery(limit=20)),
        lambda store: store.tasks.select(TaskQuery(limit=20, before=4_000)),
        lambda store: store.tasks.select(TaskQuery(id="n7")),
        lambda store: store.tasks.select(TaskQuery(is_open=True, limit=-1)),
        lambda store: store.tasks.select(TaskQuery(is_open=False, limit=20)),
        lambda store: store.tasks.forget(1.0),
        lambda store: store.tasks.forget(5_000.0),
    ],
)
def test_what_is_asked_all_day_does_not_read_the_whole_history(long_history, path, on_connect, ask):
    shutil.copy(long_history, path)
    opened = []
    on_connect(opened.append)
    with Store(path) as store:
        opened[0].set_progress_handler(lambda: 1, 10_000)  # so many steps of SQLite end what takes more
        ask(store)
        with pytest.raises(ArboledaError, match="interrupted"):
            store.tasks.select(TaskQuery(words="no such"))


@pytest.mark.parametrize(("column", "value"), [("state", "lost"), ("reason", "bad luck")])
def test_a_task_that_means_nothing_is_one_sentence(path, column, value):
    with Store(path) as store:
        store.tasks.keep(queued("a"), "storage", 1.0)
    db = sqlite3.connect(path)
    row_sums.know(db)
    row_sums.watch(db)
    db.execute(f"UPDATE task SET {column} = ?", (value,))
    db.commit()
    db.close()
    with Store(path) as store, pytest.raises(ArboledaError, match="'a' what means nothing"):
        store.tasks.select(TaskQuery())


def test_a_history_that_cannot_be_read_is_one_sentence(path):
    path.write_bytes(b"no database at all" * 100)
    with pytest.raises(ArboledaError, match=r"cannot be read \(file is not a database\)"):
        TaskHistory(path).select(TaskQuery())


def test_a_damaged_file_is_found_at_the_start(path):
    with Store(path) as store:
        for n in range(500):
            store.acts.keep(ACT, float(n))
    with path.open("r+b") as file:
        file.seek(4096 * 4)
        file.write(b"\xaa" * 4096 * 4)
    assert "malformed): move it away, together with its -wal, -shm, -ahead and .told files" in refusal(path)


@pytest.mark.parametrize("left", [0, 1, 100, 4096, 5000])
def test_a_memory_that_was_cut_off_is_not_taken_for_a_new_one(path, left):
    with Store(path) as store:
        store.keep(LATCH)
    os.truncate(path, left)
    assert "lost with it are stop latches" in refusal(path)
    assert path.stat().st_size == left


def test_a_memory_without_its_file_but_with_its_log_is_refused(path):
    with Store(path) as store:
        store.keep(LATCH)
        path.unlink()
        assert f"is gone, but {path}-wal is there: put it back" in refusal(path)


def test_a_start_that_was_killed_while_it_made_the_memory_is_no_obstacle(path):
    (path.parent / f".{path.name}.new").write_bytes(b"half a file")
    with Store(path) as store:
        store.keep(LATCH)
    assert os.listdir(path.parent) == [path.name]


@pytest.mark.parametrize("stuff", ["directory", "pipe"])
def test_something_else_of_that_name_is_refused(path, stuff):
    path.mkdir() if stuff == "directory" else os.mkfifo(path)
    refusal(path)


def changed(path: Path, statement: str, *values: object) -> Store:
    with Store(path) as store:
        store.keep(LATCH)
        store.acts.keep(ACT, 5.0)
    db = sqlite3.connect(path)
    db.execute(statement, values)
    db.commit()
    db.close()
    return Store(path)


@pytest.mark.parametrize("value", ["CAST(x'ff' AS TEXT)", "x'6f6e'"])
def test_a_fact_that_is_no_text_is_one_sentence(path, value):
    why = r"\((not UTF-8 text|a row is not as it was written)\): move it away"
    with pytest.raises(StartError, match=why):
        changed(path, f"UPDATE fact SET value = {value}").open()


@pytest.mark.parametrize(
    "change",
    ["sentence = CAST(x'ff' AS TEXT)", "sentence = x'00'", "unix_s = 'noon'", "cell = x'00'", "said = x'00'"],
)
def test_an_entry_that_is_no_entry_is_one_sentence(path, change):
    with pytest.raises(StartError, match="move it away"):
        changed(path, f"UPDATE journal SET {change}").open()


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """The file of a plant that has kept something of everything."""
    path = tmp_path_factory.mktemp("written") / "plant.sqlite"
    with Store(path, "arboleda") as store:
        for fact in Fact:
            store.keep(*(Remember(fact=fact, name=name, value="on") for name in ("ra1", "ra2", "mesa ñ")))
        for number in range(60):
            store.acts.keep(ACT, float(number))
            store.tasks.keep(queued(f"t{number}", f"sis_a 0B {number % 9}"), "storage", number + 0.5, "page")
        for number in range(50):
            store.tasks.keep(ended(f"t{number}"), "storage", number + 30.25)
        for number in range(20):
            store.times.began(float(number))
            store.times.stands("sis_a", "held", number + 0.5)
    return path


def rows_of(path):
    """All that a plant wrote into the file."""
    with closing(sqlite3.connect(path)) as db:
        tables = {table: db.execute(f"SELECT * FROM {table}").fetchall() for table in row_sums.KEYS}
    return {table: [row[:-1] for row in rows] for table, rows in tables.items()}


def with_bit_flipped(good, path, bit):
    spoilt = bytearray(good)
    spoilt[bit // 8] ^= 1 << bit % 8
    path.write_bytes(spoilt)
    for end in ("-wal", "-shm"):
        Path(f"{path}{end}").unlink(missing_ok=True)


@pytest.mark.parametrize("seed", range(length(1, 3)))
def test_a_flipped_bit_changes_nothing_that_is_read_or_the_file_is_refused(written, path, seed):
    good, before = written.read_bytes(), rows_of(written)
    bits = random.Random(seed).sample(range(len(good) * 8), length(30, 100))
    if seed == 0:
        bits += sample(range(300), every=6)  # the header, which says how all the rest is read
    refused = 0
    for bit in bits:
        with_bit_flipped(good, path, bit)
        try:
            with closing(TaskHistory(path, "arboleda")) as history:
                history.select(TaskQuery(limit=None))
            with Store(path, "arboleda"):
                pass
        except ArboledaError as error:
            assert f"memory {path} " in str(error) and "\n" not in str(error)
            refused += 1
        else:
            assert rows_of(path) == before, f"bit {bit}"
    assert refused > 10


@pytest.mark.parametrize("words", ["CREATE TABLE fact", "CREATE INDEX task_open"])
def test_a_schema_that_is_no_text_is_one_sentence(written, path, words):
    """SQLite quotes what it cannot understand, in bytes that are no UTF-8."""
    good = written.read_bytes()
    for letter in range(len(words)):
        with_bit_flipped(good, path, 8 * (good.index(words.encode()) + letter) + 7)
        refusal(path)
        with pytest.raises(ArboledaError, match="cannot be read"):
            TaskHistory(path).select(TaskQuery())


def test_rows_of_an_older_format_get_their_sums_and_keep_what_they_have(written, path):
    shutil.copy(written, path)
    brought_back(path, 9)
    with Store(path) as store:
        store.tasks.keep(ended("t55"), "storage", 99.5)
    changes = rows_of(path)["task"]
    assert [row for row in changes if row[1] != "t55"] == [
        row for row in rows_of(written)["task"] if row[1] != "t55"
    ]
    with Store(path) as store:
        assert len(store.acts.last()) == 60


@pytest.mark.parametrize("table", row_sums.KEYS)
def test_a_row_that_another_program_changed_is_refused(written, path, table):
    shutil.copy(written, path)
    column = columns_of(path, table)[-2]
    with closing(sqlite3.connect(path)) as db, db:
        db.execute(f"UPDATE {table} SET {column} = '7'")
    assert "(a row is not as it was written): move it away" in refusal(path)


def columns_of(path, table):
    with closing(sqlite3.connect(path)) as db:
        return [name for (name,) in db.execute("SELECT name FROM pragma_table_info(?)", (table,))]


def test_a_directory_that_is_missing_is_named(tmp_path):
    sentence = refusal(tmp_path / "nowhere" / "plant.sqlite")
    assert "(unable to open database file): make its directory, and let this user read and write" in sentence


@pytest.fixture
def locked_up(path):
    """A memory that this process may read but not write."""
    with Store(path):
        pass
    path.chmod(0o444)
    path.parent.chmod(0o555)
    with modes_count():
        yield path
    path.parent.chmod(0o755)


def test_a_file_that_may_not_be_written_is_refused_at_the_start(locked_up):
    assert "let this user" in refusal(locked_up)


def test_a_full_disk_at_the_start_is_named(path, small_disk):
    small_disk(1)
    assert "(database or disk is full): make room on the disk and start again" in refusal(path)


def test_a_fact_that_finds_no_room_is_an_error_and_what_was_kept_stays(path, small_disk):
    small_disk(13)
    long = Remember(fact=Fact.QUARANTINE, name="mesa", value="x" * 40_000)
    with Store(path) as store:
        store.keep(LATCH)
        with pytest.raises(ArboledaError, match="make room on the disk"):
            store.keep(long)
        store.keep(Remember(fact=Fact.EFFECTOR, name="ra1", value="off"))
    assert everything(path)[0][:2] == [{"ra1": "on"}, {"ra1": "off"}] and not any(everything(path)[0][2:])


@pytest.mark.parametrize(
    ("lost", "advice"),
    [
        ("plant.sqlite", "put it, or a backup, in its place"),
        ("plant.sqlite-wal", "start again; as the plant"),
    ],
)
def test_a_file_that_is_deleted_while_it_is_open_is_said_by_whatever_comes_next(path, lost, advice):
    with Store(path) as store:
        store.keep(LATCH)
        store.confirm()
        path.with_name(lost).unlink()
        for write in (lambda: store.keep(LATCH), lambda: store.acts.keep(ACT, 5.0), store.confirm):
            with pytest.raises(ArboledaError, match=f"any more.*{lost} was deleted.*ran.: {advice}"):
                write()
    store.confirm()  # closed, nothing of it can be lost


def test_a_file_in_the_place_of_the_one_that_is_open_is_no_memory(path, tmp_path):
    with Store(path) as store:
        store.keep(LATCH)
        with Store(tmp_path / "other.sqlite"):
            pass
        (tmp_path / "other.sqlite").replace(path)
        with pytest.raises(ArboledaError, match="was replaced by another file"):
            store.keep(LATCH)


@pytest.mark.parametrize("log", ["stays", "deleted"])
def test_a_memory_that_was_moved_away_has_all_that_was_kept_once_it_is_closed(path, tmp_path, log):
    with Store(path) as store:
        store.keep(LATCH)
        moved = path.rename(tmp_path / "moved.sqlite")
        if log == "deleted":
            Path(f"{path}-wal").unlink()
    with Store(moved) as again:
        assert again.facts(Fact.LATCH) == {"ra1": "on"}


def test_a_memory_whose_log_was_deleted_has_all_that_was_kept_once_it_is_closed(path):
    with Store(path) as store:
        store.keep(LATCH)
        Path(f"{path}-wal").unlink()
    with Store(path) as again:
        assert again.facts(Fact.LATCH) == {"ra1": "on"}


def test_who_backs_up_or_reads_beside_the_plant_leaves_its_files_in_their_place(path, store):
    def files():
        return {each.name: each.stat().st_ino for each in (path, Path(f"{path}-wal"))}

    store.keep(LATCH)
    before = files()
    history = TaskHistory(path)
    history.select(TaskQuery())
    history.close()
    with closing(sqlite3.connect(path)) as other:
        other.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    store.keep(LATCH)
    assert files() == before
