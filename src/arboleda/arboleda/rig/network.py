"""Network between two processes: a broker, and lines that lose, repeat, delay and reorder messages."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Protocol

from arboleda.wire.transport import Delivery, Publication

At = Callable[[float, Callable[[Any], None], Any], None]  # (time, call, its argument): have it called then
Trouble = Callable[[Any], Iterable[float]]  # a message -> how late each of its copies comes, s; none: lost


class Clock(Protocol):
    """Whoever has the time, s."""

    @property
    def now(self) -> float: ...


class Line:
    """One direction of a connection; messages keep their order unless `reorders`, presence always does.

    `busy_until` is the time at which the last message that was sent so far arrives.
    """

    def __init__(self) -> None:
        self.troubles: list[Trouble] = []
        self.reorders = 0  # how many faults let later messages overtake
        self.busy_until = 0.0

    def is_clear(self, now: float) -> bool:
        """True if a message arrives at once, and only once."""
        return not self.troubles and self.busy_until <= now

    def carry(self, now: float, message: Any) -> list[float]:
        """The arrival times of the copies of a message; empty if it is lost."""
        if self.is_clear(now):
            return [now]
        earliest = now if self.reorders and not keeps_its_place(message) else self.busy_until
        return self._arrivals(now, message, earliest)

    def skip(self, seconds: float) -> None:
        """Delay every message that is under way."""
        self.busy_until += seconds

    def _arrivals(self, now: float, message: Any, earliest: float) -> list[float]:
        delays = [0.0]
        for trouble in self.troubles:
            delays = [delay + more for delay in delays for more in trouble(message)]
        arrivals = [max(earliest, now + delay) for delay in delays]
        self.busy_until = max(self.busy_until, *arrivals) if arrivals else self.busy_until
        return arrivals


class Hop(Line):
    """One direction between plant and bridge: ROS 2 keeps the order of each topic, not that of several."""

    def __init__(self) -> None:
        super().__init__()
        self._busy_until: dict[str, float] = {}  # by topic

    def skip(self, seconds: float) -> None:
        super().skip(seconds)
        self._busy_until = {topic: until + seconds for topic, until in self._busy_until.items()}

    def carry_on(self, topic: str, now: float, message: Any) -> list[float]:
        """The arrival times of the copies of a message on a topic; empty if it is lost."""
        if self.is_clear(now):
            return [now]
        arrivals = self._arrivals(now, message, self._busy_until.get(topic, now))
        if arrivals:
            self._busy_until[topic] = max(arrivals)
        return arrivals


def keeps_its_place(message: Any) -> bool:
    """True for presence (retained, QoS 1): MQTT never loses or reorders it while a connection lasts.

    Presence has no number, so its order is its only protection; if its connection breaks, it is sent anew.
    """
    return isinstance(message, Publication) and message.retain


class Client:
    """A process at the broker: its inbox, and whether it is connected.

    `superseded`: another process does its work by now. What it said before that may still be under way.
    """

    def __init__(self, name: str, topics: Iterable[str]) -> None:
        self.name = name
        self.topics = frozenset(topics)
        self.inbox: list[Any] = []
        self.up, self.down = Line(), Line()
        self.connected = False
        self.superseded = False
        self.connection = 0  # counts connections: what was under way in an earlier one is lost
        self.queue = 0  # counts queues at the broker: what waited in an earlier one is lost, presence apart

    def connect(self, up: bool) -> None:
        self.connected = up
        self.connection += 1


class Broker:
    """Takes publications from clients to the inboxes of those that listen, as `Delivery`.

    A publication that is not delayed anywhere is in the inbox before `publish` returns. `delivered` gets each
    delivery, with the name of the client that it reached, and `outdated` those of these that a client had
    published before it was superseded, and that arrive after that.
    """

    def __init__(
        self, clock: Clock, at: At, delivered: list[tuple[str, Delivery]], outdated: list[Delivery]
    ) -> None:
        self.is_up = True
        self.retained: dict[str, Publication] = {}
        self.clients: dict[str, Client] = {}
        self._clock = clock
        self._at = at
        self._delivered = delivered
        self._outdated = outdated
        self._lives = 0
        self._listeners: dict[str, list[Client]] = {}

    def join(self, client: Client) -> None:
        self.clients[client.name] = client
        for topic in client.topics:
            self._listeners.setdefault(topic, []).append(client)

    def leave(self, client: Client) -> None:
        """Remove a client that never comes back."""
        client.connect(False)
        del self.clients[client.name]
        for topic in client.topics:
            self._listeners[topic].remove(client)

    def rename(self, client: Client, name: str) -> None:
        """Give a client another name, as another process takes its place."""
        del self.clients[client.name]
        client.name = name
        self.clients[name] = client

    def publish(self, publication: Publication, sender: Client | None = None) -> None:
        """Publish for a sender; None: somebody outside the plant, or the broker with a client's last will."""
        now = self._clock.now
        # What a process says once it is superseded is no message of before: it should say nothing.
        of_before = None if sender is None or sender.superseded else sender
        if sender is None or (sender.connected and not sender.up.troubles and sender.up.busy_until <= now):
            self._spread(publication, now, of_before)
        elif sender.connected:
            for at in sender.up.carry(now, publication):
                self._when(at, self._arrive, (self._lives, publication, of_before))

    def tell_retained(self, client: Client) -> None:
        """Deliver the retained messages to a client that has just subscribed."""
        for publication in self.retained.values():
            if publication.topic in client.topics:
                self._send(client, publication, self._clock.now, None, retained=True)

    def die(self) -> None:
        """End every connection, and drop all that was retained or under way."""
        self.is_up = False
        self._lives += 1
        self.retained.clear()
        for client in self.clients.values():
            client.connect(False)

    def _when(self, at: float, call: Callable[[Any], None], argument: Any) -> None:
        if at <= self._clock.now:
            call(argument)
        else:
            self._at(at, call, argument)

    def _arrive(self, carried: tuple[int, Publication, Client | None]) -> None:
        life, publication, sender = carried
        if life == self._lives:
            self._spread(publication, self._clock.now, sender)

    def _spread(self, publication: Publication, now: float, sender: Client | None) -> None:
        if not self.is_up:
            return
        topic, payload = publication.topic, publication.payload
        if publication.retain:
            self.retained[topic] = publication
        for client in self._listeners.get(topic, ()):
            down = client.down  # neither `is_clear` nor `_hand` is called: every message comes by here
            if client.connected and not down.troubles and down.busy_until <= now:
                delivery = Delivery(at=now, topic=topic, payload=payload, retain=False)
                self._delivered.append((client.name, delivery))
                if sender is not None and sender.superseded:
                    self._outdated.append(delivery)
                client.inbox.append(delivery)
            else:
                self._send(client, publication, now, sender, retained=False)

    def _send(
        self, client: Client, publication: Publication, now: float, sender: Client | None, *, retained: bool
    ) -> None:
        if not client.connected:
            return
        carried = (client, client.connection, client.queue, publication, sender, retained)
        for at in client.down.carry(now, publication):
            self._when(at, self._hand_over, carried)

    def _hand_over(self, carried: tuple[Client, int, int, Publication, Client | None, bool]) -> None:
        client, connection, queue, publication, sender, retained = carried
        if client.connection == connection and (client.queue == queue or keeps_its_place(publication)):
            topic, payload = publication.topic, publication.payload
            delivery = Delivery(at=self._clock.now, topic=topic, payload=payload, retain=retained)
            self._hand(client, delivery, sender)

    def _hand(self, client: Client, delivery: Delivery, sender: Client | None) -> None:
        self._delivered.append((client.name, delivery))
        if sender is not None and sender.superseded:
            self._outdated.append(delivery)
        client.inbox.append(delivery)
