"""Client of a plant for the commands that need one: asks the process on its state directory or, if that one
does not lead the plant, the one that does."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any
from urllib.parse import quote, urlencode

from arboleda.client.errors import NoAnswer
from arboleda.client.http import TIMEOUT_S
from arboleda.model.errors import ArboledaError
from arboleda.model.messages import ENDED, Outcome, TaskState, Verb
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.verbs import Arguments
from arboleda.runtime import endpoints
from arboleda.runtime.leader import of_standby
from arboleda.runtime.state import Running, find_running, running_plants

from .language import say
from .line import Answer, FarLine, Line
from .remote_plant import NoLeader, RemotePlant

LONGEST = 500  # characters of a line
NEXT_S = 30.0  # for a plant that lost its leader to get the next one
NOBODY_S = 15.0  # a standby on a busy host needs less to begin leading; until then nobody leads or waits
LOOK_S = 0.2
FOLLOWED_S = 120.0  # a homing may take a minute
URGENT_S = 1.5  # a stop is answered within some ms
STANDS_BY = Phrase("cli.client.stands_by", "this process stands by and does nothing itself: it {it}")
LOST_TASK = Phrase(
    "cli.client.lost_task",
    "{error} It may have taken the task: `arboleda tasks` says so. With an id of yours, as in `sis_a 0B 7 "
    "#lot42`, it can be sent again and is one task.",
)
ENDED_PLANT = Phrase("cli.client.ended", "the plant has ended")
ENDED_BEFORE = Phrase(
    "cli.client.ended_before", "the plant has ended, and #{id} has not: its next start has it again"
)
THE_PLANT = Phrase("cli.client.the_plant", "The plant on {folder} (process {process})")
NONE_RUNS = Phrase("cli.client.none_runs", "No plant is running on {folder}")
NOT_READY = Phrase(
    "cli.client.not_ready", "The plant on {folder} (process {process}) is still starting or ending"
)
TWO_SENTENCES = Phrase("cli.client.two", "{first}. {second}")
AND_OTHERS = Phrase("cli.client.and_others", "{first}; {others}.")
ONE_SENTENCE = Phrase("cli.client.one", "{first}.")
LED_NOW = Phrase("cli.client.led_now", "{silent} Plant {plant} is led on {host} now.")
ASKED_THERE = Phrase("cli.client.asked_there", "plant {plant} is led on {host}: asked there")
FOLLOWED_THERE = Phrase("cli.client.followed_there", "plant {plant} is led on {host}: followed there")
START_ONE = Phrase(
    "cli.client.start_one",
    "start one with `arboleda up`, or name its directory where it was started with --state",
)
THE_ONE = Phrase("cli.client.the_one", "the one that runs is {named}")
THOSE = Phrase("cli.client.those", "those that run are {named}")


class PlantGone(ArboledaError):
    """The plant has ended while it was followed."""

    def __init__(self) -> None:
        super().__init__(ENDED_PLANT())


class PlantClient:
    """PlantClient: asks a plant; ArboledaError, in one sentence: no plant, no answer, or the plant's refusal.

    If it asks another host, it prints that once, on standard error.
    """

    def __init__(self, state: Path, elsewhere: RemotePlant | None = None) -> None:
        self._state = state
        self._elsewhere = elsewhere or RemotePlant(state, lambda: ("", ""), dict)
        self._listening: Line | None = None  # the line that sends changes also gets requests
        self._last_notice = ""

    def submit(self, text: str) -> dict[str, Any]:
        """The queued task; TextError if the text is refused, QueueFull if the plant takes no task now."""
        try:
            # An id makes it one task, however often it is sent; without one it is never sent again.
            return self._row("POST", "/api/tasks", {"text": text}, repeatable="#" in text)
        except NoAnswer as error:
            if not error.may_have_heard:
                raise
            raise NoAnswer(say(LOST_TASK(error=str(error))), may_have_heard=True) from error

    def status(self) -> dict[str, Any]:
        """The view of the plant."""
        return self._row("GET", "/api/plant")

    def get(self, path: str) -> Any:
        """The JSON that a route answers, also one of a package."""
        return self._ask("GET", path)

    def post(
        self,
        path: str,
        body: dict[str, Any] | None = None,
        *,
        is_repeatable: bool = False,
        within_s: float = TIMEOUT_S,
    ) -> Any:
        """Have a route do something, also one of a package; its answer. `is_repeatable`: nothing is done
        twice where two processes of the plant hear it."""
        return self._ask("POST", path, body, repeatable=is_repeatable, within_s=within_s)

    def task(self, task: str) -> dict[str, Any]:
        """One task by its id."""
        return self._row("GET", f"/api/tasks/{task}")

    def operate(
        self, verb: Verb, scope: str = "", *, by_hand: bool = False, arguments: Arguments = ()
    ) -> dict[str, Any]:
        """Have the plant (no scope), a cell, robot, zone or task carry out a verb; Refused if it does not."""
        where = f"cells/{quote(scope, safe='')}" if scope else "plant"
        body = (dict(arguments) | ({"by_hand": True} if by_hand else {})) or None
        stops = verb.row.stops
        return self._row("POST", f"/api/{where}/{verb.value}", body, repeatable=stops, urgent=stops)

    def outcome(self, act: int) -> dict[str, Any]:
        """The row of an act once it has ended; after FOLLOWED_S as it is then."""
        until = time.monotonic() + FOLLOWED_S
        while True:
            row = self._row("GET", f"/api/acts/{act}")
            if row["outcome"] != Outcome.UNDER_WAY.value or time.monotonic() > until:
                return row
            time.sleep(LOOK_S)

    def changes(self) -> Iterator[tuple[str, dict[str, Any]]]:
        """The events of `GET /api/events` as they happen: the kind and the row of each, `snapshot` first.

        A reader that was too slow gets a new snapshot; so does that of a plant with a database, once the next
        leader is there within NEXT_S. PlantGone if the plant has ended.
        """
        epoch, cut_at = None, None
        while True:
            running, trouble = find_running(self._state), None
            try:
                line = self._leading()
                for kind, row in line.events():
                    if kind == "snapshot":
                        self._say(line, ASKED_THERE if epoch in (None, row["epoch"]) else FOLLOWED_THERE)
                        epoch = row["epoch"]
                    self._listening, cut_at = line, None
                    yield kind, row
            except ArboledaError as error:
                if epoch is None:
                    raise
                trouble = error
            finally:
                self._listening = None
            cut_at = cut_at or time.monotonic()
            if time.monotonic() - cut_at > self._patience_s(running, trouble):
                raise PlantGone from trouble
            time.sleep(LOOK_S)

    def _patience_s(self, before: Running | None, trouble: ArboledaError | None) -> float:
        """The time after a cut in which the same plant may go on, s."""
        if not self._elsewhere.is_known:
            return NEXT_S if trouble is None and find_running(self._state) == before else 0.0
        return NOBODY_S if isinstance(trouble, NoLeader) and not trouble.awaited else NEXT_S

    def follow(self, task: dict[str, Any]) -> Iterator[dict[str, Any]]:
        """The task at each change of its state, until it has ended; ArboledaError if the plant ends first."""
        if TaskState(task["state"]) in ENDED:
            return
        try:
            for now in self._news_of(task["id"]):
                if now["state"] != task["state"]:
                    yield (task := now)
                if TaskState(task["state"]) in ENDED:
                    return
        except PlantGone as error:
            raise ArboledaError(ENDED_BEFORE(id=task["id"])) from error

    def _news_of(self, id: str) -> Iterator[dict[str, Any]]:
        for kind, row in self.changes():
            rows = row["tasks"] if kind == "snapshot" else [row] if kind == "task" else []
            found = [each for each in rows if each["id"] == id]
            yield from found or (self._kept(id) if kind == "snapshot" else ())

    def _kept(self, id: str) -> list[dict[str, Any]]:
        """The task from the history: a leader may not know tasks that ended under the one before."""
        rows = self._ask("GET", f"/api/history?{urlencode({'words': id})}")
        return [row for row in rows if row["id"] == id]

    def _row(self, method: str, path: str, body: dict[str, Any] | None = None, **how: Any) -> dict[str, Any]:
        """The answer of a route that answers with an object; `how` as for `_ask`."""
        row: dict[str, Any] = self._ask(method, path, body, **how)
        return row

    def _ask(
        self,
        method: str,
        path: str,
        body: dict[str, Any] | None = None,
        *,
        repeatable: bool = False,
        urgent: bool = False,
        within_s: float = TIMEOUT_S,
    ) -> Any:
        """`repeatable`: nothing is done twice where two processes of the plant hear it. `urgent`: a process
        here that is slow keeps it from a leader elsewhere for no longer than URGENT_S."""
        line = self._listening or self._near() or self._far()
        hurries = urgent and self._elsewhere.is_known and not isinstance(line, FarLine)
        try:
            answer = line.ask(method, path, body, within_s=URGENT_S if hurries else within_s)
        except NoAnswer as error:
            other = self._instead(line, error, repeatable=repeatable or method == "GET")
            if other is None and not hurries:
                raise
            line = other or line  # with the rest of its time
            answer = line.ask(method, path, body)
        if answer.stands_by and not isinstance(line, FarLine):
            line = self._beyond(answer)
            answer = line.ask(method, path, body)
        self._say(line, ASKED_THERE)
        return line.taken(answer)

    def _leading(self) -> Line:
        """The line to the process that leads the plant now."""
        line = self._near()
        if line is None:
            return self._far()
        answer = line.ask("GET", "/api/plant")
        return self._beyond(answer) if answer.stands_by else line

    def _near(self) -> Line | None:
        """The line to the process on the state directory, None if none can be asked."""
        running = find_running(self._state)
        if running is None or running.port is None:
            return None
        name = THE_PLANT(folder=str(self._state), process=running.pid)
        return Line(endpoints.here(self._state, running), name)

    def _beyond(self, answer: Answer) -> FarLine:
        """The line to the process that leads the plant, as a process that stands by names it."""
        sentence = answer.sentence if answer.status >= 300 else say(STANDS_BY(it=answer.sentence))
        led = of_standby(answer.body)
        if not led.url:
            raise ArboledaError(sentence)
        try:
            return self._elsewhere.line(led)
        except ArboledaError as error:
            raise ArboledaError(TWO_SENTENCES(first=sentence, second=error.sentence)) from error

    def _far(self) -> FarLine:
        """The line to the leader that the plant's database names; else an error about the process here."""
        running = find_running(self._state)
        if running is None:
            here = NONE_RUNS(folder=str(self._state))
        else:
            here = NOT_READY(folder=str(self._state), process=running.pid)
        try:
            led = self._elsewhere.led()
            if led is not None:
                return self._elsewhere.line(led)
        except NoLeader as error:
            both = TWO_SENTENCES(first=here, second=error.sentence)
            raise NoLeader(both, awaited=error.awaited or running is not None) from error
        except ArboledaError as error:
            raise ArboledaError(TWO_SENTENCES(first=here, second=error.sentence)) from error
        raise ArboledaError(
            AND_OTHERS(first=here, others=_others()) if running is None else ONE_SENTENCE(first=here)
        )

    def _instead(self, line: Line, silent: NoAnswer, *, repeatable: bool) -> Line | None:
        """The line to another process that leads the plant, after one on this host was silent. None if there
        is none; NoAnswer if that one must not be asked as well."""
        led, running = None, find_running(self._state)
        if not isinstance(line, FarLine):
            with suppress(ArboledaError):  # then the silence of the one here is reported
                led = self._elsewhere.led()
        if led is None or (led.here and running is not None and led.process == running.pid):
            return None
        if silent.may_have_heard and not repeatable:
            sentence = say(LED_NOW(silent=str(silent), plant=led.plant, host=led.host))
            raise NoAnswer(sentence, may_have_heard=True) from silent
        return self._elsewhere.line(led)

    def _say(self, line: Line, done: Phrase) -> None:
        """Tell the person which host is asked, if that is not this process's own."""
        if not isinstance(line, FarLine) and done is ASKED_THERE:
            return
        notice = say(done(plant=line.place.plant, host=line.host))
        if notice != self._last_notice:
            print(plain(notice, LONGEST), file=sys.stderr, flush=True)
            self._last_notice = notice


def _others() -> Sentence:
    """Advice for a state directory on which no plant runs: names those that do run."""
    found = running_plants()
    if not found:
        return START_ONE()
    named = ", ".join(f"{plain(path.name)} (--state {plain(str(path), LONGEST)})" for path in found)
    return (THE_ONE if len(found) == 1 else THOSE)(named=named)
