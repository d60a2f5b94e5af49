"""`arboleda simulate` with one small cell and invariants that are planted where something is to break."""

from __future__ import annotations

import io
import json
import os
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from itertools import count
from pathlib import Path
from typing import Any

import pytest

from arboleda.cli.main import main
from arboleda.model.plant_model import Evidence
from arboleda.plant_file import loader
from arboleda.testing.plants import shared
from arboleda.testing.storage_layout import StorageLayout
from arboleda_proofs.campaigns import report, screen, setting
from arboleda_proofs.campaigns.request import Request
from arboleda_proofs.campaigns.seed_campaign import SeedCampaign
from arboleda_proofs.campaigns.tally import Tally
from arboleda_proofs.campaigns.workers import Processes
from arboleda_proofs.simulator import judged
from arboleda_proofs.simulator.faults import KINDS
from arboleda_proofs.simulator.faults.titles import TITLES
from arboleda_proofs.simulator.invariants import Invariant
from arboleda_proofs.simulator.invariants.invariant import Look, Trigger, invariant

PLANT = """
name: small
paths: {0B: [0, 3, 4, 7]}
stations: {0: {deg: [20, 10], mm: 50}}
cells:
  sis_a:
    arm: {name: ra1, model: scara, mqtt: ra_1, link: mqtt, evidence: ids}
    mobile: {name: rm_sis_a, link: mqtt, evidence: ids}
    home: {deg: [0, 0], mm: 0}
    pickup: {deg: [45, 10], mm: 80}
"""


@dataclass
class Ended:
    """End of a command."""

    status: int
    said: str
    complained: str


Arboleda = Callable[..., Ended]


@pytest.fixture
def plant(tmp_path: Path) -> Path:
    file = tmp_path / "small.yaml"
    file.write_text(PLANT)
    return file


@pytest.fixture
def arboleda(plant: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Arboleda:
    """`arboleda("--seed", 3)`: simulate the small plant in this process, a task a seed, unless told so."""
    monkeypatch.setattr(judged, "INVARIANTS", ())

    def run(*words: object) -> Ended:
        usual = {"--plant": plant, "--cycles": 1, "--jobs": 1, "--faults": "none"}
        left = [word for pair in usual.items() if pair[0] not in words for word in pair]
        monkeypatch.setattr(sys, "argv", ["arboleda", "simulate", *map(str, (*words, *left))])
        with pytest.raises(SystemExit) as end:
            main()
        out, err = capsys.readouterr()
        return Ended(int(end.value.code or 0), out, err)

    return run


@pytest.fixture
def brittle(arboleda: Arboleda, monkeypatch: pytest.MonkeyPatch) -> Invariant:
    """The one invariant, which a reboot breaks; it does nothing else."""

    @invariant(Trigger.ALWAYS)
    def unbooted(look: Look) -> Iterable[str]:
        """Nothing reboots, ever."""
        if hasattr(look.world, "rebooted"):
            yield f"{look.world.rebooted} rebooted"

    def begin(world: Any, fault: Any) -> None:
        world.rebooted = fault.target

    monkeypatch.setitem(KINDS, "reboot", replace(KINDS["reboot"], begin=begin))
    monkeypatch.setattr(judged, "INVARIANTS", (unbooted,))
    return unbooted


@pytest.fixture
def faults(tmp_path: Path) -> Path:
    """A file with a reboot among seven other faults."""
    harmless = [{"kind": "bridge_stall", "at": 5.0 * n, "seconds": 0.1} for n in range(1, 8)]
    file = tmp_path / "faults.json"
    file.write_text(json.dumps({"faults": [*harmless, {"kind": "reboot", "at": 33.25, "target": "ra_1"}]}))
    return file


def test_where_everything_holds_it_says_so_and_ends_with_0(arboleda: Arboleda) -> None:
    ended = arboleda("--seeds", 2)
    assert ended.status == 0
    assert "2 seeds (1 to 2)" in ended.said and ended.said.endswith("\nHELD: 1 invariant\n")
    assert "done" in ended.said and "\x1b" not in ended.said


@pytest.mark.long
def test_the_same_seed_does_the_same_and_another_does_not(arboleda: Arboleda, tmp_path: Path) -> None:
    digests = []
    for seed in (4, 4, 6):
        arboleda("--seed", seed, "--seeds", 1, "--faults", "many", "--json", tmp_path / "out.json")
        digests += [row["digest"] for row in json.loads((tmp_path / "out.json").read_text())["seeds"]]
    assert digests[0] == digests[1] != digests[2]


@pytest.mark.long
def test_the_summary_tells_of_every_seed(arboleda: Arboleda, tmp_path: Path) -> None:
    assert arboleda("--seed", 7, "--seeds", 2, "--faults", "few", "--json", tmp_path / "out.json").status == 0
    said = json.loads((tmp_path / "out.json").read_text())
    rows = said["seeds"]
    assert [row["seed"] for row in rows] == [7, 8] and said["complete"] is True
    assert {row["plant"] for row in rows} == {"small"} and all(row["broken"] is None for row in rows)
    assert said["totals"]["cycles"] == sum(row["cycles"] for row in rows)
    assert said["totals"]["faults"] and set(said["totals"]["faults"]) <= set(KINDS)


@pytest.mark.long
@pytest.mark.usefixtures("brittle")
def test_a_breach_is_told_with_the_one_fault_it_takes(
    arboleda: Arboleda, faults: Path, plant: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out.json"
    ended = arboleda("--seed", 3, "--seeds", 2, "--faults", faults, "--json", out)
    assert ended.status == 1
    for line in (
        "seed 3 breaks unbooted after 33.250 s of plant small",
        "must hold  Nothing reboots, ever.",
        "was seen   ra_1 rebooted",
        "1 of 7 faults is enough:",
        "33.250  ra_1: Reboot its board",
        f"arboleda simulate --seed 3 --cycles 1 --faults {faults} --plant {plant} --trace",
        f"arboleda simulate --seed 3 --faults {out} --plant {plant} --trace",
        "seed 4 breaks unbooted",
        "BROKEN: an invariant did not hold in 2 seeds of 2",
    ):
        assert line in ended.said
    first, second = (row["broken"] for row in json.loads(out.read_text())["seeds"])
    assert first["shrunk"] and [fault["kind"] for fault in first["faults"]] == ["reboot"]
    assert not second["shrunk"] and len(second["faults"]) == second["injected"] == 7


@pytest.mark.long
@pytest.mark.usefixtures("brittle")
def test_a_breach_is_named_before_the_other_seeds_have_ended(arboleda: Arboleda, faults: Path) -> None:
    said = arboleda("--seed", 3, "--seeds", 2, "--faults", faults).said.splitlines()
    lines = [line for line in said if not line.startswith("simulating: ")]
    assert lines[:2] == ["seed 3 breaks unbooted", "seed 4 breaks unbooted"]


@pytest.mark.long
@pytest.mark.usefixtures("brittle")
def test_a_breach_can_be_replayed_from_the_file(arboleda: Arboleda, faults: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.json"
    arboleda("--seed", 3, "--seeds", 1, "--faults", faults, "--json", out)
    ended = arboleda("--faults", out, "--trace")
    assert ended.status == 1
    lines = ended.said.splitlines()
    (fault,) = (line for line in lines if "FAULT" in line)
    assert fault.startswith("    33.250  FAULT      reboot ra_1")
    assert lines[-1] == "BROKEN: an invariant did not hold in 1 seed of 1"


@pytest.mark.long
@pytest.mark.usefixtures("brittle")
def test_a_breach_on_two_hosts_is_replayed_on_two(arboleda: Arboleda, tmp_path: Path) -> None:
    faults, out = tmp_path / "killed.yaml", tmp_path / "out.json"
    told = "[{kind: leader_killed, at: 5}, {kind: reboot, at: 20, target: ra_1}]"
    faults.write_text(f"faults: {told}\n")
    ended = arboleda("--standby", "--seed", 3, "--faults", faults, "--json", out)
    assert " --standby --trace" in ended.said
    again = arboleda("--faults", out, "--trace")
    assert again.status == 1 and "reboot ra_1" in again.said and json.loads(out.read_text())["standby"]


def test_what_befalls_two_hosts_is_refused_for_one(arboleda: Arboleda, tmp_path: Path) -> None:
    faults = tmp_path / "killed.yaml"
    faults.write_text("faults: [{kind: leader_killed, at: 5}]\n")
    ended = arboleda("--faults", faults)
    assert ended.status == 2 and "simulate it with --standby" in ended.complained
    both = arboleda("--standby", "--faults", "crashes")
    assert both.status == 2 and "leave out --faults crashes" in " ".join(both.complained.split())


@pytest.mark.long
@pytest.mark.usefixtures("brittle")
def test_until_failure_goes_on_until_something_breaks(arboleda: Arboleda) -> None:
    ended = arboleda("--until-failure", "--faults", "many")
    assert ended.status == 1 and ended.said.endswith(" 1 seed of 1\n") is ("seed 1 breaks" in ended.said)
    assert ended.said.count(" breaks unbooted ") == 1


def test_an_exception_in_a_step_is_a_breach(arboleda: Arboleda, monkeypatch: pytest.MonkeyPatch) -> None:
    @invariant(Trigger.ALWAYS)
    def bad(look: Look) -> Iterable[str]:
        """It has a mistake."""
        raise KeyError("nobody")

    monkeypatch.setattr(judged, "INVARIANTS", (bad,))
    ended = arboleda("--seeds", 1)
    assert ended.status == 1
    assert "breaks no_exception" in ended.said and "was seen   KeyError: 'nobody'" in ended.said
    assert "none of 0 is needed" in ended.said


def test_a_trace_is_the_same_every_time(arboleda: Arboleda) -> None:
    first, second = (arboleda("--seed", 5, "--trace", "--faults", "many") for _ in range(2))
    assert first == second and first.status == 0
    lines = first.said.splitlines()
    assert any("asked      'sis_a" in line for line in lines) and any("FAULT" in line for line in lines)
    assert lines[-2].startswith("digest ") and lines[-1].startswith("HELD")


def test_a_record_holds_the_lines_of_the_trace(arboleda: Arboleda, tmp_path: Path) -> None:
    file = tmp_path / "record.jsonl"
    said = arboleda("--seed", 5, "--trace", "--record", file).said.splitlines()[:-2]
    told = [json.loads(line) for line in file.read_text().splitlines()]
    assert [f"{each['time']:10.3f}" for each in told] == [line[:10] for line in said]
    assert {each["who"] for each in told} == {"asked", "plant", "bridge", "ra_1", "rm_sis_a"}
    assert all(line.endswith(each["what"]) for each, line in zip(told, map(str.rstrip, said), strict=True))


def test_a_disk_that_is_full_is_one_sentence(arboleda: Arboleda) -> None:
    if not os.path.exists("/dev/full"):
        pytest.fail("this test needs /dev/full")
    ended = arboleda("--record", "/dev/full")
    assert ended.status == 1
    assert ended.complained == "arboleda: the lines cannot be written to the file: No space left on device\n"


@pytest.mark.long
def test_ctrl_c_says_what_was_done_so_far(
    arboleda: Arboleda, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = setting.Setting.run

    def interrupted(self: Any, seed: int, **options: Any) -> Any:
        if seed == 3:
            raise KeyboardInterrupt
        return run(self, seed, **options)

    monkeypatch.setattr(setting.Setting, "run", interrupted)
    ended = arboleda("--json", tmp_path / "out.json")
    assert ended.status == 130
    assert "interrupted; so far:" in ended.said and "2 seeds (1 to 2)" in ended.said
    said = json.loads((tmp_path / "out.json").read_text())
    assert said["complete"] is False and [row["seed"] for row in said["seeds"]] == [1, 2]
    assert arboleda("--seed", 3, "--trace") == Ended(130, "interrupted\n", "")


@pytest.mark.long
@pytest.mark.usefixtures("brittle")
def test_ctrl_c_while_shrinking_tells_the_fewest_faults_so_far(
    arboleda: Arboleda, faults: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    attempt, runs = setting.Setting.attempt, count(1)

    def interrupted(self: Any, *what: Any, keep: bool = False, **options: Any) -> Any:
        if not keep and next(runs) == 3:
            raise KeyboardInterrupt
        return attempt(self, *what, keep=keep, **options)

    monkeypatch.setattr(setting.Setting, "attempt", interrupted)
    out = tmp_path / "out.json"
    ended = arboleda("--seed", 3, "--seeds", 1, "--faults", faults, "--json", out)
    assert ended.status == 1
    for line in (
        "interrupted; the fewest faults so far:",
        "seed 3 breaks unbooted after 33.250 s of plant small",
        "3 of 7 faults are enough:",
        "things that happened before it",
        f"--seed 3 --faults {out}",
        "BROKEN: an invariant did not hold in 1 seed of 1",
    ):
        assert line in ended.said
    said = json.loads(out.read_text())
    assert said["complete"] is False and len(said["seeds"][0]["broken"]["faults"]) == 3


def campaign(plant: Path, faults: object, second: float) -> str:
    """Output of a campaign of one seed, with a clock that moves on by `second` whenever it is read."""
    console = screen.console()
    console.file = io.StringIO()
    request = Request(plant=plant, seed=3, seeds=1, cycles=1, faults=str(faults))
    clock = count(0.0, second)
    SeedCampaign(request, console, None, clock=lambda: float(next(clock))).run(Processes(1))
    return console.file.getvalue()


@pytest.mark.long
@pytest.mark.usefixtures("arboleda")
def test_progress_is_told_within_a_seed(plant: Path) -> None:
    lines = [line for line in campaign(plant, "none", 0.5).splitlines() if line.startswith("simulating: ")]
    assert lines[0].startswith("simulating: 0 of 1 seed, 0 min, 0 cycles, 0/s, 0 faults")
    assert any(", 1 cycle, " in line for line in lines)
    quiet = campaign(plant, "none", 1e-6)
    assert "simulating: " not in quiet


@pytest.mark.long
@pytest.mark.usefixtures("brittle")
def test_what_shrinking_has_so_far_is_told(plant: Path, faults: Path) -> None:
    said = campaign(plant, faults, 3.0)
    lines = [line for line in said.splitlines() if line.startswith("shrinking seed 3: ")]
    end = "still breaks: Nothing reboots, ever."
    assert lines[0] == f"shrinking seed 3: 7 faults to 7 so far, 0 runs, {end}"
    assert any(" to 3 so far, 2 runs, " in line for line in lines), "also while a run is under way"


def test_plain_lines_come_every_five_seconds() -> None:
    console, at = screen.console(), 0.0
    console.file = io.StringIO()
    with screen.progress(console, "simulating", None, first_s=1.0, clock=lambda: at) as show:
        for at in (0.5, 1.0, 3.0, 5.9, 6.0, 10.0, 11.5):
            show(f"{at} s", 0)
    assert console.file.getvalue().splitlines() == [f"simulating: {at} s" for at in (1.0, 6.0, 11.5)]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--plant", "nowhere.yaml"), "nowhere.yaml: there is no such file"),
        (("--faults", "hgih"), "'hgih' is neither a file nor a level (none, few, normal, many, crashes)"),
        (("--faults", "."), ".: is a directory"),
        (("--json", "nowhere/out.json"), "nowhere/out.json: cannot be written: No such file or directory"),
        (("--record", "."), ".: cannot be written: Is a directory"),
        (("--trace", "--seeds", "2"), "--trace and --record are for one seed"),
        (("--record", "r", "--until-failure"), "--trace and --record are for one seed"),
        (("--seeds", "0"), "Invalid value for '--seeds'"),
        (("--cycles", "0"), "Invalid value for '--cycles'"),
        (("--jobs", "0"), "Invalid value for '--jobs'"),
        (("--seed", "-1"), "Invalid value for '--seed'"),
        (("--drawn-plants",), "type tools/drawn-plants instead"),
        (("--keep-plant", "kept"), "type tools/drawn-plants instead"),
    ],
    ids=" ".join,
)
def test_bad_input_ends_with_2_and_a_sentence(
    arboleda: Arboleda, words: tuple[str, ...], sentence: str
) -> None:
    ended = arboleda(*words)
    assert (ended.status, ended.said) == (2, "")
    assert sentence in ended.complained and "Traceback" not in ended.complained


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ("{", "cannot be read: "),
        ('{"seeds": 3}', "is not what `arboleda simulate --json` writes"),
        (
            '{"seeds": [{"broken": {"faults": []}, "seed": 1}]}',
            "is not what `arboleda simulate --json` writes",
        ),
        ('{"seeds": [{"broken": null}]}', "has no broken seed"),
        ('{"faults": [{"kind": "flood", "at": 1}]}', "'flood' is not a kind of fault"),
        ('{"faults": [{"kind": "reboot", "at": 1, "target": "ra_9"}]}', "cannot befall 'ra_9'"),
        ('{"rates": {"reboot": -1}}', "reboot is -1"),
        (
            '{"seeds": [{"seed": 1, "plant": "big", "broken": {"minutes": 1, "faults": []}}]}',
            "is of the plant big; name its file with --plant",
        ),
    ],
)
def test_a_bad_file_of_faults_is_refused_with_a_sentence(
    arboleda: Arboleda, tmp_path: Path, content: str, sentence: str
) -> None:
    file = tmp_path / "bad.json"
    file.write_text(content)
    ended = arboleda("--faults", file)
    assert (ended.status, ended.said) == (2, "")
    assert ended.complained.startswith(f"arboleda: {file}: ") and sentence in ended.complained


def test_what_is_wrong_in_a_file_is_said_with_its_line(arboleda: Arboleda, tmp_path: Path) -> None:
    file = tmp_path / "case.yaml"
    file.write_text("people:\n  - {at: 1, task: sis_a palletizing}\n  - at: 2\n    do: stop nobody\n")
    ended = arboleda("--faults", file)
    assert (ended.status, ended.said) == (2, "")
    assert ended.complained.startswith(f"arboleda: {file}: line 4: 'nobody' is nothing of this plant")


def test_faults_may_be_written_in_yaml(arboleda: Arboleda, tmp_path: Path) -> None:
    file = tmp_path / "faults.yaml"
    file.write_text("faults:\n  - {kind: reboot, at: 12.5, target: ra_1}\n")
    assert "FAULT      reboot ra_1" in arboleda("--faults", file, "--trace").said


@pytest.mark.sampled(2)
@pytest.mark.parametrize("link", ["ros", "none"])
def test_robots_without_a_board_get_virtual_ones(arboleda: Arboleda, plant: Path, link: str) -> None:
    plant.write_text(PLANT.replace("link: mqtt", f"link: {link}"))
    ended = arboleda("--seeds", 1)
    assert ended.status == 0
    assert ended.said.startswith(
        f"declared link: {link}, simulated as if each had a virtual board on MQTT: ra1, rm_sis_a\n"
    )


def test_without_a_plant_file_odd_seeds_are_the_shipped_plant_and_even_ones_the_shared_one() -> None:
    where = Request().setting
    assert [where.plant(seed).name for seed in (1, 2, 3, 4711)] == [
        "arboleda",
        "shared",
        "arboleda",
        "arboleda",
    ]


def test_the_shared_plant_is_what_the_shipped_one_is_not() -> None:
    plant = shared()
    cells, arms = plant.cells, [StorageLayout(cell).arm for cell in plant.cells]
    assert loader.warnings(plant) == ()
    assert plant.zones and any(StorageLayout(cell).space.crossings for cell in cells)
    assert any(len([pose for pose in StorageLayout(cell).space.poses if pose.zones]) > 1 for cell in cells)
    assert any(pose.above for cell in cells for pose in StorageLayout(cell).space.poses)
    assert any(cell.retry.times for cell in cells) and any(cell.piece_check for cell in cells)
    assert not all(cell.drive_to_start for cell in cells) and not all(arm.queue_triggers for arm in arms)
    assert Evidence.JOINTS in {robot.evidence for robot in plant.robots.values()}
    assert any(arm.piece_on_change for arm in arms) and any(arm.home_at_start for arm in arms)


@pytest.mark.parametrize(("language", "width", "columns"), [("en", 140, 2), ("en", 80, 1), ("es", 80, 1)])
def test_names_of_faults_are_whole_in_as_many_columns_as_there_is_room_for(
    plant: Path, capsys: pytest.CaptureFixture[str], language: str, width: int, columns: int
) -> None:
    console = screen.console(language=language)
    console.width = width
    tally = Tally(setting=Request(plant=plant, seeds=1).setting)
    tally.faults.update([*TITLES][:10])
    tally.outcomes["done"] = 1
    console.print(report.tables(tally, console))
    said = capsys.readouterr().out
    assert all(screen.say_of(console)(each) in said for each in [*TITLES.values()][:10])
    assert said.count({"en": " fault ", "es": " fallo "}[language]) == columns
