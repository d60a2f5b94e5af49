"""The pytest plugin in a project of somebody else, and how its failures read there."""

from __future__ import annotations

import re
from importlib.metadata import entry_points
from pathlib import Path

import pytest

PLANT = """\
name: my_plant
paths:
  0B: [0, 3, 4, 7]
stations:
  0: {deg: [20, 10], mm: 50}
cells:
  cell_1:
    arm: {name: my_arm, model: scara, mqtt: arm_1, twin: r1, link: mqtt, evidence: ids}
    mobile: {name: my_mobile, link: mqtt, evidence: ids}
    home: {deg: [0, 0], mm: 0}
    pickup: {deg: [45, 10], mm: 80}
"""
BY_NAME = ("-p", "arboleda_proofs.testing.plugin")


@pytest.fixture
def project(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> pytest.Pytester:
    """A directory with `my.yaml`; no plugin loads by itself there, and this one is loaded by its name."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")
    pytester.path.joinpath("my.yaml").write_text(PLANT, "utf-8")
    return pytester


def run(project: pytest.Pytester, test: str) -> pytest.RunResult:
    """Result of pytest for one test file."""
    project.makepyfile(test)
    return project.runpytest(*BY_NAME)


def test_a_plant_is_tested_without_a_conftest(project: pytest.Pytester) -> None:
    result = run(
        project,
        """
        def test_my_plant_survives_a_reboot(sim):
            sim.plant("my.yaml")
            task = sim.submit("cell_1 0B 0")
            sim.fault("reboot", "my_arm", at=4.0)
            sim.run(until=lambda: task.ended)
            assert task.state == "failed" and task.reason == "rebooted"
            sim.rest()
            assert sim.cell("cell_1").state == "idle"

        def test_each_test_has_a_plant_of_its_own(sim):
            assert sim.now == 0.0
            assert sim.snapshot()["plant"] == "arboleda"
        """,
    )
    result.assert_outcomes(passed=2)
    result.stdout.no_fnmatch_line("*simulation call*")


def test_a_breach_shows_the_line_of_the_test_the_rule_and_the_timeline(project: pytest.Pytester) -> None:
    result = run(
        project,
        """
        from arboleda_proofs.simulator.invariants.invariant import Trigger, invariant

        @invariant(Trigger.EXECUTED)
        def arms_rest(look):
            "No arm does anything."
            yield from (f"{board} moves" for board, _ in look.moment.executed if board == "arm_1")

        def test_it(sim, monkeypatch):
            monkeypatch.setattr("arboleda_proofs.simulator.judged.INVARIANTS", (arms_rest,))
            sim.__init__(sim._folder)
            sim.plant("my.yaml")
            sim.submit("cell_1 0B 0")
            sim.run(10)
        """,
    )
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        [
            ">*sim.run(10)",
            "E *AssertionError: arms_rest is broken at 3.200 s: arm_1 moves",
            "E *must hold: No arm does anything.",
            "E *the last 10 things that happened, with the time in s:",
            "E *0.000  asked      'cell_1 0B 0'",
            "E *3.200  arm_1      carries out JointsGoal *",
        ]
    )
    result.stdout.no_fnmatch_line("*simulation call*")
    result.stdout.no_fnmatch_line("*testing/sim.py*")


def test_a_failure_of_the_test_itself_shows_the_timeline(project: pytest.Pytester) -> None:
    result = run(
        project,
        """
        import pytest

        @pytest.fixture
        def mine(sim):
            sim.plant("my.yaml")
            return sim

        def test_it(mine):
            mine.submit("cell_1 0B 0")
            mine.run(1.0)
            assert mine.robot("my_mobile").node == 7
        """,
    )
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        ["E *assert 0 == 7", "*Captured simulation call*", "the last 7 things that happened, *"]
    )


def test_a_wrong_word_is_one_sentence_at_the_line_of_the_test(project: pytest.Pytester) -> None:
    result = run(
        project,
        """
        def test_kind(sim):
            sim.fault("rebot", "ra1")

        def test_target(sim):
            sim.plant("my.yaml")
            sim.fault("reboot", "ra1")

        def test_file(sim):
            sim.plant("mine.yaml")
        """,
    )
    result.assert_outcomes(failed=3)
    result.stdout.fnmatch_lines(
        [
            '>*sim.fault("rebot", "ra1")',
            "E *Misuse: 'rebot' is not a kind of fault; there are reboot, *; did you mean 'reboot'?",
            '>*sim.fault("reboot", "ra1")',
            "E *Misuse: 'ra1' is not what reboot can befall in this plant; there are arm_1, my_mobile*",
            '>*sim.plant("mine.yaml")',
            "E *Misuse: mine.yaml: there is no such file",
        ]
    )
    for file in ("sim", "asked", "words"):
        result.stdout.no_fnmatch_line(f"*testing/{file}.py*")


def test_a_wrong_plant_file_is_told_with_every_mistake(project: pytest.Pytester) -> None:
    wrong = PLANT.replace("evidence: ids}", "evidence: id}", 1).replace("[45, 10]", "[45, 150]")
    project.path.joinpath("wrong.yaml").write_text(wrong, "utf-8")
    result = run(project, 'def test_it(sim): sim.plant("wrong.yaml")')
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        [
            'E *Misuse: *wrong.yaml:8:*evidence: must be ids, joints or state, is "id"*',
            "E *wrong.yaml:11:*150 deg is outside the limits of q2*",
        ]
    )


def test_a_project_may_have_a_fixture_of_that_name(project: pytest.Pytester) -> None:
    project.makeconftest("import pytest\n@pytest.fixture\ndef sim(): return 5")
    result = run(project, "def test_it(sim): assert sim == 5\ndef test_not(sim): assert sim == 6")
    result.assert_outcomes(passed=1, failed=1)


def test_the_installation_brings_the_plugin() -> None:
    setup = Path(__file__).parents[5].joinpath("packages/arboleda_proofs/setup.py").read_text("utf-8")
    named = re.search(r'"pytest11": \["(\w+) = (.*)"\]', setup)
    assert named is not None
    found = {(each.name, each.value) for each in entry_points(group="pytest11")}
    assert named.groups() in found, "the installation is older than setup.py: make install"
