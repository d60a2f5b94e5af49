"""Watch over the plants of a site, each by itself: a silent one holds up no other."""

from __future__ import annotations

import asyncio
import logging
from collections import defaultdict
from collections.abc import Iterator
from typing import Any

from arboleda.dashboard.frames import ended
from arboleda.extension import ArboledaError, Phrase, Sentence
from arboleda.model.sentence import BOTH
from arboleda.runtime.endpoints import Find, Place

from .choosing import EXAMPLE, FORM, LONGEST, NO_SUCH, Choice, TaskRefused, chosen, names_plants
from .reach import NO_PLANT, NOT_REACHED, PlantRefusal, PlantSilent, Reach
from .side import LastSeenPlant, RequestOutcome

LOOK_S = 2.0  # between two looks at a plant
OEE_S = 60.0
FIND_S = 5.0  # between two looks where plants are
LOG = logging.getLogger(__name__)

NOT_YET = Phrase("site.not_seen", "not asked yet")
STANDS_BY = Phrase("site.stands_by", "only a standby answers, and it does nothing itself")
TAKEN = Phrase("site.taken", "{plant} has taken {text} (#{id})")
NOT_TAKEN = Phrase("site.not_taken", "{plant}: {why}")
STOPPED = Phrase("site.stopped", "{plants} heard the stop; each plant's own page says when its robots stand")
STOPPED_ALL = Phrase(
    "site.stopped_all", "all {count} plants heard the stop; each plant's own page says when its robots stand"
)
NO_PLANTS = Phrase("site.no_plants", "no plant is on this page")
NOT_STOPPED = Phrase(
    "site.not_stopped",
    "NOT STOPPED, use the hard-wired button there: {silent}; {count} other plants heard the stop",
)
NOT_STOPPED_THAT = Phrase("site.not_stopped_that", "{plant} ({why})")


class WatchedPlant:
    """WatchedPlant: one address, and its last answers."""

    def __init__(self, place: Place) -> None:
        self.reach = Reach(place)
        self.silent: Sentence | None = NOT_YET()
        self.snapshot: dict[str, Any] | None = None
        self.oee: list[dict[str, Any]] = []
        self.stands_by = False
        self.is_left = False  # nobody wants to know of it any more
        self._name = place.plant
        self._oee_at = 0.0

    @property
    def url(self) -> str:
        return self.reach.place.url

    @property
    def name(self) -> str:
        """The name of the plant; its address if it never answered."""
        return self._name or self.url

    async def follow(self, after_s: float) -> None:
        """Look again and again, until cancelled."""
        try:
            await asyncio.sleep(after_s)
            while not self.is_left:
                await self.look()
                await asyncio.sleep(LOOK_S)
        finally:
            await self.reach.close()

    async def look(self) -> None:
        """Ask once, and keep the answer or the silence."""
        try:
            self._take_in(await self.reach.get("/api/plant"))
            now = asyncio.get_running_loop().time()
            if not self.stands_by and now >= self._oee_at:
                self.oee, self._oee_at = await self.reach.get("/api/oee"), now + OEE_S
        except (PlantSilent, PlantRefusal) as error:
            self.silent = error.sentence

    def _take_in(self, snapshot: Any) -> None:
        name = snapshot.get("plant") if isinstance(snapshot, dict) else None
        if not isinstance(name, str) or not ("cells" in snapshot or snapshot.get("standby") is True):
            raise PlantSilent(NO_PLANT(url=self.url))
        self._name, self.stands_by = name, snapshot.get("standby") is True
        self.silent = STANDS_BY() if self.stands_by else None
        self.snapshot = None if self.stands_by else snapshot


class Site:
    """Site: the plants as `arboleda_fleet.site.side.SiteSide`."""

    def __init__(self, find: Find) -> None:
        self._find = find
        self._watched: dict[Place, WatchedPlant] = {}
        self._tasks: dict[Place, asyncio.Task[None]] = {}
        self._finding: asyncio.Task[None] | None = None
        self._stopping: dict[str, asyncio.Task[RequestOutcome]] = {}

    def start(self) -> None:
        """Begin to watch, in the running event loop."""
        self._finding = asyncio.create_task(self._keep_finding())

    async def close(self) -> None:
        running = [*self._tasks.values(), *([self._finding] if self._finding else [])]
        await asyncio.gather(*map(ended, running))

    def plants(self) -> list[LastSeenPlant]:
        """A row for each plant, whatever number of processes it has."""
        return [_row(name, those) for name, those in self._rows()]

    async def submit(self, plant: str, text: str) -> RequestOutcome:
        """Have that plant take a task; a text that names plants goes to the best of those."""
        reaches = {name: those[0].reach for name, those in self._rows()}
        choice = Choice(plant=plant, text=text, why=None)
        try:
            if names_plants(text):
                choice = await chosen(text, reaches)
            if choice.plant not in reaches:
                raise TaskRefused(NO_SUCH(plant=choice.plant) if choice.plant else FORM(example=EXAMPLE))
            why = {"why": str(choice.why)[:LONGEST]} if choice.why else {}
            task = await reaches[choice.plant].post("/api/tasks", {"text": choice.text, **why})
            taken = TAKEN(plant=choice.plant, text=str(task["text"]), id=str(task["id"]))
        except TaskRefused as error:
            return RequestOutcome(good=False, sentence=error.sentence)
        except (PlantSilent, PlantRefusal) as error:
            return RequestOutcome(good=False, sentence=NOT_TAKEN(plant=choice.plant, why=error.sentence))
        except (KeyError, TypeError):
            return RequestOutcome(good=False, sentence=NO_PLANT(url=reaches[choice.plant].place.url))
        return RequestOutcome(
            good=True, sentence=BOTH(first=taken, second=choice.why) if choice.why else taken
        )

    async def stop(self, plant: str = "") -> RequestOutcome:
        """Stop one plant, or all of them; the same request meanwhile gets the same answer."""
        running = self._stopping.get(plant)
        if running is None or running.done():
            running = self._stopping[plant] = asyncio.create_task(self._stop(plant))
        return await asyncio.shield(running)

    async def _stop(self, plant: str) -> RequestOutcome:
        rows = [row for row in self._rows() if plant in ("", row[0])]
        if not rows:
            return RequestOutcome(good=False, sentence=NO_SUCH(plant=plant) if plant else NO_PLANTS())
        answers = await asyncio.gather(*(_stop_plant(those) for _, those in rows))
        silent = [
            NOT_STOPPED_THAT(plant=name, why=why)
            for (name, _), why in zip(rows, answers, strict=True)
            if why is not None
        ]
        if silent:
            return RequestOutcome(
                good=False, sentence=NOT_STOPPED(silent=tuple(silent), count=len(rows) - len(silent))
            )
        if len(rows) == 1:
            return RequestOutcome(good=True, sentence=STOPPED(plants=rows[0][0]))
        return RequestOutcome(good=True, sentence=STOPPED_ALL(count=len(rows)))

    def _rows(self) -> Iterator[tuple[str, list[WatchedPlant]]]:
        """The name of each plant, and its addresses, that of its leader first. Two that both claim to lead a
        plant of that name are two rows: neither may be hidden by the other."""
        found: dict[str, list[WatchedPlant]] = defaultdict(list)
        for watched in self._watched.values():
            found[watched.name].append(watched)
        for plant, those in sorted(found.items()):
            leading = [each for each in those if each.silent is None]
            if len(leading) > 1:
                yield from ((f"{plant} ({each.url})", [each]) for each in leading)
            else:
                yield plant, sorted(those, key=lambda each: (each.silent is not None, each.stands_by))

    async def _keep_finding(self) -> None:
        while True:
            try:
                self._follow(await asyncio.to_thread(self._find))
            except ArboledaError as error:
                LOG.warning("the plants cannot be looked up: %s", error)
            await asyncio.sleep(FIND_S)

    def _follow(self, places: list[Place]) -> None:
        """Watch the new places, and no longer those that are gone."""
        for place in self._watched.keys() - set(places):
            self._watched.pop(place).is_left = True
            self._tasks.pop(place).cancel()
        fresh = [place for place in dict.fromkeys(places) if place not in self._watched]
        for number, place in enumerate(fresh):
            watched = self._watched[place] = WatchedPlant(place)
            apart_s = LOOK_S * number / len(fresh)  # so that they are not all looked at in one moment
            self._tasks[place] = asyncio.create_task(watched.follow(apart_s))


async def _stop_plant(those: list[WatchedPlant]) -> Sentence | None:
    """Send the stop to all addresses of a plant; the reason if none heard it, None if one did."""
    answers = await asyncio.gather(*map(_stop_process, those))
    return None if None in answers else answers[0]


async def _stop_process(watched: WatchedPlant) -> Sentence | None:
    """Send a stop there; the reason if it fails. An idle connection may be closed: then it tries another."""
    for is_last in (False, True):
        try:
            await watched.reach.post("/api/plant/stop")
        except (PlantSilent, PlantRefusal) as error:
            if is_last or error.sentence.phrase is not NOT_REACHED:
                return error.sentence
        else:
            return None
    return None


def _row(name: str, those: list[WatchedPlant]) -> LastSeenPlant:
    led = those[0]
    return LastSeenPlant(
        name=name,
        url=led.url,
        silent=led.silent,
        snapshot=led.snapshot,
        oee=led.oee,
        standbys=sum(each.stands_by for each in those),
    )
