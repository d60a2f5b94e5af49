"""Logins: three roles, a token for each, and sessions behind a cookie."""

from __future__ import annotations

import hashlib
import logging
import secrets
import time
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass

from arboleda.model.errors import ArboledaError
from arboleda.model.verbs import Role as Role  # of logins, whoever asks for them
from arboleda.model.verbs import Verb

log = logging.getLogger(__name__)

SESSION_S = 7 * 24 * 3600.0
SESSIONS = 256  # only holders of a token make one; the oldest makes room


SUBMIT = "submit"
EVERYBODY_MAY = {verb.value for verb in Verb if verb.row.role is Role.VIEWER}
MAY = {
    None: "{act} needs the operator's token.",
    Role.VIEWER: "A viewer may look and stop; {act} needs the operator's token.",
    Role.ASSISTANT: "An assistant may look, propose and stop; {act} needs the operator's token.",
}
Tokens = Callable[[], "dict[Role, str]"]


class Forbidden(ArboledaError):
    """Error: the role is not enough; the sentence names the one needed."""


def allowed(role: Role | None, act: str) -> bool:
    """True if a role may do `act`, a verb's word or SUBMIT; everybody who is logged in may stop."""
    return role is Role.OPERATOR or (role is not None and act in EVERYBODY_MAY)


def require(role: Role | None, act: str) -> None:
    """Raises Forbidden if `allowed` is False."""
    if not allowed(role, act):
        raise Forbidden(MAY[role].format(act=act))


@dataclass(frozen=True, kw_only=True)
class Login:
    """Client that is logged in; `key` tells clients apart, `alive()` turns False at logout or a new token."""

    role: Role
    key: str
    alive: Callable[[], bool]


LOCAL = Login(role=Role.OPERATOR, key="local", alive=lambda: True)


@dataclass(frozen=True, kw_only=True)
class _Session:
    role: Role
    token: str
    until: float


class Door:
    """Check of tokens and sessions. `tokens()` gives the valid ones; without it everybody is the operator."""

    def __init__(self, tokens: Tokens | None, clock: Callable[[], float] = time.monotonic) -> None:
        self._tokens = tokens
        self._clock = clock
        self._sessions: OrderedDict[str, _Session] = OrderedDict()
        self._trouble = ""

    @property
    def open(self) -> bool:
        """True if no token is needed."""
        return self._tokens is None

    def by_token(self, token: bytes) -> Login | None:
        """The login that this token belongs to, None if unknown; compares every token in constant time."""
        found = None
        for role, known in self._valid().items():
            if secrets.compare_digest(token, known.encode()):
                found = self._bearer(role, known)
        return found

    def by_cookie(self, session: str) -> Login | None:
        """The login of a session; None after logout, after a week, or once its role has a new token."""
        key = _digest(session)
        known = self._sessions.get(key)
        if known is None or not self._alive(key):
            return None
        return Login(role=known.role, key=f"session {key}", alive=lambda: self._alive(key))

    def log_in(self, token: bytes) -> str | None:
        """A new session; None for a wrong token."""
        login = self.by_token(token)
        if login is None:
            return None
        session = secrets.token_urlsafe(32)
        made = _Session(role=login.role, token=token.decode(), until=self._clock() + SESSION_S)
        self._sessions[_digest(session)] = made
        while len(self._sessions) > SESSIONS:
            self._sessions.popitem(last=False)
        return session

    def log_out(self, session: str) -> None:
        """End the session, and with it every socket under it; idempotent."""
        self._sessions.pop(_digest(session), None)

    def _bearer(self, role: Role, token: str) -> Login:
        return Login(role=role, key=f"token {role.value}", alive=lambda: self._valid().get(role) == token)

    def _alive(self, key: str) -> bool:
        known = self._sessions.get(key)
        if known is None:
            return False
        if known.until > self._clock() and self._valid().get(known.role) == known.token:
            return True
        del self._sessions[key]
        return False

    def _valid(self) -> dict[Role, str]:
        try:
            return self._tokens() if self._tokens is not None else {}
        except ArboledaError as error:
            if str(error) != self._trouble:  # said once, not at every request
                self._trouble = str(error)
                log.error("nobody can log in: %s", error)
            return {}


def _digest(session: str) -> str:
    """The hash under which a session is stored, so that lookup times reveal nothing of the cookie."""
    return hashlib.sha256(session.encode(errors="replace")).hexdigest()
