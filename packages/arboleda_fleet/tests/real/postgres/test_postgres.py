"""Memory in PostgreSQL: one leader at a time, servers that are away, and their sentences."""

from __future__ import annotations

import os
import signal
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress

import psycopg
import pytest
from tests.patience import PATIENCE_S
from tests.postgres import DATABASE, PASSWORD, USER, Server

from arboleda.departures.leading import LEASE_S, RENEW_S
from arboleda.model.errors import ArboledaError, StartError
from arboleda.model.messages import Fact, Journal, Remember, TaskChanged, TaskState, Verb
from arboleda.model.sentence import OWN
from arboleda.store.lead import Standby, Superseded
from arboleda.store.package_table import PackageTable
from arboleda.store.task_rows import TaskQuery
from arboleda_fleet.postgres.history import PostgresHistory
from arboleda_fleet.postgres.leaders import PostgresLeaders
from arboleda_fleet.postgres.leadership import PostgresLeadership
from arboleda_fleet.postgres.memory import PostgresMemory

LATCH = Remember(fact=Fact.LATCH, name="ra1", value="on")
QUEUED = TaskChanged(task="a", text="sis_a 0B 1", cell="sis_a", state=TaskState.QUEUED)
ACT = Journal(verb=Verb.STOP, scope="", cell=None, sentence=OWN(text="everything stopped"))


@contextmanager
def leading(address: str, plant: str, epoch: int = 1) -> Iterator[PostgresMemory]:
    with PostgresMemory(address, plant) as memory:
        memory.lead.take(epoch)
        yield memory


def refusal(address: str, plant: str) -> str:
    with pytest.raises(StartError) as refused:
        PostgresMemory(address, plant).open()
    assert "\n" not in str(refused.value) and PASSWORD not in str(refused.value)
    return str(refused.value)


def take_over(server: Server, plant: str) -> None:
    """As another host does once a lease has ended."""
    with server.connection() as db:
        db.execute(f'UPDATE "plant_{plant}".leader SET epoch = epoch + 1, host = %s, process = 7', ("other",))


WRITES: dict[str, Callable[[PostgresMemory], object]] = {
    "two facts": lambda memory: memory.keep(LATCH, Remember(fact=Fact.LATCH, name="ra2", value="on")),
    "a fact less": lambda memory: memory.keep(Remember(fact=Fact.EFFECTOR, name="ra1", value=None)),
    "an entry of the journal": lambda memory: memory.acts.keep(ACT, 2.0),
    "a task": lambda memory: memory.tasks.keep(QUEUED, "storage", 2.0),
    "an attempt": lambda memory: memory.tasks.attempted("kept", 5),
    "old tasks forgotten": lambda memory: memory.tasks.forget(100.0),
    "a start": lambda memory: memory.times.began(5.0),
    "an end": lambda memory: memory.times.note_run(5.0, ended=True),
    "a cell that stands": lambda memory: memory.times.stands("sis_a", "held", 5.0),
    "a row of a package": lambda memory: PackageTable(memory, "acme").put({"a": "1"}),
    "its lease": lambda memory: memory.lead.renew(),
}


def test_who_was_superseded_writes_nothing(postgres: Server, database: str, plant: str) -> None:
    def everything() -> list[list[tuple]]:
        tables = ("fact", "journal", "task", "down", "run", "leader")
        with postgres.connection() as db:
            return [db.execute(f'SELECT * FROM "plant_{plant}".{table}').fetchall() for table in tables]

    written = []
    with leading(database, plant) as memory:
        memory.keep(Remember(fact=Fact.EFFECTOR, name="ra1", value="on"))
        memory.tasks.keep(
            TaskChanged(task="kept", text="x", cell="x", state=TaskState.QUEUED), "storage", 1.0
        )
        memory.times.began(1.0)
        take_over(postgres, plant)
        before = everything()
        for what, write in WRITES.items():
            with suppress(Superseded):
                write(memory)
                written.append(what)
        with pytest.raises(Superseded, match=r"now \(process 7 on other\): this one steps down"):
            memory.keep(LATCH)
        assert written == [] and everything() == before


def test_a_leader_that_was_away_finds_out_that_it_is_none_any_more(
    postgres: Server, database: str, plant: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = 1000.0
    monkeypatch.setattr("arboleda.adapters.clock.seconds", lambda: now)
    with leading(database, plant) as memory:
        memory.confirm()
        take_over(postgres, plant)
        memory.confirm()  # its lease has not ended: nobody can have taken over but by a look into the tables
        assert memory.lead.is_certain
        now += LEASE_S
        assert not memory.lead.is_certain
        with pytest.raises(Superseded):
            memory.confirm()


def test_a_plant_has_one_leader_and_no_other_writes(
    database: str, plant: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("arboleda.departures.leading.LEASE_S", PATIENCE_S)
    with leading(database, plant) as first, PostgresMemory(database, plant) as second:
        renewing, ended = _renewing(first)
        try:
            with pytest.raises(StartError, match=r"is led by another process \(process \d+ on .*\): end it"):
                second.lead.take(1)
            with pytest.raises(ArboledaError, match="is not led"):
                second.keep(LATCH)
        finally:
            ended.set()
            renewing.join()


def _renewing(memory: PostgresMemory) -> tuple[threading.Thread, threading.Event]:
    ended = threading.Event()

    def renew() -> None:
        while not ended.wait(RENEW_S):
            memory.lead.renew()

    thread = threading.Thread(target=renew)
    thread.start()
    return thread, ended


def test_who_was_ended_gives_the_plant_back_and_numbers_only_grow(database: str, plant: str) -> None:
    numbers, others = [], PostgresLeadership(database, plant)
    for wanted in (1000, 5, 2000):
        with PostgresMemory(database, plant) as memory:
            numbers.append(memory.lead.take(wanted))
        assert not others.leader().leads
    others.close()
    assert numbers == [1000, 1001, 2000]


def test_plants_that_share_a_database_are_found_and_know_nothing_of_each_other(
    database: str, plant: str
) -> None:
    second = f"{plant}_b"
    with leading(database, plant) as one, PostgresMemory(database, second) as other:
        one.lead.announce("http://10.0.0.1:8080")
        leaders = PostgresLeaders(database)
        found = {name: (each.leads, each.url) for name, each in leaders.all().items()}
        leaders.close()
        assert (found[plant], found[second]) == ((True, "http://10.0.0.1:8080"), (False, ""))
        other.lead.take(1)
        one.keep(LATCH)
        one.tasks.keep(QUEUED, "storage", 1.0)
        assert other.facts(Fact.LATCH) == {} and other.tasks.select(TaskQuery()) == []
        other.tasks.keep(QUEUED, "palletizing", 1.0)
        assert [row.recipe for row in one.tasks.select(TaskQuery())] == ["storage"]


def test_two_hosts_may_make_it_at_once(database: str, plant: str) -> None:
    problems: list[BaseException] = []

    def make() -> None:
        try:
            with PostgresMemory(database, plant) as memory:
                memory.facts(Fact.LATCH)
        except BaseException as error:  # noqa: BLE001 - told to the test
            problems.append(error)

    threads = [threading.Thread(target=make) for _ in range(6)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert problems == []


def test_a_character_that_postgresql_has_not_is_replaced(database: str, plant: str) -> None:
    with leading(database, plant) as memory:
        memory.keep(Remember(fact=Fact.STEP, name="a", value="x\0y"))
        assert memory.facts(Fact.STEP) == {"a": "x\ufffdy"}


def test_a_server_that_cannot_be_used_is_one_sentence_with_what_to_do(
    postgres: Server, database: str, plant: str, free_port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    nobody = f"postgresql://{USER}@127.0.0.1:{free_port}/{DATABASE}"
    assert "look whether the server runs and can be reached" in refusal(nobody, plant)
    missing = database.replace(DATABASE, "nowhere")
    assert 'database "nowhere" does not exist): make the database' in refusal(missing, plant)
    guest = f"guest_{plant}"
    with postgres.connection() as db:
        db.execute(f"CREATE ROLE {guest} LOGIN PASSWORD '{PASSWORD}'")
    sentence = refusal(database.replace(USER, guest), plant)
    assert "permission denied" in sentence and "let this user use and make schemas and tables" in sentence
    with monkeypatch.context() as patch:
        patch.setattr("arboleda_fleet.postgres.server.OLDEST", 99)
        assert "and this needs 99 or newer" in refusal(database, plant)
    monkeypatch.setenv("PGPASSWORD", "a-wrong-one")
    sentence = refusal(database, plant)
    assert f'(password authentication failed for user "{USER}"): look at the user and' in sentence
    assert "a-wrong-one" not in sentence


def test_tables_of_a_newer_arboleda_are_left_alone(postgres: Server, database: str, plant: str) -> None:
    with leading(database, plant):
        pass
    with postgres.connection() as db:
        db.execute(f'UPDATE "plant_{plant}".leader SET format = 99')
    assert "is of a newer Arboleda (format 99, known: " in refusal(database, plant)
    newer = pytest.raises(ArboledaError, match="is of a newer Arboleda")
    with closing(PostgresHistory(database, plant)) as history, newer:
        history.select(TaskQuery())


def test_tables_of_an_older_arboleda_are_brought_up_with_what_they_have(
    postgres: Server, database: str, plant: str
) -> None:
    with leading(database, plant) as memory:
        memory.keep(LATCH)
    with postgres.connection() as db:
        db.execute(f'SET search_path TO "plant_{plant}"')
        db.execute("ALTER TABLE leader DROP COLUMN url, DROP COLUMN wanted, DROP COLUMN going")
        later = ("choice", "course", "unchecked", "ran_s")
        db.execute(f"ALTER TABLE task {', '.join(f'DROP COLUMN {each}' for each in later)}")
        db.execute("DROP TABLE standby")
        db.execute("UPDATE leader SET format = 1")
    history = PostgresHistory(database, plant)
    with pytest.raises(ArboledaError, match="of an older Arboleda: start the plant once"):
        history.select(TaskQuery())
    with leading(database, plant) as memory:
        assert memory.facts(Fact.LATCH) == {"ra1": "on"} and memory.lead.going == ()
        memory.lead.announce("http://127.0.0.1:8080")
    assert history.select(TaskQuery()) == []
    history.close()


def test_others_see_who_leads_who_waits_and_what_was_left_at_work(database: str, plant: str) -> None:
    others = PostgresLeadership(database, plant)
    others.prepare()
    assert not others.leader().leads
    with leading(database, plant) as first:
        assert (first.lead.own_address(), others.own_address()) == ("", ""), "it is the database's host"
        first.lead.announce("http://host-a:8080")
        seen = others.leader()
        assert (seen.leads, seen.process, seen.url) == (True, os.getpid(), "http://host-a:8080")
        others.wait_here()
        others.wait_here("http://host-b:8080")
        assert others.leader().standbys == 1
        assert first.lead.renew() is False
        assert first.lead.standbys == (Standby(host=socket.gethostname(), url="http://host-b:8080"),)
        others.wait_no_more()
        assert others.leader().standbys == 0
        assert first.lead.renew() is False and first.lead.standbys == ()
        others.ask_for_handover()
        assert first.lead.renew() is True
        first.lead.hand_over(["sis_a", "sis_b"])
    assert not others.leader().leads
    with leading(database, plant) as second:
        assert second.lead.going == ("sis_a", "sis_b") and others.leader().url == ""
        assert second.lead.renew() is False  # what was asked of the one before him
    with leading(database, plant) as third:
        assert third.lead.going == ()
    others.close()


def test_a_restart_of_the_server_between_two_writes_is_not_noticed(
    postgres: Server, database: str, plant: str
) -> None:
    history = PostgresHistory(database, plant)
    with leading(database, plant) as memory:
        memory.tasks.keep(QUEUED, "storage", 1.0)
        assert len(history.select(TaskQuery())) == 1
        postgres.stop(signal.SIGINT)
        postgres.start()
        memory.keep(LATCH)
        memory.confirm()
        memory.lead.renew()
        assert memory.facts(Fact.LATCH) == {"ra1": "on"}
    assert len(history.select(TaskQuery())) == 1
    history.close()


def test_a_server_that_is_away_is_one_sentence(postgres: Server, database: str, plant: str) -> None:
    with leading(database, plant) as memory:
        memory.tasks.keep(QUEUED, "storage", 1.0)
        postgres.stop()
        try:
            with pytest.raises(ArboledaError, match=r"look whether the server runs .* is not lost") as away:
                memory.keep(LATCH)
            assert not isinstance(away.value, Superseded)
        finally:
            postgres.start()
        assert [row.id for row in memory.tasks.select(TaskQuery())] == ["a"]


def test_a_server_that_says_nothing_counts_as_away_and_is_heard_again(
    postgres: Server, database: str, plant: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    others = PostgresLeadership(database, plant)
    with leading(database, plant) as memory, closing(others):
        memory.lead.renew()
        epoch = others.leader().epoch
        postgres.freeze(on=True)
        try:
            with monkeypatch.context() as patch:
                patch.setattr("arboleda_fleet.postgres.server.ANSWER_S", 1.0)
                for ask in (lambda: memory.keep(LATCH), memory.lead.renew, others.leader):
                    with pytest.raises(ArboledaError, match="gave no answer for 1 s"):
                        ask()
        finally:
            postgres.freeze(on=False)
        memory.lead.renew()
        assert others.leader().epoch == epoch and others.leader().leads


def test_who_is_frozen_with_a_lock_keeps_nobody_out(postgres: Server, database: str, plant: str) -> None:
    with leading(database, plant) as memory:
        memory.keep(LATCH)
        frozen = memory.session.another()  # a session as the plant's own, which has begun and never goes on
        frozen.execute("BEGIN")
        frozen.execute("SELECT fenced(1, true)")
        with postgres.connection() as db:
            db.execute(f"SET lock_timeout = '{PATIENCE_S:.0f}s'")
            db.execute(f'UPDATE "plant_{plant}".leader SET epoch = 2')
        with pytest.raises(psycopg.Error):
            frozen.execute("COMMIT")
        frozen.close()
