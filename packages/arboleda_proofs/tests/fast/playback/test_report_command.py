"""`arboleda report` on records of simulated runs."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Callable
from dataclasses import replace
from html import unescape
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError
from arboleda.recorder.chapter import Chapter, chapter
from arboleda.rig.world import World
from arboleda.web.schema.answers import model_of
from arboleda_proofs.answers import TaskReport
from arboleda_proofs.playback.report import reading
from arboleda_proofs.routes.reports import DATA
from arboleda_proofs.simulator.faults import KINDS, Fault
from arboleda_proofs.testing import Sim

from .test_fork_command import written

Act = Callable[[World], None]


def fault(kind: str, target: str, seconds: float = 0.0, **more: Any) -> Act:
    def begin(world: World) -> None:
        end = KINDS[kind].begin(world, Fault(kind=kind, at=0.0, target=target, seconds=seconds, **more))
        if end is not None:
            world.at(world.now + seconds, lambda _: end())

    return begin


def reported(folder: Path, at: float, act: Act) -> str:
    """The report of a task in which something went wrong; what the command says is checked."""
    record = written(folder, None, "sis_a 0B 7 #lot", (at, act))
    target = folder / "lot.html"
    arguments = ["report", "lot", "--record", str(record), "--output", str(target)]
    outcome = CliRunner().invoke(cli, arguments, catch_exceptions=False)
    assert outcome.exit_code == 0 and outcome.output.splitlines()[1].startswith(f"{target} has ")
    content = target.read_text("utf-8")
    assert unescape(content).count(outcome.output.splitlines()[0]) >= 1
    return content


def test_of(content: str) -> str:
    found = re.search(r"<pre id=test>(.*?)</pre>", content, re.DOTALL)
    assert found is not None
    return unescape(found[1])


test_of.__test__ = False  # type: ignore[attr-defined]


@pytest.mark.long
@pytest.mark.parametrize(
    ("at", "act", "cause", "same"),
    [
        (
            5.3,
            fault("mute", "ra_1", 2.6),
            "ra1 said nothing for 2.",
            "no telemetry for 1.5 s while moving to s",
        ),
        (
            5.3,
            fault("driver_alarm", "ra_1", 4.0),
            "ra1 reported a fault of its own",
            "the board reports a fault",
        ),
        (2.5, fault("brown_out", "rm_sis_a", 3.0), "the board of rm_sis_a booted", "driving path 0B"),
        (
            3.0,
            fault("stuck_effector", "ra_1", 30.0),
            "clamp of ra1 did not do",
            "while switching the effector on",
        ),
    ],
)
def test_the_test_of_a_report_fails_in_the_same_way(
    tmp_path: Path, at: float, act: Act, cause: str, same: str
) -> None:
    content = reported(tmp_path, at, act)
    assert cause in content
    names: dict[str, Any] = {}
    exec(test_of(content), names)
    with pytest.raises(AssertionError, match=same):
        names["test_what_failed_in_sis_a"](Sim())


@pytest.mark.long
@pytest.mark.parametrize("kind", ["stuck_effector", "opened_effector"])
def test_forks_that_do_not_fail_as_the_record_did_say_that_they_prove_nothing(
    tmp_path: Path, kind: str
) -> None:
    act = fault(kind, "ra_1", 30.0 if kind == "stuck_effector" else 0.0)
    content = reported(tmp_path, 3.0 if kind == "stuck_effector" else 6.0, act)
    assert "forks prove nothing here" in content and "no prueban nada" in content
    assert "Forks that were really run" not in content
    assert "had nothing befallen the devices" not in content


@pytest.mark.long
def test_a_report_is_small_whole_and_in_two_languages(tmp_path: Path) -> None:
    content = reported(tmp_path, 5.3, fault("mute", "ra_1", 2.6))
    assert len(content.encode()) < 2_000_000
    assert not re.search(r"(src|href)=", content.split("<script>")[0])
    assert "ra1 no dijo nada durante" in content and "ir a la estación 7 [*]" in content
    assert "failed sis_a 0B 7 (id lot): ra1: no telemetry for 1.5 s" in content  # the fork without a change
    assert "Forks that were really run" in content and "prove nothing" not in content
    assert content.count("done sis_a 0B 7 (id lot)") == 2  # without what befell it, and with more patience


@pytest.mark.long
def test_a_report_has_its_facts_as_data(tmp_path: Path) -> None:
    content = reported(tmp_path, 5.3, fault("mute", "ra_1", 2.6))
    report = facts_of(content)
    assert (report.task, report.cell, report.reason) == ("lot", "sis_a", "link_lost")
    assert report.cause is not None and (report.cause.kind, report.cause.robot) == ("silence", "ra1")
    assert report.cause.key == "cause.silence" and "ra1 said nothing for 2." in report.cause.sentence
    assert report.evidence is not None and report.evidence.troubles[0].kind == "silence"
    assert report.evidence.last_command is not None and report.evidence.last_command.at_s < 0


def test_a_task_without_failure_and_one_that_is_nowhere_are_sentences(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reading, "FLUSH_S", -9.0)
    record = written(tmp_path, None, "sis_a 0B 7 #lot", None)
    with pytest.raises(ConfigError, match="lot: it is done, so there is nothing to report"):
        CliRunner().invoke(cli, ["report", "lot", "--record", str(record)], catch_exceptions=False)
    with pytest.raises(ConfigError, match="other: no record of this plant has such a task"):
        CliRunner().invoke(cli, ["report", "other", "--state", str(tmp_path)], catch_exceptions=False)


PICTURE = b"<svg xmlns='http://www.w3.org/2000/svg'><script>alert(1)</script></svg>"
SEEN = chapter("lot", "camera", "Seen <b>", "__DATA__ & more\nsecond line", [("gap", "0.3 mm")], PICTURE)


def in_folder(folder: Path, *chapters: Chapter, act: tuple[float, Act] | None = None) -> list[str]:
    """Output of `arboleda report` on a task in the records of a state directory, and the file it writes."""
    (folder / "record").mkdir()
    written(folder / "record", None, "sis_a 0B 7 #lot", act, chapters)
    target = folder / "lot.html"
    arguments = ["report", "lot", "--state", str(folder), "--output", str(target)]
    outcome = CliRunner().invoke(cli, arguments, catch_exceptions=False)
    assert outcome.exit_code == 0, outcome.output
    return [*outcome.output.splitlines(), target.read_text("utf-8")]


def test_of_a_task_that_is_done_the_report_has_what_packages_wrote(tmp_path: Path) -> None:
    *said, content = in_folder(tmp_path, SEEN)
    assert len(said) == 1 and said[0].startswith(f"{tmp_path / 'lot.html'} has ")
    assert "<title>Task lot</title>" in content and "Tarea lot" in content
    assert "<h2>Seen &lt;b&gt;</h2><p class=quiet>camera</p>" in content
    assert "<p class=lines>__DATA__ &amp; more\nsecond line</p>" in content
    assert "<tr><td>gap<td>0.3 mm</table>" in content
    assert "arboleda record replay" in content and "id=test" not in content and "id=copy" not in content
    report = facts_of(content)
    assert report.cause is None and [each.title for each in report.chapters] == ["Seen <b>"]
    assert report.chapters[0].rows == [["gap", "0.3 mm"]] and report.chapters[0].picture == "image/svg+xml"


def test_a_picture_is_an_image_in_which_no_script_runs(tmp_path: Path) -> None:
    content = in_folder(tmp_path, SEEN)[-1]
    encoded = base64.b64encode(PICTURE).decode()
    assert f'<img src="data:image/svg+xml;base64,{encoded}" alt="Seen &lt;b&gt;">' in content
    assert "alert(1)" not in content and "default-src 'none'; img-src data:;" in content


def test_what_a_later_start_wrote_about_a_task_is_in_its_report(tmp_path: Path) -> None:
    record = tmp_path / "record"
    record.mkdir()
    written(record, None, "sis_a 0B 7 #lot", None, [SEEN])
    other = tmp_path / "later"
    other.mkdir()
    late = replace(SEEN, title="Measured later")
    written(other, None, "sis_a 0B 7 #other", None, [late]).rename(record / "8-0001.mcap")
    found = reading.read("lot", None, record)
    assert [each.title for each in found.incident.chapters] == ["Seen <b>", "Measured later"]
    assert [each.title for each in reading.read("lot", record / "7-0001.mcap", record).incident.chapters] == [
        "Seen <b>"
    ]


@pytest.mark.long
def test_the_report_of_a_failure_has_them_after_the_evidence(tmp_path: Path) -> None:
    content = in_folder(tmp_path, SEEN, act=(5.3, fault("mute", "ra_1", 2.6)))[-1]
    parts = [content.index(each) for each in ("ra1 said nothing for", "Seen &lt;b&gt;", "id=test")]
    assert parts == sorted(parts)
    assert facts_of(content).cause is not None and len(facts_of(content).chapters) == 1


def facts_of(content: str) -> Any:
    found = DATA.search(content)
    assert found is not None
    return model_of(TaskReport).model_validate({**json.loads(found[1])["facts"], "state": "written"})
