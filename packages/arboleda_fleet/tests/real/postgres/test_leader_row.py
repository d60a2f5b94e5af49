"""The leader's row of the simulated store does as the statements do on a real server."""

from __future__ import annotations

import random
from datetime import timedelta

import psycopg
import pytest
from tests.lengths import length
from tests.postgres import Server

from arboleda.departures.leading import LEASE_S, WANTED_S
from arboleda.model.messages import Fact, Remember
from arboleda.rig.hosts.database import LeaderRow
from arboleda.store.lead import Superseded
from arboleda_fleet.postgres.lead import LEAD
from arboleda_fleet.postgres.leader_row import END_LEASE, LAST_SEEN
from arboleda_fleet.postgres.leadership import PostgresLeadership
from arboleda_fleet.postgres.memory import PostgresMemory

NOW = 1000.0
AGES_S = (0.1, LEASE_S + 1.0, WANTED_S - 5.0, WANTED_S + 5.0, -3600.0)  # or the clock is set back


class Both:
    """A row and a database to which the same is done; time passes in both as their times grow older.

    Before each deed the times of the database are made as old as those of the row: how long the deeds before
    it took does not count.
    """

    def __init__(self, server: Server, address: str, plant: str, dice: random.Random) -> None:
        self._dice = dice
        self.row = LeaderRow(epoch=0)
        self.others = PostgresLeadership(address, plant)
        self.processes: list[tuple[PostgresMemory, int]] = []
        self._server, self._address, self._plant = server, address, plant
        self.others.prepare()

    def lead(self, proposed: int) -> None:
        self._agree()
        expected = self.row.lead(proposed, NOW)
        if expected is None:  # the process itself would wait for the end of the lease
            with self._connection() as db:
                values = (proposed, "x", 1, WANTED_S)
                assert db.execute(LEAD, values).fetchone() is None
            return
        memory = PostgresMemory(self._address, self._plant)
        memory.open()
        assert (memory.lead.take(proposed), tuple(memory.lead.going)) == expected
        self.processes.append((memory, expected[0]))

    def renew(self, memory: PostgresMemory, epoch: int) -> None:
        self._agree()
        expected = self.row.renew(epoch, NOW)
        if expected is None:
            with pytest.raises(Superseded):
                memory.lead.renew()
        else:
            assert memory.lead.renew() is expected

    def write(self, memory: PostgresMemory, epoch: int) -> None:
        said = Remember(fact=Fact.EFFECTOR, name="ra1", value="on")
        if self.row.is_fenced(epoch):
            memory.keep(said)
        else:
            with pytest.raises(Superseded):
                memory.keep(said)

    def hand_over(self, memory: PostgresMemory, epoch: int) -> None:
        memory.lead.hand_over(["sis_a", f"after {epoch}"])
        self.row.hand_over(epoch, ["sis_a", f"after {epoch}"])

    def end(self, memory: PostgresMemory, epoch: int) -> None:
        memory.close()
        self.row.give_back(epoch)
        self.processes.remove((memory, epoch))

    def want(self) -> None:
        self.others.ask_for_handover()
        self.row.wanted = NOW

    def grow_older(self, seconds: float) -> None:
        self.row.renewed_at = None if self.row.renewed_at is None else self.row.renewed_at - seconds
        self.row.wanted = None if self.row.wanted is None else self.row.wanted - seconds

    def end_lease(self) -> None:
        """As who has waited for the length of a lease, and has perhaps missed a sign of life."""
        self._agree()
        said_nothing = self._dice.random() < 0.5
        with self._connection() as db:
            seen = db.execute(LAST_SEEN).fetchone()
            if seen is None or seen[1] is None:
                return
            values = seen if said_nothing else (seen[0], seen[1] - timedelta(seconds=0.5))
            db.execute(END_LEASE, values)
        last = self.row.lease_state
        self.row.end_lease(last if said_nothing else (last[0], NOW + 1.0))

    def compare(self) -> None:
        self._agree()
        leader = self.others.leader()
        assert (leader.epoch, leader.leads) == (self.row.epoch, self.row.leads(NOW))

    def close(self) -> None:
        for memory, _ in self.processes:
            memory.close()
        self.others.close()

    def _agree(self) -> None:
        ages = [None if at is None else NOW - at for at in (self.row.renewed_at, self.row.wanted)]
        with self._connection() as db:
            known = db.execute("SELECT seen IS NULL, wanted IS NULL FROM leader").fetchone()
            assert known in (None, tuple(age is None for age in ages))
            db.execute(
                "UPDATE leader SET seen = clock_timestamp() - %s * interval '1 second',"
                " wanted = clock_timestamp() - %s * interval '1 second'",
                ages,
            )

    def _connection(self) -> psycopg.Connection:
        db = self._server.connection()
        db.execute(f'SET search_path TO "plant_{self._plant}"')
        return db


@pytest.mark.parametrize("seed", range(length(1, 3)))
def test_the_row_of_the_simulator_does_what_a_server_does(
    postgres: Server, database: str, plant: str, seed: int
) -> None:
    dice = random.Random(seed)
    both = Both(postgres, database, plant, dice)
    of_one = (both.renew, both.renew, both.write, both.write, both.hand_over, both.end)
    try:
        for _ in range(60):
            what = dice.randrange(5)
            if what == 0 or not both.processes:
                both.lead(dice.randrange(40))
            elif what == 1:
                both.grow_older(dice.choice(AGES_S))
            elif what == 2 and dice.random() < 0.4:
                both.want()
            elif what == 3:
                both.end_lease()
            else:
                dice.choice(of_one)(*dice.choice(both.processes))
            both.compare()
    finally:
        both.close()
