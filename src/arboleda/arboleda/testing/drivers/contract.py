"""The cases of the contract: what every driver does for its device."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import pytest

from arboleda.model.messages import MotionState, Reason, TaskState, Verb

from ..patience import PATIENCE_S
from .bench import ASK, HALT, LATCH, OTHER, WORK, Bench
from .shop import Row, Shop, hung_disk

Case = TypeVar("Case", bound=Callable[..., None])
BOOTED = {"told": {Reason.REBOOTED}, "line": {Reason.REBOOTED, Reason.LINK_LOST}, "never": {*Reason}}


def only(fits: Callable[[Bench], object], why: str) -> Callable[[Case], Case]:
    """A case for these benches; the others skip it, and say why."""

    def mark(case: Case) -> Case:
        vars(case).setdefault("only", []).append((fits, why))
        return case

    return mark


def misfit(case: Callable[..., None], bench: Bench) -> str:
    """The reason why a case is not for a bench; "" where it is."""
    return next((why for fits, why in getattr(case, "only", ()) if not fits(bench)), "")


def is_halted(bench: Bench) -> bool:
    """True where its device is told to halt its work."""
    return bench.halts_work and HALT in bench.stops


class DriverContract:
    """The cases. A class of tests that is based on it and has a fixture `bench` runs them for its driver.

    A case that the bench does not fit is skipped with the reason that the bench gives.
    """

    @pytest.fixture
    def shop(self, request: pytest.FixtureRequest, bench: Bench, tmp_path: Path) -> Iterator[Shop]:
        """A plant that runs, and whose device is heard."""
        if why := misfit(request.function, bench):
            pytest.skip(why)
        app, device = bench.open(tmp_path / "plant", tmp_path / "state")
        shop = Shop(bench, app)
        app.start()
        try:
            shop.device = device(app)
            shop.until(is_online)
            yield shop
            shop.device.rests()  # the plant waits for it to stand still
        finally:
            app.stop()
            shop.device.close()

    def test_accept_and_done(self, shop: Shop) -> None:
        """Work that the device takes and ends is done: the way of every task that meets no trouble."""
        shop.submit(WORK)
        ref = shop.told(WORK)
        shop.device.accepts(ref)
        shop.device.finishes(ref)
        assert shop.outcome().state is TaskState.DONE

    @only(lambda bench: bench.proves, "no fact shows where its work has led: proves=False")
    def test_done_is_not_believed_while_the_facts_say_otherwise(self, shop: Shop) -> None:
        """A device that says done and stands elsewhere has not reached its goal: the next step would set out
        from where nobody is.
        """
        shop.submit(WORK)
        ref = shop.told(WORK)
        shop.device.accepts(ref)
        shop.device.finishes(ref, there=False)
        end = shop.outcome()
        assert (end.state, end.reason) == (TaskState.FAILED, Reason.NOT_REACHED)

    def test_reject(self, shop: Shop) -> None:
        """Work that the device refuses has failed, with the device's own word: a person looks that up in its
        manual.
        """
        shop.submit(WORK)
        words = shop.device.rejects(shop.told(WORK))
        end = shop.outcome()
        assert (end.state, end.reason) == (TaskState.FAILED, Reason.REJECTED)
        assert words in str(end.sentence)

    def test_failed(self, shop: Shop) -> None:
        """Work that the device gives up has failed by a fault of the device, with its own word: a person
        looks there, and not at the plant.
        """
        shop.submit(WORK)
        ref = shop.told(WORK)
        shop.device.accepts(ref)
        words = shop.device.gives_up(ref)
        end = shop.outcome()
        assert (end.state, end.reason) == (TaskState.FAILED, Reason.DEVICE_FAULT)
        assert words in str(end.sentence)

    def test_cancel_before_accept(self, shop: Shop) -> None:
        """Work that is cancelled before the device took it is halted too, as the order has left, and is never
        done.
        """
        shop.submit(WORK)
        ref = shop.told(WORK)
        shop.cancel()
        if is_halted(shop.bench):
            shop.told(HALT)
        shop.device.accepts(ref)
        shop.device.rests()
        assert shop.outcome().state is TaskState.CANCELLED

    @only(lambda bench: bench.asks, "its device cannot be asked: asks=False")
    def test_late_answer(self, shop: Shop) -> None:
        """An answer to an earlier question is none to this one: a bad part would pass for a good one."""
        shop.submit(ASK, "first")
        first = shop.told(ASK)
        given = shop.until(lambda row: row["command"])["command"]["id"]
        shop.device.accepts(first)
        shop.cancel()
        assert shop.outcome("first").state is TaskState.CANCELLED
        shop.submit(ASK, "second")
        if not shop.bench.drops_questions:
            shop.until(lambda row: row["command"]["id"] != given)
            shop.device.answers(first, "bad")
        second = shop.told(ASK)
        if shop.bench.drops_questions:
            shop.device.answers(first, "bad")
        shop.device.accepts(second)
        shop.device.answers(second, "good")
        assert shop.outcome("second").state is TaskState.DONE

    def test_what_was_stopped_or_lost_under_way_is_never_done(self, shop: Shop) -> None:
        """The work after a cancelled one is lost with the connection: neither is ever done, and a device that
        comes back is told nothing twice.
        """
        shop.submit(WORK, "first")
        shop.device.accepts(shop.told(WORK))
        shop.cancel()
        halted(shop)
        assert shop.outcome("first").state is TaskState.CANCELLED
        shop.submit(OTHER, "second")
        shop.device.accepts(shop.told(OTHER))
        shop.device.vanish()
        end = shop.outcome("second")
        assert (end.state, end.reason) == (TaskState.FAILED, Reason.LINK_LOST)
        comes_back_and_is_stopped(shop)

    @only(lambda bench: bench.halts_work, "its works are questions, see test_late_answer: halts_work=False")
    def test_late_end(self, shop: Shop) -> None:
        """A late end of work that was cancelled ends no other, though it comes after the next order: that
        one would pass for done while the device works.
        """
        shop.submit(WORK, "first")
        first = shop.told(WORK)
        shop.device.accepts(first)
        shop.cancel()
        halted(shop)
        assert shop.outcome("first").state is TaskState.CANCELLED
        shop.submit(OTHER, "second")
        second = shop.told(OTHER)
        shop.device.accepts(second)
        shop.device.finishes(first)
        shop.device.gives_up(second)  # had the first one's end counted as its own, this would be too late
        assert shop.outcome("second").state is TaskState.FAILED

    def test_duplicate(self, shop: Shop) -> None:
        """The end of an order that is told again and again ends no other, and nothing is sent twice: devices
        repeat what they say, and lines may double it.
        """
        shop.submit(WORK, "first")
        first = shop.told(WORK)
        shop.device.accepts(first)
        shop.device.finishes(first)
        assert shop.outcome("first").state is TaskState.DONE
        shop.submit(OTHER, "second")
        second = shop.told(OTHER)  # the next order, so the first came once
        for _ in range(3):
            shop.device.finishes(first)
        shop.device.accepts(second)
        shop.device.gives_up(second)
        assert shop.outcome("second").state is TaskState.FAILED

    def test_silence(self, shop: Shop) -> None:
        """A device that says nothing has lost its link, though the connection stands: a controller that hangs
        keeps it open.
        """
        shop.submit(WORK)
        shop.device.accepts(shop.told(WORK))
        shop.device.hush()
        end = shop.outcome()
        assert (end.state, end.reason) == (TaskState.FAILED, Reason.LINK_LOST)
        shop.until(is_offline)

    def test_reboot(self, shop: Shop) -> None:
        """Work that was under way as the device booted has failed: what stands still now has not ended it."""
        shop.submit(WORK)
        shop.device.accepts(shop.told(WORK))
        shop.device.boots()
        end = shop.outcome()
        assert end.state is TaskState.FAILED and end.reason in BOOTED[shop.bench.boot]

    def test_reconnect(self, shop: Shop) -> None:
        """A device that comes back from the middle of its work is told nothing twice: it would work again on
        what is half done.
        """
        shop.submit(WORK)
        shop.device.accepts(shop.told(WORK))
        shop.device.vanish()
        end = shop.outcome()
        assert (end.state, end.reason) == (TaskState.FAILED, Reason.LINK_LOST)
        comes_back_and_is_stopped(shop)

    @only(lambda bench: not bench.watches, "its device watches for the plant itself: watches=True")
    @only(is_halted, "nothing halts its work: see halts_work and stops")
    def test_a_plant_that_freezes(self, shop: Shop) -> None:
        """A moving device is halted while the plant's thread does nothing, as nobody watches it then."""
        shop.submit(WORK)
        shop.device.accepts(shop.told(WORK))
        with shop.frozen():
            halted(shop)
        assert shop.outcome().reason is not None

    @only(lambda bench: not bench.watches, "its device watches for the plant itself: watches=True")
    @only(lambda bench: bench.stops, "its protocol has no word for a stop: stops=()")
    def test_a_disk_that_hangs(self, shop: Shop, monkeypatch: pytest.MonkeyPatch) -> None:
        """A stop reaches the device while the plant waits for its memory: stops wait for nothing."""
        shop.submit(WORK)
        shop.device.accepts(shop.told(WORK))
        with hung_disk(monkeypatch):
            stop = shop.app.plant.operate(Verb.STOP, "shop")
            shop.told(*shop.bench.stops)
            shop.device.latches()
        assert stop.result(PATIENCE_S).refusal is None

    @only(lambda bench: bench.takes, "the bench does not name what takes the device's words: takes=''")
    def test_a_message_that_breaks_what_takes_it(self, shop: Shop, monkeypatch: pytest.MonkeyPatch) -> None:
        """A message that the driver cannot take is the device's trouble: no thread of the driver ends by it,
        and the device is heard again with the next good one.
        """
        threads = set(threading.enumerate())
        with monkeypatch.context() as broken:
            broken.setattr(shop.bench.takes, breaks)
            shop.until(is_offline)
        shop.until(is_online)
        ended = [each.name for each in threads - set(threading.enumerate())]
        of_device = shop.bench.device_threads
        assert not [name for name in ended if of_device is None or of_device not in name]


def is_online(row: Row) -> object:
    return row["online"]


def is_offline(row: Row) -> object:
    return not row["online"]


def halted(shop: Shop) -> None:
    """The device is told so, where it can be, and stands."""
    if is_halted(shop.bench):
        shop.told(HALT)
    shop.device.rests()


def comes_back_and_is_stopped(shop: Shop) -> None:
    """It hears of stops only: those of what was left at work, and its own."""
    stops = shop.bench.stops
    shop.device.come_back()
    shop.until(is_online)
    shop.app.plant.operate(Verb.STOP, "shop").result(PATIENCE_S)
    heard = list[str]()
    while stops and (LATCH if LATCH in stops else HALT) not in heard:
        heard.append(shop.next_order()[0])
    shop.device.latches()
    if LATCH not in stops:  # its driver is latched in its place
        shop.until(lambda row: row["state"] == MotionState.STOP_LATCHED)
    while not shop.device.orders.empty():
        heard.append(shop.next_order()[0])
    assert set(heard) <= {*stops}


def breaks(*_: Any) -> None:
    raise KeyError("lastNodeId")
