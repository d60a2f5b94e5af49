"""The examples: buttons alone lead out of a stop in the middle of each verb and a reboot of any device."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest
from tests.following import works
from tests.readying import due, make_ready

from arboleda.model.commands import Command, Query, Stop
from arboleda.model.messages import Verb
from arboleda.model.plant_model import Link
from arboleda.testing import Rig

from ...plants import plant_text, read
from .example_trials import OF_STORAGE, Case, Shop
from .test_examples import CASES, PLAIN

BOOTS_S = 5.0
STORED = Case(folder=OF_STORAGE, task="sis_a 0B 7")


@dataclass(frozen=True)
class Middle:
    """Middle of the first command of a verb to a device, at `at` s."""

    at: float
    robot: str
    word: str

    def __str__(self) -> str:
        return f"{self.robot} {self.word}"


class Timed(Shop):
    """An example whose people answer as the case says, up to any moment."""

    def __init__(self, case: Case, cases: Sequence[Case]) -> None:
        self.last: list[tuple[float, tuple[str, str]]] = []
        super().__init__(case, cases)
        self.watchers.append(self._note)

    def go(self, at: float) -> None:
        """Ask for the task of the case, and let time pass until then."""
        self.submit(self.case.task)
        while self.now < at:
            self.wait(at - self.now, lambda: bool(self._questions()))
            for asked in self._questions():
                self.operate(Verb.ANSWER, asked.robot, answer=asked.answers[0])

    def middles(self) -> list[Middle]:
        """The middle of the first command of each verb, up to the next command."""
        self.do()
        ends = [at for at, _ in self.last[1:]] + [self.now]
        first = {which: (at + end) / 2 for (at, which), end in reversed([*zip(self.last, ends, strict=True)])}
        return [Middle(at, *which) for which, at in sorted(first.items(), key=lambda row: row[1])]

    def _note(self) -> None:
        for each in self.moment.sent:
            if isinstance(each, Command) and not isinstance(each, Query | Stop) and each.word:
                self.last.append((self.now, (each.robot, each.word)))


def stuck(case: Case, cases: Sequence[Case], middle: Middle, device: str | None) -> str | None:
    """What was pressed after a stop in a verb and a reboot, and what is due still; None where all is well."""
    shop = Timed(case, cases)
    shop.go(middle.at)
    shop.operate(Verb.STOP, case.cell)
    shop.wait(1.0)
    if device is not None:
        shop.crash(shop.model.robots[device].mqtt)
    shop.wait(BOOTS_S)
    acts = make_ready(shop)
    if all(works(shop, cell) for cell in shop.plant.cells):
        return None
    return f"{middle}, {device} booted: {acts}, then {due(shop)}"


def assert_led_out(case: Case, cases: Sequence[Case]) -> None:
    """A stop in any verb, and a reboot of any device or of none, are led out of by buttons alone."""
    shop = Timed(case, cases)
    devices = [None, *(each.name for each in shop.model.robots.values() if each.link is not Link.SCREEN)]
    found = [stuck(case, cases, middle, device) for middle in shop.middles() for device in devices]
    assert [each for each in found if each] == []


@pytest.mark.long
@pytest.mark.timeout(900)
@pytest.mark.parametrize("case", [*PLAIN, STORED], ids=str)
def test_a_stop_in_any_verb_and_a_reboot_are_led_out_of_by_buttons_alone(case: Case) -> None:
    assert_led_out(case, CASES)


APART = plant_text(__file__, "led_out")
SWAP = """
from arboleda.recipes import recipe, work

@recipe("swap")
def swap(cell):
    left, right = cell.devices("left", "right")
    return work(left.visit("nest", cell.wait(3.0)), left.home(), right.visit("nest"), right.home())
"""


@pytest.mark.parametrize("at", [3.0, 5.0, 8.0, 11.0])
@pytest.mark.parametrize("device", ["left", "right"])
def test_an_arm_that_only_a_person_homes_is_led_out_of_the_zone_of_another(
    tmp_path: Path, at: float, device: str
) -> None:
    rig = Rig(read(tmp_path, APART, SWAP), now=0.0)
    rig.wait(2.0)
    rig.submit("aa swap")
    rig.wait(at - 2.0)
    rig.operate(Verb.STOP, "aa")
    rig.wait(1.0)
    rig.crash(device)
    rig.wait(BOOTS_S)
    acts = make_ready(rig)
    assert works(rig, "aa"), (acts, due(rig))
