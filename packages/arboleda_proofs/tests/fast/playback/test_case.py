"""A record's inputs as a case of the simulator: the same is asked at the same times, and the same fails."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError
from arboleda.recorder import reader
from arboleda_proofs.playback.report.reading import incident_of

from ..campaigns.test_simulate_record import Said, lines_in, said

__all__ = ["said"]
Asked = list[tuple[float, str]]
FAULTS = [
    {"kind": "stuck_effector", "at": 2.0, "target": "ra_1", "seconds": 9.0},
    {"kind": "mute", "at": 28.5, "target": "ra_1", "seconds": 3.0},
    {"kind": "driver_alarm", "at": 40.5, "target": "ra_1", "seconds": 3.0},
    {"kind": "operator_stop", "at": 55.0, "target": "sis_a"},
]


def happened(file: str) -> tuple[Asked, list[tuple[str, str]]]:
    """Tasks that were asked for in a record, with their times; those that failed, with the reason."""
    record = reader.opened(Path(file))
    asked, failed = {}, []
    for step in record.steps():
        for row in step.result["messages"]:
            if row["type"] == "TaskChanged" and row["state"] == "queued":
                asked.setdefault(row["task"], (round(step.now, 3), row["text"]))
            elif row["type"] == "TaskChanged" and row["state"] == "failed":
                cause = incident_of(row["task"], record)[0].cause
                failed.append((row["text"], f"{cause.kind} {cause.robot}"))
    return [*asked.values()], failed


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The record of a seed in which something befalls the arm three times, and an operator stops its cell."""
    folder = tmp_path_factory.mktemp("recorded")
    with pytest.MonkeyPatch.context() as patch:
        said = lines_in(folder, patch)
        Path("faults.json").write_text(json.dumps({"faults": FAULTS}))
        words = ("--plant", "small.yaml", "--cycles", 1, "--faults", "faults.json", "--record", "a.mcap")
        said("simulate", *words)
    return folder / "a.mcap"


@pytest.fixture
def record(said: Said, recorded: Path) -> str:
    shutil.copy(recorded, "a.mcap")
    return "a.mcap"


@pytest.mark.long
def test_the_same_is_asked_at_the_same_times_and_the_same_fails(said: Said, record: str) -> None:
    (line,) = said("record", "export", "case.yaml", record)
    assert line.startswith("case.yaml has ") and " tasks, " in line
    said("simulate", "--plant", "small.yaml", "--faults", "case.yaml", "--record", "b.mcap")
    asked, failed = happened(record)
    assert [cause for _, cause in failed] == ["switch ra1", "silence ra1", "alarm ra1", "operator None"]
    assert happened("b.mcap") == (asked, failed)


@pytest.mark.long
def test_a_case_of_one_task_begins_with_it_and_ends_soon_after_it(said: Said, record: str) -> None:
    line = [line for line in said("record", "replay", record) if " failed " in line][1]
    found = re.search(r" failed +(.*) \(id t-(.*)\) ", line)
    assert found is not None
    said("record", "export", "one.yaml", record, "--task", f"t-{found[2]}")
    first = next(line for line in Path("one.yaml").read_text().splitlines() if "task:" in line)
    assert first == f'  - {{at: 2, task: "{found[1]} #{found[2]}"}}'
    said("simulate", "--plant", "small.yaml", "--faults", "one.yaml", "--record", "b.mcap")
    assert happened("b.mcap")[1][:1] == happened(record)[1][1:2]


@pytest.mark.long
def test_what_cannot_be_a_case_is_a_sentence(said: Said, record: str) -> None:
    for words, sentence in (
        (("a.yaml", record, "--task", "nobody"), "nobody: it did not begin in this record"),
        (("a.jsonl", record, "--task", "1"), "a.jsonl: --task ID is for files that end in .btlog or .yaml"),
        (("small.yaml", record), "small.yaml: is there already; name another file"),
        (("no/a.yaml", record), "no/a.yaml: cannot be written: No such file or directory"),
    ):
        with pytest.raises(ConfigError) as refused:
            CliRunner().invoke(cli, ["record", "export", *words], catch_exceptions=False)
        assert str(refused.value) == sentence
