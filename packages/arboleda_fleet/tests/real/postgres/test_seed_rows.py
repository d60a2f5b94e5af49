"""Seeds as rows of a real database: each is done once, and again where its worker died."""

from __future__ import annotations

import threading
from uuid import uuid4

import pytest
from tests.patience import PATIENCE_S
from tests.postgres import Server

from arboleda.model.errors import StartError
from arboleda_fleet.postgres.seeds import SeedRow, SeedRows


def done(seed: int) -> SeedRow:
    return SeedRow(seed=seed, digest=f"digest of {seed}", cycles=3)


@pytest.fixture
def campaign() -> str:
    return uuid4().hex


def test_workers_share_the_seeds_and_each_is_done_once(database: str, campaign: str) -> None:
    asked: list[int] = []
    all_have_one = threading.Barrier(3)

    def work() -> None:
        rows = SeedRows(database, campaign)
        rows.lay_out(10, 30)
        first = True

        def run(seed: int) -> SeedRow:
            nonlocal first
            asked.append(seed)
            if first:
                all_have_one.wait(PATIENCE_S)
                first = False
            return done(seed)

        while rows.do_next(run) is not None:
            pass
        rows.close()

    threads = [threading.Thread(target=work) for _ in range(3)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    rows = SeedRows(database, campaign)
    assert sorted(asked) == list(range(10, 40))
    assert [(row.seed, row.digest) for row in rows.rows()] == [(n, f"digest of {n}") for n in range(10, 40)]
    rows.close()


def test_a_seed_whose_worker_died_is_done_by_another_one(
    postgres: Server, database: str, campaign: str
) -> None:
    one, other = SeedRows(database, campaign), SeedRows(database, campaign)
    foreign = SeedRows(database, f"{campaign}b")
    foreign.lay_out(2, 1)
    one.lay_out(1, 2)

    def dies(seed: int) -> SeedRow:
        assert other.do_next(lambda second: done(second)).seed == 2  # the first one is taken
        assert other.do_next(done) is None
        with postgres.connection() as db:
            db.execute(
                "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE state = 'idle in transaction'"
            )
        return done(seed)

    with pytest.raises(StartError):
        one.do_next(dies)
    again = other.do_next(done)
    assert again is not None and again.seed == 1
    assert [row.digest for row in other.rows()] == ["digest of 1", "digest of 2"]
    assert [row.digest for row in foreign.rows()] == [None], "campaigns know nothing of each other"
    for each in (one, other, foreign):
        each.close()
