"""Workers of a campaign as processes, one of them killed: the seeds come to what they come to alone."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.postgres import Server

pytestmark = pytest.mark.system

SEEDS = ("--seeds", "3", "--cycles", "1", "--faults", "none")
PATIENCE_S = 90.0


def digests(file: Path) -> dict[int, str]:
    return {row["seed"]: row["digest"] for row in json.loads(file.read_text())["seeds"]}


def test_seeds_that_workers_share_come_to_the_same_as_alone(
    start: Callable[..., Any], postgres: Server, database: str, tmp_path: Path
) -> None:
    import sys

    from tests.system.conftest import paths

    def simulate(*options: str) -> Any:
        main = "from arboleda.cli.main import main; main()"
        return start(sys.executable, "-c", main, "simulate", *SEEDS, *options, env={"PYTHONPATH": paths()})

    with postgres.connection() as db:
        db.execute("DROP SCHEMA IF EXISTS arboleda_simulate CASCADE")
    shared = ("--store", database, "--worker", "--json", str(tmp_path / "shared.json"))
    killed = simulate(*shared)
    killed.wait_for("campaign ")
    others = [simulate(*shared), simulate(*shared)]
    killed.kill()
    for each in others:
        each.wait_for("HELD: every seed", patience_s=PATIENCE_S)
        assert each.wait() == 0 and "3 seeds by" in each.output
    alone = simulate("--json", str(tmp_path / "alone.json"), "--jobs", "1")
    alone.wait_for("HELD", patience_s=PATIENCE_S)
    assert alone.wait() == 0
    assert digests(tmp_path / "shared.json") == digests(tmp_path / "alone.json")
    refused = simulate("--worker")
    assert refused.wait() == 2 and "--worker needs --store" in refused.output
