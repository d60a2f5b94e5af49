"""A tree of a file is halted as soon as its task fails, whatever the cause."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import pytest
from tests.lengths import sample

from arboleda_proofs.testing.sim import Sim

PLANT = """
name: halted
uses: [t.xml, own.py]
kinds:
  mill:
    facts: {door: [open, closed], clamped: bool}
    verbs:
      close: {effect: motion, sets: {door: closed}, takes_s: 15}
      clamp: {effect: switch, with: {on: bool}, sets: {clamped: $on}, holds: part}
      run: {effect: process, takes_s: 60, at_most_s: 90}
cells:
  c: {devices: {mill: {kind: mill}, two: {kind: mill}}}
"""
OWN = """
from arboleda.recipes import node

@node("Within")
def within(cell, child):
    return cell.timeout(cell.repeat(child, 2), 300)
"""
RUNS, FAILS = "<two_close/>", '<Sequence><mill_clamp on="true"/>{cause}</Sequence>'
CAUSES = {
    "final": "<mill_run/>",  # its board reboots and drops a part
    "ordinary": "<AlwaysFailure/>",
    "script": '<ScriptCondition code="1 / 0 == 1"/>',
}
AT_ONCE = {
    "parallel": '<Parallel success_count="2" failure_count="1">{one}{other}</Parallel>',
    "parallel all": '<ParallelAll max_failures="1">{one}{other}</ParallelAll>',
    "non-blocking": "<NonblockingSequence>{one}{other}</NonblockingSequence>",
    "in Python": "<ParallelAll><Within>{one}</Within><Within>{other}</Within></ParallelAll>",
}
AROUND = {
    "nothing": "{tree}",
    "Sequence": "<Sequence>{tree}</Sequence>",
    "Fallback": "<Fallback>{tree}</Fallback>",
    "ReactiveSequence": "<ReactiveSequence><AlwaysSuccess/>{tree}</ReactiveSequence>",
    "ReactiveFallback": "<ReactiveFallback><AlwaysFailure/>{tree}</ReactiveFallback>",
    "SequenceWithMemory": "<SequenceWithMemory>{tree}</SequenceWithMemory>",
    "TryCatch": "<TryCatch>{tree}<AlwaysSuccess/></TryCatch>",
    "IfThenElse": "<IfThenElse><AlwaysSuccess/>{tree}<AlwaysSuccess/></IfThenElse>",
    "WhileDoElse": "<WhileDoElse><AlwaysSuccess/>{tree}<AlwaysSuccess/></WhileDoElse>",
    "Switch2": '<Switch2 variable="1" case_1="1" case_2="2">{tree}<AlwaysSuccess/><AlwaysSuccess/></Switch2>',
    "PipelineSequence": "<PipelineSequence>{tree}<AlwaysSuccess/></PipelineSequence>",
    "RoundRobin": "<RoundRobin>{tree}</RoundRobin>",
    "RecoveryNode": '<RecoveryNode number_of_retries="0">{tree}<AlwaysSuccess/></RecoveryNode>',
    "Inverter": "<Inverter>{tree}</Inverter>",
    "ForceFailure": "<ForceFailure>{tree}</ForceFailure>",
    "Repeat": '<Repeat num_cycles="1">{tree}</Repeat>',
    "RetryUntilSuccessful": '<RetryUntilSuccessful num_attempts="1">{tree}</RetryUntilSuccessful>',
    "KeepRunningUntilFailure": "<KeepRunningUntilFailure>{tree}</KeepRunningUntilFailure>",
    "Timeout": '<Timeout msec="300000">{tree}</Timeout>',
    "RunOnce": "<RunOnce>{tree}</RunOnce>",
    "SingleTrigger": "<SingleTrigger>{tree}</SingleTrigger>",
    "Precondition": '<Precondition if="true" else="FAILURE">{tree}</Precondition>',
    "in Python": "<Within>{tree}</Within>",
}


CASES = [
    *(("nothing", at_once, cause) for at_once in AT_ONCE for cause in CAUSES),
    *((around, "parallel all", "final") for around in AROUND),
]


@pytest.mark.sampled(10)
@pytest.mark.parametrize(("around", "at_once", "cause"), sample(CASES, every=2))
def test_what_runs_is_halted_when_its_task_fails(
    tmp_path: Path, around: str, at_once: str, cause: str
) -> None:
    """The simulator judges each step: `halted_moves_sent_halt`."""
    fails = FAILS.format(cause=CAUSES[cause])
    tree = AROUND[around].format(tree=AT_ONCE[at_once].format(one=fails, other=RUNS))
    file = f'<root BTCPP_format="4"><BehaviorTree ID="T">{tree}</BehaviorTree></root>'
    (tmp_path / "t.xml").write_text(file)
    (tmp_path / "own.py").write_text(OWN)
    (tmp_path / "plant.yaml").write_text(PLANT)
    sim = Sim(tmp_path)
    sim.plant("plant.yaml")
    sim.run(3.0)
    task = sim.submit("c t #one")
    sim.run(3.0)
    sim.fault("reboot", "mill", word="will")
    sim.run(20.0)
    assert (task.state, task.reason) == ("failed", "part_lost") or cause != "final"


IN_PYTHON = """
from py_trees.behaviour import Behaviour
from arboleda.recipes import parallel, recipe, work


class Breaks(Behaviour):
    def update(self):
        raise ValueError("it breaks")


@recipe("t")
def t(cell):
    mill, two = cell.devices("mill", "two")
    cause = {{"final": mill.run(), "ordinary": cell.fail("no"), "raises": Breaks("breaks")}}[{cause!r}]
    return work(mill.clamp(on=True), {frame})
"""
AT_ONCE_IN_PYTHON = "parallel(two.close(), work(cell.wait(1), cause))"
FRAMES = {
    "work": "work({at_once})",
    "parallel": "parallel({at_once}, cell.wait(90))",
    "fallback": "cell.fallback({at_once}, cell.fail('the other way, too'))",
    "retry": "cell.retry({at_once}, causes=['deadline'])",
    "repeat": "cell.repeat({at_once}, 2)",
    "timeout": "cell.timeout({at_once}, 300)",
    "recover": "cell.recover({at_once}, cell.fail('the rescue, too'))",
    "invert": "cell.invert({at_once})",
}

ANSWERED = {"fallback": ("failed", "rejected"), "invert": ("done", None)}  # what has an answer to a failure


@pytest.mark.sampled(6)
@pytest.mark.parametrize(
    ("frame", "cause"), sample(product(FRAMES, ["final", "ordinary", "raises"]), every=2)
)
def test_what_runs_is_halted_in_python_too(tmp_path: Path, frame: str, cause: str) -> None:
    """The simulator judges each step: `halted_moves_sent_halt`."""
    written = IN_PYTHON.format(cause=cause, frame=FRAMES[frame].format(at_once=AT_ONCE_IN_PYTHON))
    (tmp_path / "r.py").write_text(written)
    (tmp_path / "plant.yaml").write_text(PLANT.replace("[t.xml, own.py]", "[r.py]"))
    sim = Sim(tmp_path)
    sim.plant("plant.yaml")
    sim.without("no_internal_failure")  # a step that raises is one
    sim.without("done_tasks_leave_nothing_behind")  # the recipe leaves the mill clamped
    sim.run(3.0)
    task = sim.submit("c t #one")
    sim.run(4.0)
    sim.fault("reboot", "mill", word="will")
    sim.run(20.0)
    expected = {"final": "part_lost", "ordinary": "rejected", "raises": "internal"}[cause]
    if frame in ANSWERED and cause != "raises":
        assert (task.state, task.reason) == ANSWERED[frame]
    else:
        assert (task.state, task.reason) == ("failed", expected)
