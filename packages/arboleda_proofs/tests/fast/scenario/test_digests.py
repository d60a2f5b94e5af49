"""A change that is meant to change nothing leaves the digests of seeds as they were.

A change that is meant to change what happens says so in CHANGELOG.md, and writes the new digests:
`.venv/bin/python -m packages.arboleda_proofs.tests.fast.scenario.test_digests`.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from arboleda_proofs.campaigns.request import Request

PINNED = Path(__file__).with_name("digests.json")
SEEDS, CYCLES = range(1, 9), 12


def digest(seed: int) -> str:
    return Request(cycles=CYCLES).setting.run(seed).digest


@pytest.mark.sampled(8)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_seed_of_the_packaged_plants_has_its_digest(seed: int) -> None:
    assert digest(seed) == json.loads(PINNED.read_text())[str(seed)], __doc__


if __name__ == "__main__":
    PINNED.write_text(json.dumps({seed: digest(seed) for seed in SEEDS}, indent=1) + "\n")
