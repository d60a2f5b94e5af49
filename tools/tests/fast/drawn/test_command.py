"""`tools/drawn-plants` with invariants that are planted where something is to break."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from arboleda.plant_file import loader
from arboleda_drawn.__main__ import main
from arboleda_drawn.plants import DrawnPlant, DrawnPlants
from arboleda_proofs.simulator import judged
from arboleda_proofs.simulator.faults import KINDS
from arboleda_proofs.simulator.invariants.invariant import Look, Trigger, invariant

REBOOT = {"kind": "reboot", "at": 3.25}
SHORT = ("--cycles", "1", "--jobs", "1")


@pytest.fixture(autouse=True)
def brittle(monkeypatch: pytest.MonkeyPatch) -> None:
    """The one invariant is broken by a reboot, which does nothing else."""

    @invariant(Trigger.ALWAYS)
    def unbooted(look: Look) -> Iterable[str]:
        """Nothing reboots, ever."""
        if hasattr(look.world, "rebooted"):
            yield f"{look.world.rebooted} rebooted"

    def begin(world: Any, fault: Any) -> None:
        world.rebooted = fault.target

    monkeypatch.setitem(KINDS, "reboot", replace(KINDS["reboot"], begin=begin))
    monkeypatch.setattr(judged, "INVARIANTS", (unbooted,))


@pytest.mark.long
def test_each_seed_draws_a_plant_and_the_file_has_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out.json"
    assert main([*SHORT, "--faults", "none", "--seeds", "2", "--json", str(out)]) == 0
    assert capsys.readouterr().out.startswith("drawn plants: whatever link a robot declares, it is simulated")
    rows = json.loads(out.read_text())["seeds"]
    names = [row["plant_file"]["name"] for row in rows]
    assert [row["plant"] for row in rows] == names == ["drawn_1", "drawn_2"]


@pytest.mark.long
def test_a_drawn_plant_is_shrunk_with_its_faults_kept_and_replayed_from_the_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    faults, out, kept = tmp_path / "faults.json", tmp_path / "out.json", tmp_path / "kept"
    seed = next(seed for seed in range(100) if _is_rich(DrawnPlants().of(seed)))
    faults.write_text(json.dumps({"faults": [{"kind": "bridge_stall", "at": 1, "seconds": 0.1}, REBOOT]}))
    words = ("--seed", str(seed), "--seeds", "1", "--faults", str(faults), "--json", str(out))
    assert main([*SHORT, *words, "--keep-plant", str(kept)]) == 1
    said = capsys.readouterr().out
    assert "1 of 2 faults is enough:" in said
    assert "as much of its file as is enough:" in said and "    name: drawn_" in said
    assert f"tools/drawn-plants --seed {seed} --cycles 1 --faults {faults} --trace" in said
    assert f"tools/drawn-plants --seed {seed} --faults {out} --trace" in said
    (row,) = json.loads(out.read_text())["seeds"]
    whole, needed = row["plant_file"], row["broken"]["plant_file"]
    assert len(whole["cells"]) > len(needed["cells"]) == 1 and "zones" not in needed
    assert len(loader.load(kept / f"{row['plant']}.yaml").cells) == 1
    assert main(["--faults", str(out), "--trace"]) == 1
    again = capsys.readouterr().out
    assert again.endswith("BROKEN: an invariant did not hold in 1 seed of 1\n")
    assert "as much of its file" in again


def _is_rich(plant: DrawnPlant) -> bool:
    """True if there is much to leave out."""
    return not plant.beside and len(plant.declared.cells) == 2 and bool(plant.declared.zones)


def test_bad_input_ends_with_2_and_a_sentence(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--faults", "hgih"]) == 2
    assert "'hgih' is neither a file nor a level" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--standby", "--revisions"), "exclude each other"),
        (("--standby", "--faults", "crashes"), "deaths of its own"),
        (("--trace", "--seeds", "5"), "for one seed"),
        (("--record", "x.mcap", "--until-failure"), "for one seed"),
    ],
)
def test_options_that_exclude_each_other_are_refused(
    words: tuple[str, ...], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(words) == 2
    assert sentence in capsys.readouterr().err


def test_a_seed_below_0_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["--seed", "-1"])
    assert ended.value.code == 2 and "argument --seed" in capsys.readouterr().err
