"""Options of a simulation: their defaults, and which exclude each other, for every command that has them."""

from __future__ import annotations

from arboleda.extension import Phrase
from arboleda_proofs.simulator.levels import CRASHES

SEED, SEEDS, CYCLES, LEVEL = 1, 20, 50, "normal"
ONE_SEED = Phrase("cli.simulate.one_seed", "--trace and --record are for one seed; choose it with --seed")
STANDBY_OR_REVISIONS = Phrase(
    "cli.simulate.standby_or_revisions", "--standby and --revisions exclude each other"
)
OWN_DEATHS = Phrase("cli.simulate.own_deaths", "--standby has deaths of its own: leave out --faults crashes")


def exclusion(
    *, one_seed: bool, seeds: int | None, until_failure: bool, standby: bool, revisions: bool, faults: str
) -> Phrase | None:
    """The reason why these options exclude each other; None where they do not. `one_seed`: one is shown."""
    if one_seed and ((seeds or 1) > 1 or until_failure):
        return ONE_SEED
    if standby and revisions:
        return STANDBY_OR_REVISIONS
    return OWN_DEATHS if standby and faults == CRASHES else None
