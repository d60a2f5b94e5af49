"""Options of a simulation: their defaults, and words on those that exclude each other."""

from __future__ import annotations

from arboleda.extension import Phrase

SEED, SEEDS, CYCLES, LEVEL = 1, 20, 50, "normal"
ONE_SEED = Phrase("cli.simulate.one_seed", "--trace and --record are for one seed; choose it with --seed")
STANDBY_OR_REVISIONS = Phrase(
    "cli.simulate.standby_or_revisions", "--standby and --revisions exclude each other"
)
OWN_DEATHS = Phrase("cli.simulate.own_deaths", "--standby has deaths of its own: leave out --faults crashes")
