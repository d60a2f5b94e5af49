"""Pairs of faults in one run: which there are, in which order, and what is said of the share that was run."""

from __future__ import annotations

import json
from itertools import islice
from pathlib import Path

import pytest

from arboleda.cli.main import main
from arboleda_proofs.campaigns.proof.outcome import End, Outcome
from arboleda_proofs.campaigns.proof.pairs import PairTally
from arboleda_proofs.campaigns.proof.proof import Proved
from arboleda_proofs.campaigns.proof.proof_report import pairs_line
from arboleda_proofs.simulator.faults import KINDS

from .lamp import pairs_of, portions
from .lamp import plant as plant


def test_each_pair_is_there_once_with_the_later_fault_second(plant: Path) -> None:
    pairs = pairs_of(plant, "forgets", "reboot", "driver_alarm")
    found = [each for number in pairs.numbers() for each in pairs.pairs(number)]
    singles = len(pairs.proof.singles(0))
    assert len(found) == len(set(found)) == pairs.total == singles * (singles - 1) // 2
    assert all(one.at <= other.at for one, other in found)


def test_the_most_likely_pairs_come_first(plant: Path) -> None:
    pairs = pairs_of(plant, "reboot", "driver_alarm", "operator_stop")
    weights = [
        KINDS[one.kind].weight * KINDS[other.kind].weight
        for number in pairs.numbers()
        for one, other in pairs.pairs(number)
    ]
    assert weights == sorted(weights, reverse=True) and len(set(weights)) > 3


def test_a_portion_is_known_by_its_name_until_its_faults_are_others(plant: Path) -> None:
    pairs, others = pairs_of(plant, "forgets", "reboot"), pairs_of(plant, "forgets", "mute")
    names = [pairs.name(number) for number in islice(portions(pairs), 3)]
    assert [pairs.name(pairs.number(name)) for name in names] == names
    with pytest.raises(ValueError, match="another portion"):
        others.number(names[0])


def test_what_pairs_break_counts_where_no_single_fault_breaks_it(plant: Path) -> None:
    pairs = pairs_of(plant, "forgets", "reboot")
    number = next(portions(pairs))
    broken = Outcome(end=End.DONE, broken=("rule", "sentence"))
    proved = Proved(number=number, outcomes=(broken,), rows=(0,) * pairs.count(number), digest="")
    tally = PairTally(pairs=pairs, proved={number: proved})
    ((case, times),) = tally.breaches(frozenset())
    assert case.then is not None and times == pairs.count(number)
    assert tally.breaches(frozenset({("rule", "bench", "shine")})) == []


def test_a_share_of_all_pairs_is_never_called_more_than_a_sample(plant: Path) -> None:
    tally = PairTally(pairs=pairs_of(plant, "forgets"))
    assert "0 of 6 (a share of 0), the most likely first: a sample" in str(pairs_line(tally, 0))


def test_the_command_runs_pairs_after_all_single_faults_and_goes_on_the_next_time(
    plant: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out, state = plant.parent / "out.json", plant.parent / "state"
    words = ["--pairs", "--fault", "forgets", "--jobs", "1", "--state", str(state), "--json", str(out)]
    page, drawn = plant.parent / "out.html", plant.parent / "out.svg"
    monkeypatch.setattr(
        "sys.argv", ["arboleda", "prove", str(plant), "--html", str(page), "--badge", str(drawn), *words]
    )
    for said in ("10 runs in", "10 runs, 10 of them kept from before"):
        with pytest.raises(SystemExit) as ended:
            main()
        assert ended.value.code == 0
        shown = capsys.readouterr().out
        assert said in shown and "pairs: all 6, the most likely first; no breaches beyond" in shown
    assert "held: each class, 4" in drawn.read_text()
    assert "se probaron 6 de 6 pares" in page.read_text()
    assert json.loads(out.read_text())["pairs"] == {"done": 6, "of": 6}


def test_all_pairs_are_not_asked_for(
    plant: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["arboleda", "prove", str(plant), "--pairs", "--budget", "all"])
    with pytest.raises(SystemExit) as ended:
        main()
    assert ended.value.code == 2 and "give a --budget that is a time" in capsys.readouterr().err
