"""`arboleda record` and `arboleda record replay` on what a plant has written that does not run any more."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli import logs
from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError
from arboleda.model.messages import TaskRequest
from arboleda.model.plant_files import PlantFiles
from arboleda.model.recording import Limits
from arboleda.plant_file import loader
from arboleda.recorder import copying, files, reader
from arboleda.recorder.errors import NoRecord
from arboleda.recorder.steps import TOPIC
from arboleda_proofs.campaigns.simulated_recorder import SECOND, SimulatedRecorder
from arboleda_proofs.commands import replay
from arboleda_proofs.playback import recorded_plant

SHIPPED = loader.load_recorded()[1]
TASK = "sis_a 0B 7 #lot-1"
BEGAN_NS = 1_790_000_000 * SECOND


@pytest.fixture(scope="module")
def state(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The state directory of a plant without devices, which queued a task and refused another one."""
    assert SHIPPED is not None
    folder = tmp_path_factory.mktemp("state")
    recorder = SimulatedRecorder(folder / files.FOLDER, SHIPPED.files, Limits(), BEGAN_NS)
    plant = recorder.plant(loader.load(), epoch=BEGAN_NS // SECOND, now=0.0)
    plant.step(0.0, ())
    for now, text in ((1.0, TASK), (2.0, "sis_z 0B 7")):
        plant.step(now, [TaskRequest(at=now, text=text)])
    recorder.close()
    return folder


def said(*args: str, status: int = 0) -> str:
    outcome = CliRunner().invoke(cli, list(args), catch_exceptions=False)
    assert outcome.exit_code == status, outcome.output
    return outcome.output


def test_records_are_listed_with_date_and_size(state: Path) -> None:
    (line,) = said("record", "list", "--state", str(state)).splitlines()
    (part,) = files.parts_in(state / files.FOLDER)
    assert line.endswith(f" MB  {part.path}") and line.startswith("20")


def test_a_plant_without_records_is_a_sentence(tmp_path: Path) -> None:
    assert said("record", "list", "--state", str(tmp_path)).endswith("has no record\n")
    with pytest.raises(ConfigError, match="has no record: a plant that runs writes one"):
        said("record", "info", "--state", str(tmp_path))


def test_what_is_no_record_is_listed_as_such(tmp_path: Path) -> None:
    (tmp_path / files.FOLDER).mkdir()
    (tmp_path / files.FOLDER / "7-0001.mcap").write_bytes(b"")
    assert said("record", "list", "--state", str(tmp_path)).rstrip().endswith("7-0001.mcap is empty.")


def test_info_says_what_is_in_it(state: Path) -> None:
    lines = said("record", "info", "--state", str(state)).splitlines()
    assert lines[0].startswith("plant arboleda, written by Arboleda ")
    assert lines[3:] == ["plant file: plant.yaml", "tasks: none ended, 1 open"]


def test_a_replay_tells_what_became_of_tasks_and_that_all_is_equal(state: Path) -> None:
    *lines, last = said("record", "replay", "--state", str(state)).splitlines()
    (queued,) = lines
    assert queued[24:] == "queued    sis_a 0B 7 (id lot-1)  ra1 was not heard yet"
    count = sum(1 for _ in reader.opened(files.parts_in(state / files.FOLDER)[0].path).raw())
    assert last == f"{count} steps, all equal"


def test_a_replay_ends_where_it_is_told_to(state: Path) -> None:
    assert "1 steps" not in said("record", "replay", "--state", str(state), "--task", "lot-1")
    with pytest.raises(NoRecord, match="has no step up to the time that --until names, so that nothing"):
        said("record", "replay", "--state", str(state), "--until", "2001-01-01T00:00:00")
    with pytest.raises(ConfigError, match="--until yesterday: is no time"):
        said("record", "replay", "--state", str(state), "--until", "yesterday")
    with pytest.raises(ConfigError, match="--task lot-2: there is no such task"):
        said("record", "replay", "--state", str(state), "--task", "lot-2")


def in_small_chunks(source: Path, target: Path) -> int:
    """The same steps, each of them in a chunk of its own; how many there are."""
    record = reader.opened(source)
    part = files.PartFile(target, record.first.beginning, 1, record.first.began_ns)
    for count, (unix_ns, data) in enumerate(record.raw(), start=1):  # noqa: B007
        part.put(TOPIC, unix_ns, data)
        part.flush()
    part.close()
    return count


def test_a_replay_of_a_damaged_record_says_how_much_of_it_is_read(state: Path, tmp_path: Path) -> None:
    file = tmp_path / "spoilt.mcap"
    count = in_small_chunks(files.parts_in(state / files.FOLDER)[0].path, file)
    content = file.read_bytes()
    chunks = [at for at in range(len(content)) if content[at : at + 8] == b"\x04\0\0\0zstd"]
    for number, at in enumerate(chunks[:count]):  # what comes after them is their index at the end
        file.write_bytes(content[: at + 40] + bytes([content[at + 40] ^ 1]) + content[at + 41 :])
        read = sum(1 for _ in reader.opened(file).raw())
        sentence = f"{count} steps, {read} read, then spoilt.mcap is damaged"
        if read:
            assert said("record", "replay", str(file), status=1).splitlines()[-1].startswith(sentence), number
        else:
            with pytest.raises(NoRecord, match=f"{sentence}, so that nothing was compared"):
                said("record", "replay", str(file))
    assert len(chunks) > 2 and 0 < read < count


def test_a_replay_at_a_speed_waits(state: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    waited: list[float] = []
    monkeypatch.setattr(replay.time, "sleep", waited.append)
    monkeypatch.setattr(replay.time, "monotonic", lambda: 50.0)
    said("record", "replay", "--state", str(state), "--speed", "10")
    record = reader.opened(files.parts_in(state / files.FOLDER)[0].path)
    times = [step.now for step in record.steps()]
    assert waited == pytest.approx([(at - times[0]) / 10 for at in times])


def test_another_plant_file_says_where_it_first_does_otherwise(state: Path, tmp_path: Path) -> None:
    assert SHIPPED is not None
    other = tmp_path / "other.yaml"
    other.write_bytes(SHIPPED.files.contents["plant.yaml"].replace(b"sis_a:", b"sis_q:"))
    lines = said("record", "replay", "--state", str(state), "--plant", str(other), status=1).splitlines()
    assert lines[0] == f"note: replayed with {other} instead of the plant file of the record"
    assert "steps are equal; step " in lines[-3] and lines[-3].endswith(", is not")
    asked_first = '  messages[0] (TaskChanged).task was "lot-1", is now ""'
    assert lines[-1] in (asked_first, '  state.cell was "sis_a", is now "sis_q"')  # whichever step came first


def test_another_version_says_so(state: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(replay, "__version__", "99.0")
    first = said("record", "replay", "--state", str(state)).splitlines()[0]
    assert first.startswith("note: recorded by Arboleda ") and first.endswith(", replayed by 99.0")


def test_an_export_can_be_replayed_elsewhere(state: Path, tmp_path: Path) -> None:
    kept = tmp_path / "kept.mcap"
    said("record", "export", str(kept), "--state", str(state))
    assert said("record", "replay", str(kept)) == said("record", "replay", "--state", str(state))
    with pytest.raises(NoRecord, match="is there already: name another file"):
        said("record", "export", str(kept), "--state", str(state))
    with pytest.raises(ConfigError, match=r"must end in \.mcap, \.jsonl, \.btlog, \.yaml"):
        said("record", "export", str(tmp_path / "kept.txt"), "--state", str(state))
    with pytest.raises(NoRecord, match="cannot be written: No such file or directory"):
        said("record", "export", str(tmp_path / "absent" / "kept.mcap"), "--state", str(state))


def test_lines_of_json_are_for_any_program(state: Path, tmp_path: Path) -> None:
    said("record", "export", str(tmp_path / "steps.jsonl"), "--state", str(state))
    rows = [json.loads(line) for line in (tmp_path / "steps.jsonl").read_text("utf-8").splitlines()]
    asked = [event for row in rows for event in row["events"] if event["type"] == "TaskRequest"]
    assert [event["text"] for event in asked] == [TASK, "sis_z 0B 7"]
    assert all(row["unix_s"] > 1e9 for row in rows)


def test_what_was_not_closed_is_made_whole(state: Path, tmp_path: Path) -> None:
    (part,) = files.parts_in(state / files.FOLDER)
    content = part.path.read_bytes()
    cut = tmp_path / part.path.name
    cut.write_bytes(content[:-100])
    assert "it was not closed" in said("record", "info", str(cut))
    recovered = tmp_path / f"{cut.stem}.recovered.mcap"
    assert said("record", "recover", str(cut)).startswith(f"{recovered} has ")
    assert "it was not closed" not in said("record", "info", str(recovered))
    assert said("record", "replay", str(recovered)) == said("record", "replay", "--state", str(state))


def test_a_record_whose_first_files_are_gone_is_read_and_not_replayed(state: Path, tmp_path: Path) -> None:
    (part,) = files.parts_in(state / files.FOLDER)
    record = reader.opened(part.path)
    target = tmp_path / "7-0003.mcap"
    copying.as_mcap(record, target, (3,))
    assert "its first 2 files are gone" in said("record", "info", str(target))
    with pytest.raises(NoRecord, match="cannot be replayed, only read: its first 2 files were deleted"):
        said("record", "replay", str(target))


def test_a_plant_with_files_of_its_own_is_replayed_with_those() -> None:
    source = Path(__file__).parents[5] / "examples" / "lab_bench"
    _, recording = loader.load_recorded(source / "plant.yaml")
    assert recording is not None
    contents = recording.files.contents
    assert recording.files.plant == "plant.yaml" and any(name.endswith(".py") for name in contents)
    again, first = recorded_plant.loaded(recording.files), loader.load(source / "plant.yaml")
    assert [(cell.name, [each.name for each in cell.recipes]) for cell in again.cells] == [
        (cell.name, [each.name for each in cell.recipes]) for cell in first.cells
    ]


@pytest.mark.parametrize("name", ["/etc/passwd", "../up.yaml", "a/../../up", ""])
def test_a_path_that_leads_out_of_the_record_is_refused(name: str) -> None:
    with pytest.raises(NoRecord, match="has a path that no plant writes"):
        recorded_plant.loaded(PlantFiles(plant=name))


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("record: 7", "must be a mapping"),
        ("record: {megabytes: 1}", "must be at least 2"),
        ("record: {days: 0}", "must be more than 0"),
        ("record: {hours: 2}", 'the key "hours" is not known'),
    ],
)
def test_a_wrong_limit_is_a_problem_of_the_plant_file(text: str, problem: str) -> None:
    assert SHIPPED is not None
    content = SHIPPED.files.contents["plant.yaml"] + f"\n{text}\n".encode()
    with pytest.raises(ConfigError) as refusal:
        loader.parse("p.yaml", content)
    assert problem in str(refusal.value) and len(refusal.value.problems) == 1


def test_a_plant_file_says_how_much_is_kept_or_that_nothing_is(tmp_path: Path) -> None:
    assert SHIPPED is not None
    file = tmp_path / "plant.yaml"
    file.write_bytes(SHIPPED.files.contents["plant.yaml"] + b"\nrecord: {megabytes: 50}\n")
    recording = loader.load_recorded(file)[1]
    assert recording is not None and recording.limits == replace(SHIPPED.limits, megabytes=50.0)
    file.write_bytes(SHIPPED.files.contents["plant.yaml"] + b"\nrecord: off\n")
    assert loader.load_recorded(file)[1] is None


def test_logs_are_lines_with_date_of_all_cells_or_of_one(state: Path) -> None:
    lines = said("record", "logs", "--state", str(state)).splitlines()
    assert [line[20:].split()[0] for line in lines[:3]] == ["started", "queued", "refused"]
    assert all(re.match(r"20\d\d-\d\d-\d\d \d\d:\d\d:\d\d ", line) for line in lines)
    assert "there is no cell" in lines[2] or "sis_z" in lines[2]
    assert [line for line in lines if "queued" in line] == said(
        "record", "logs", "--state", str(state), "--cell", "sis_a"
    ).splitlines()
    assert said("record", "logs", "--state", str(state), "--cell", "sis_b") == ""
    assert (
        said("record", "logs", "--state", str(state), "--follow").splitlines() == lines
    )  # it does not run any more


def test_logs_of_a_cell_that_is_not_there_are_refused(state: Path) -> None:
    with pytest.raises(ConfigError, match="no record has a cell 'sis_d'; there are sis_a, sis_b, sis_c"):
        said("record", "logs", "--state", str(state), "--cell", "sis_d")


def test_logs_have_all_starts_in_order(state: Path, tmp_path: Path) -> None:
    (part,) = files.parts_in(state / files.FOLDER)
    folder = tmp_path / files.FOLDER
    folder.mkdir()
    for epoch in (part.epoch - 7, part.epoch):
        (folder / f"{epoch}-0001.mcap").write_bytes(part.path.read_bytes())
    once = said("record", "logs", "--state", str(state)).splitlines()
    assert said("record", "logs", "--state", str(tmp_path)).splitlines() == once * 2
    assert said("record", "logs", "--state", str(tmp_path), "--follow").splitlines() == once * 2
    assert said("record", "logs", str(part.path)).splitlines() == once
    (folder / f"{part.epoch - 9}-0001.mcap").write_bytes(b"no record")
    lines = said("record", "logs", "--state", str(tmp_path)).splitlines()
    assert lines[0].startswith("left out: ") and lines[1:] == once * 2


def test_logs_say_why_a_cell_was_held() -> None:
    why = {"key": "own", "english": "{text}", "values": {"text": "ra1 must be homed first"}}
    told = {"kind": "cell", "cell": "sis_a", "subject": "sis_a", "what": "held", "sentence": why}
    lines = list(logs._lines(logs.EVENTS, told))
    assert lines == [("sis_a", "held      sis_a  ra1 must be homed first")]
    assert not list(logs._lines(logs.EVENTS, told | {"what": "execute"}))
    assert not list(logs._lines(logs.EVENTS, told | {"kind": "robot", "what": "offline"}))


def test_what_a_step_has_to_say_for_people() -> None:
    sentence = {"key": "own", "english": "{text}", "values": {"text": "all stopped"}}
    rows: list[dict[str, object]] = [
        {"type": "Journal", "verb": "stop", "scope": "", "sentence": sentence},
        {"type": "OperatorAnswer", "verb": "resume", "scope": "sis_a", "refusal": sentence},
        {"type": "OperatorAnswer", "verb": "hold", "scope": "sis_a"},
        {"type": "Absence", "seconds": 2.0},
        {"type": "InternalError", "cell": "sis_b", "error": "KeyError: 'x'"},
        {"type": "Heartbeat", "epoch": 1},
    ]
    assert list(logs._lines(logs.STEPS, {"messages": rows})) == [
        (None, "all stopped"),
        (None, "resume sis_a was refused: all stopped"),
        (None, "the plant was away for 2.0 s"),
        ("sis_b", "internal error in sis_b (KeyError: 'x')"),
    ]
