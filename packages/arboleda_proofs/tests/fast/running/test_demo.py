"""The demonstration never ends by itself, and has a cell fail where somebody can learn from it."""

from __future__ import annotations

from collections import Counter

import pytest
from tests.lengths import length

from arboleda.model.messages import Verb
from arboleda.sim.devices import Alarm, Reboot
from arboleda_proofs.running.demo import ALARM_S, CALM_S, Demo, DemoEnded, Task
from arboleda_proofs.simulator.judged import judged_by
from arboleda_proofs.testing.sim import Sim

PASS_S = 1.0  # how often the demonstration sees the plant


class Show:
    """A simulated plant and its demonstration; its `faults`, and its `tasks`."""

    def __init__(self) -> None:
        self.sim, self.faults, self.tasks = Sim(), [], []
        self.sim.without(*(each.name for each in judged_by()))  # campaigns judge the shipped plant
        self.demo = Demo(self.sim.world.model)

    @property
    def held(self) -> list[str]:
        """The cells that are held."""
        return [cell["name"] for cell in self.sim.snapshot()["cells"] if cell["state"] == "held"]

    def play(self, seconds: float, *, visited: bool = False) -> None:
        for _ in range(round(seconds / PASS_S)):
            self.sim.run(PASS_S)
            snapshot = self.sim.snapshot()
            for message in self.demo.step(self.sim.now, [snapshot]):
                self._do(message)
            if visited:
                self._press(snapshot)

    def _do(self, message: Task | Reboot | Alarm) -> None:
        if isinstance(message, Task):
            self.tasks.append(self.sim.submit(message.text))
            return
        self.faults.append(message)
        if isinstance(message, Reboot):
            self.sim.fault("reboot", message.board, word="no will")
        elif message.is_on:
            self.sim.fault("driver_alarm", message.board, seconds=ALARM_S)

    def _press(self, snapshot: dict) -> None:
        """A visitor presses the first button of each card."""
        for cell in snapshot["cells"]:
            for advice in cell["advice"][:1]:
                if not advice["hand"] and advice["refusal"] is None:
                    self.sim.operate(Verb(advice["do"]), advice["scope"], by_hand=advice["by_hand"])


@pytest.fixture
def show() -> Show:
    return Show()


@pytest.fixture(scope="module")
def visited() -> Show:
    """Some minutes of a plant whose cards a visitor acts on."""
    show = Show()
    show.play(length(200, whole=600), visited=True)
    return show


@pytest.mark.long
def test_every_cell_gets_task_after_task(visited: Show) -> None:
    given = Counter(task.text.split()[0] for task in visited.tasks)
    assert set(given) == {"sis_a", "sis_b", "sis_c"}
    assert min(given.values()) > 10
    assert {task.state for task in visited.tasks} <= {"done", "failed", "running", "queued"}


@pytest.mark.long
def test_a_failing_cell_waits_for_somebody_while_the_others_go_on(show: Show) -> None:
    while not show.held:
        show.play(10)
    assert isinstance(show.faults[-1], Reboot)
    show.play(20)  # what the others were at
    before = len(show.tasks)
    show.play(60)
    assert len(show.held) == 1
    assert not [fault for fault in show.faults if fault.at > show.sim.now - 60]
    assert len(show.tasks) > before + 4


@pytest.mark.long
def test_buttons_of_the_card_lead_out_and_then_another_cell_fails(visited: Show) -> None:
    fell = [fault.board for fault in visited.faults if isinstance(fault, Reboot) or fault.is_on]
    assert len(fell) >= 4
    assert len(set(fell)) >= 4
    assert {"failed", "done"} <= {task.state for task in visited.tasks}
    assert min(fault.at for fault in visited.faults) >= CALM_S


@pytest.mark.long
def test_nothing_is_given_and_nothing_fails_after_its_end(show: Show) -> None:
    show.play(20)
    show.demo.step(show.sim.now, [DemoEnded()])
    given, fell = len(show.tasks), len(show.faults)
    show.play(120)
    assert (len(show.tasks), len(show.faults)) == (given, fell)
    assert show.demo.next_deadline is None


def test_an_alarm_is_over_in_time_though_the_demonstration_ends() -> None:
    show = Show()
    while not any(isinstance(fault, Alarm) for fault in show.faults):
        show.play(1, visited=True)
    alarm = show.faults[-1]
    show.demo.step(show.sim.now, [DemoEnded()])
    assert show.demo.next_deadline == pytest.approx(alarm.at + ALARM_S)
    over = show.demo.step(alarm.at + ALARM_S, [])
    assert over == [Alarm(at=alarm.at + ALARM_S, board=alarm.board, is_on=False)]
