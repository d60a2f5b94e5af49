"""Real runs, with real clocks and threads, executed again from their records."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.system.test_walk_back import Site
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.recorder import reader
from arboleda.recorder.files import FOLDER, parts_in

pytestmark = pytest.mark.system
TASKS = "/api/tasks"


@pytest.fixture
def site(tmp_path: Path) -> Iterator[Site]:
    made = Site(tmp_path)
    yield made
    made.end()


def replayed(file: Path) -> list[str]:
    """Output of a replay of it; all its steps are equal."""
    outcome = CliRunner().invoke(cli, ["record", "replay", str(file)], catch_exceptions=False)
    assert outcome.exit_code == 0, outcome.output
    lines = outcome.output.splitlines()
    assert lines[-1].endswith(" steps, all equal")
    return lines


@pytest.mark.smoke
def test_a_killed_start_and_the_next_one_are_the_same_again(site: Site, tmp_path: Path) -> None:
    site.until(lambda cell: cell["not_ready"] is None)
    plant = site.plant
    assert plant.ask("POST", TASKS, {"text": "sis_a 0B 7 #lot-1"})[0] == 202
    assert plant.ask("POST", TASKS, {"text": "sis_b 1C 3 #lot-2"})[0] == 202
    assert plant.ask("POST", TASKS, {"text": "sis_z"})[0] >= 400
    site.until(lambda cell: cell["step"] == "drive path 0B")
    assert plant.ask("POST", "/api/cells/sis_b/hold")[0] == 200
    site.until(lambda cell: cell["step"] == "move to station 7")
    plant.ask("POST", "/api/cells/sis_b/resume")
    (first,) = parts_in(tmp_path / "state" / FOLDER)
    site.until(
        lambda _: b'"state":"running"' in b"".join(data for _, data in reader.opened(first.path).raw())
    )
    site.kill()
    site.until(lambda cell: cell["state"] == "held" and "resume" not in cell["refused"])
    assert site.plant.ask("POST", "/api/cells/sis_a/resume")[0] == 200
    site.until(lambda cell: cell["state"] == "idle")
    assert site.plant.ask("POST", "/api/cells/sis_b/stop")[0] == 200
    assert site.plant.ask("POST", TASKS, {"text": "sis_a 0B 6 #lot-3"})[0] == 202
    site.until(lambda cell: cell["state"] == "execute")
    assert site.plant.interrupt() == 0
    _, second = parts_in(tmp_path / "state" / FOLDER)
    killed, ended = reader.opened(first.path), reader.opened(second.path)
    assert {"lot-1", "lot-2"} <= {each.id for each in ended.first.beginning.kept}
    assert any("running   sis_a 0B 7 (id lot-1)" in line for line in replayed(first.path))
    assert any("done      sis_a 0B 7 (id lot-1)" in line for line in replayed(second.path))
    for record, whole in ((killed, False), (ended, True)):
        assert sum(1 for _ in record.steps()) > 20
        assert record.last is not None and record.last.whole is whole
