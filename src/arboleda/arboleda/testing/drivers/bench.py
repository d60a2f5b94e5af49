"""Bench of a driver in the contract: a plant with one device, which is played by hand."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path
from queue import Queue
from typing import Any, Literal, Protocol

from arboleda.plant_file.loader import load
from arboleda.runtime.build import App, Options, build

WORK, OTHER, ASK = "work", "other", "ask"
HALT, LATCH = "halt", "latch"
Ref = Any
"""Name of an order in the device's protocol."""
RECIPES = """
from arboleda.recipes import recipe, work as steps

@recipe("work")
def work_(cell):
    return cell.device("{device}").{work}

@recipe("other")
def other(cell):
    return cell.device("{device}").{other}
"""
ASK_RECIPE = """
@recipe("ask")
def ask(cell):
    seen = cell.device("{device}").{ask}
    return steps(seen, cell.choose(seen, {{"good": [], "bad": cell.fail("it is bad")}}))
"""


class Device(Protocol):
    """A device that is played by hand: it does nothing by itself.

    It says what it last said again and again, or when it is asked, until it is hushed. Where its protocol
    cannot say what a method is for, as the end of an order twice, the method does nothing.
    """

    @property
    def orders(self) -> Queue[tuple[str, Ref]]:
        """Orders that it got: `work`, `other`, `ask`, `halt` or `latch`, each with its own name for it."""

    def accepts(self, ref: Ref) -> None:
        """It takes the order, and is at work."""

    def finishes(self, ref: Ref, *, there: bool = True) -> None:
        """It says that the work is done; `there`: and that it has led where it should."""

    def rejects(self, ref: Ref) -> str:
        """It refuses the order; what of that the plant must say."""

    def gives_up(self, ref: Ref) -> str:
        """The work fails at the device; what of that the plant must say."""

    def rests(self) -> None:
        """It stands still, without a word of any order."""

    def answers(self, ref: Ref, word: str) -> None:
        """It answers a question with `good` or `bad`; only where the bench has `asks`."""

    def hush(self) -> None:
        """It says nothing more, over a connection that stays."""

    def boots(self) -> None:
        """It was off for a moment, knows of no order, and stands still."""

    def vanish(self) -> None:
        """The connection ends, as where a cable is pulled."""

    def come_back(self) -> None:
        """It can be reached again, stands still and knows of no order."""

    def latches(self) -> None:
        """It stands still, and says that it is stopped where it can say so."""

    def close(self) -> None:
        """The test is over: join all threads."""


@dataclass(frozen=True, kw_only=True)
class Bench:
    """A plant with one device, and what that can; a case that asks for more is skipped, and says so.

    - `open(folder, state)`: makes the plant, as `open_shop` does, and the function that makes its device once
      the plant has started.
    - `asks`: the device can be asked, and refuses no question because of the one before.
    - `drops_questions`: it takes a question while nobody waits for the one before; else it ends that first.
    - `halts_work`: its works are motions or processes. Else they are questions, which the plant does not
      halt: it drops them.
    - `proves`: facts show whether a work has led where it should.
    - `stops`: the words that its protocol has for stops.
    - `boot`: how a boot is noticed: `told` over a line that stays, by the `line`, which ends, or `never`.
    - `watches`: the device, or a driver of others, watches for the plant itself.
    - `takes`: the function or method that takes what the device says, by its dotted name.
    - `device_threads`: what the names of threads have which the played device ends by itself.
    """

    open: Callable[[Path, Path], tuple[App, Callable[[App], Device]]]
    asks: bool = False
    drops_questions: bool = True
    halts_work: bool = True
    proves: bool = True
    stops: Collection[str] = (HALT, LATCH)
    boot: Literal["told", "line", "never"] = "told"
    watches: bool = False
    takes: str = ""
    device_threads: str | None = None


def open_shop(
    folder: Path,
    state: Path,
    plant: str,
    *,
    device: str,
    work: str,
    other: str,
    ask: str = "",
    python: str = "",
    parts: Collection[str] = ("orchestrator",),
    link: Any = None,
) -> App:
    """The plant of a plant file with this text, for a bench.

    Its cell is `shop`, and it uses `recipes.py`, which is written beside it. `work` and `other` are what the
    device is told there as a recipe has it, `go("a")`: two works that lead elsewhere. `ask`: a question with
    the answers `good` and `bad`. `python` stands before the recipes, as for kinds.
    """
    folder.mkdir(exist_ok=True)
    (folder / "plant.yaml").write_text(plant, "utf-8")
    recipes = (RECIPES + (ASK_RECIPE if ask else "")).format(device=device, work=work, other=other, ask=ask)
    (folder / "recipes.py").write_text(python + recipes, "utf-8")
    return build(load(folder / "plant.yaml"), parts, Options(state_dir=state, link=link))
