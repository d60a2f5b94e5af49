"""Connections of the broker, and the choice of the one to close where there are too many."""

from __future__ import annotations

from asyncio import get_running_loop
from itertools import count
from typing import Protocol

from . import limits
from .access import ALLOWED, Access, ClientIdentity, Role
from .limits import Bucket
from .packets import Answer, Connect, ConnectRefused

Key = tuple[str, str]  # user and client id


class Connection(Protocol):
    """Client connection, as far as the sessions need to know it."""

    @property
    def who(self) -> ClientIdentity | None: ...
    @property
    def idle(self) -> bool: ...
    def cut(self, why: str) -> None: ...


class Sessions:
    """Connections of one broker, the oldest first, at most `most`. Cutting one must call `went`."""

    def __init__(self, access: Access, most: int) -> None:
        self.access = access
        strangers = most - len(access.boards) - 1  # beside the plant's own
        self._may_wait = max(2, min(limits.WAITING, strangers // 2))
        self._may_enter = most - self._may_wait
        self._waiting: dict[Connection, None] = {}  # not logged in yet
        self._clients: dict[Key, Connection] = {}
        self._keys: dict[Connection, Key] = {}
        self._buckets: dict[str, Bucket] = {}
        self._nameless = count()
        self._ending = False

    def came(self, client: Connection) -> None:
        """Note a new connection; if too many wait to log in, cut the one that has waited longest."""
        self._waiting[client] = None
        if self._ending:
            client.cut("the broker ends")
        elif len(self._waiting) > self._may_wait:
            next(iter(self._waiting)).cut("others want to log in")

    def log_in(self, client: Connection, connect: Connect, shown: str = "") -> ClientIdentity:
        """Let it in, by what it says and the name that its certificate has (`shown`), in the place of an
        earlier connection of its user with its client id; ConnectRefused."""
        who = self.access.login(connect.user, connect.password, shown)
        if who is None or (connect.will is not None and not self.access.may_write(who, connect.will.topic)):
            raise ConnectRefused(Answer.NOT_AUTHORIZED)
        # No client can send an id equal to this one for clients without an id.
        key = who.user, connect.client_id or f"\0{next(self._nameless)}"
        if key in self._clients:
            self._clients[key].cut("a later connection has its client id")
        self._make_room(who)
        del self._waiting[client]
        self._clients[key] = client
        self._keys[client] = key
        return who

    def went(self, client: Connection) -> None:
        """Forget a connection that is gone; idempotent."""
        self._waiting.pop(client, None)
        if client in self._keys:
            del self._clients[self._keys.pop(client)]

    def end(self) -> None:
        """Cut off all connections, and any that still comes."""
        self._ending = True
        for client in (*self._waiting, *self._clients.values()):
            client.cut("the broker ends")

    def bucket(self, who: ClientIdentity) -> Bucket | None:
        """The rate limit of this user's messages: one for each guest, None for the plant itself."""
        allowed = ALLOWED.get(who.role)
        if allowed is None:
            return None
        fresh = Bucket(allowed.rate, get_running_loop().time())
        return fresh if who.role is Role.GUEST else self._buckets.setdefault(who.user, fresh)

    def _make_room(self, who: ClientIdentity) -> None:
        """Make room for a user, if need be by cutting off an idle connection.

        Raises ConnectRefused if this user, or all together, have as many as they may and none is idle. For
        the plant itself another one is cut off, idle or not.
        """
        allowed = ALLOWED.get(who.role)
        others = [client for client in self._clients.values() if client.who and client.who.role in ALLOWED]
        mine = [client for client in others if client.who and client.who.user == who.user]
        if allowed is not None and len(mine) >= allowed.connections:
            _cut_oldest(mine, or_any=False)
        elif len(self._clients) >= self._may_enter:
            _cut_oldest(others, or_any=allowed is None)


def _cut_oldest(clients: list[Connection], *, or_any: bool) -> None:
    """Cut off the oldest idle connection, else the oldest if `or_any`; ConnectRefused if there is none."""
    idle = [client for client in clients if client.idle]
    leaving = idle or (clients if or_any else [])
    if leaving:
        leaving[0].cut("it did nothing, and others want in" if idle else "the plant itself wants in")
    elif not or_any:
        raise ConnectRefused(Answer.BUSY)
