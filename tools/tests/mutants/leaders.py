"""Bugs of a plant with a leader and a standby."""

from __future__ import annotations

from arboleda.departures.leading import Lease, may_leave
from arboleda.rig.hosts.database import LeaderRow
from arboleda.sim.receipts import Receipts

from .mutant import edit, mutant

CHANGES = {"leader_frozen": 8.0, "store_cut": 6.0, "store_slow": 3.0, "clock_drift": 4.0, "handover": 2.0}
LATE = {"leader_frozen": 10.0}

LEADERS = (
    mutant(
        "one_leader_at_a_time",
        "A leader believes for ever that its lease lasts.",
        edit(Lease.lasts, "now < self._until", "True"),
        weather=CHANGES,
        standby=True,
    ),
    mutant(
        "a_lead_is_over_before_the_next_begins",
        "A leader is sure of itself for a fifth longer than it may.",
        edit(Lease.renewed, "sent_at + SURE_S", "sent_at + 1.2 * SURE_S"),
        weather=CHANGES,
        standby=True,
    ),
    mutant(
        "each_number_is_led_once",
        "A standby leads under the number that it proposes.",
        edit(LeaderRow.lead, "max(self.epoch + 1, proposed)", "proposed"),
        weather={**CHANGES, "clock_step": 10.0},
        standby=True,
    ),
    mutant(
        "old_numbers_have_no_effect",
        "A board forgets under which number it has heard a leader beat.",
        edit(Receipts.objection, "self.least is not None and goal.epoch < self.least", "False"),
        weather=LATE,
        likely=141,
        standby=True,
    ),
    mutant(
        "history_is_one",
        "The store takes what a leader of before writes.",
        edit(LeaderRow.is_fenced, "epoch == self.epoch", "True"),
        weather=CHANGES,
        standby=True,
        likely=4,
    ),
)
PLANTED_LEADERS = (
    mutant(
        "one_leader_at_a_time",
        "Who was superseded still stops the robots of the next leader.",
        edit(may_leave, "return standing is Standing.LEADS", "return True"),
        weather=CHANGES,
        standby=True,
    ),
)
