"""A page that is open in one browser: its frames, its requests and the answers to them."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextvars import ContextVar

from arboleda.web.access.auth import Role

from .toolkit import Client, GenericEventArguments
from .wording import Words

LONGEST = 300  # characters of a name that a browser sends
SEEN = "seen"
_asked: ContextVar[int | None] = ContextVar("number of the request that is taken", default=None)


class OpenPage:
    """OpenPage: a viewer of frames; `note_shown` gets the number of each frame shown. Subclasses check
    roles in `take`."""

    def __init__(self, client: Client, words: Words, note_shown: Callable[[OpenPage, int], None]) -> None:
        self.language = words.language
        self._client = client
        self._words = words
        self._note_shown = note_shown

    @property
    def connected(self) -> bool:
        return self._client.has_socket_connection

    @property
    def role(self) -> Role | None:
        """The role of the connection behind the page, as the guard put it into its scope."""
        role: Role | None = (self._client.environ or {}).get("asgi.scope", {}).get("arboleda.role")
        return role

    def show(self, number: int, patch: str) -> None:
        """Send one frame."""
        self._client.run_javascript(f"arboleda.live({number}, {patch})")

    async def hear(self, event: GenericEventArguments) -> None:
        """Take one event of the page: [act, of, more, number]; anything else is ignored.

        What is said meanwhile has the number, if there is one, by which a script finds its request.
        """
        args = event.args if isinstance(event.args, list) else [event.args]
        act, of, more, number = [*args, None, None, None, None][:4]
        if act == SEEN and isinstance(of, int):
            self._note_shown(self, of)
        elif isinstance(act, str) and isinstance(of, str) and len(of) <= LONGEST:
            _asked.set(number if isinstance(number, int) else None)
            await self.take(act, of, more)
            self._end()

    async def take(self, act: str, of: str, more: object) -> None:
        """Take a request of the page."""
        raise NotImplementedError

    def say(self, sentence: str, *, good: bool | None) -> None:
        """Show an answer; `good` is None while the outcome is unknown."""
        number = _asked.get()
        of = "" if number is None else f", {number}"
        self._client.run_javascript(f"arboleda.answer({json.dumps(sentence)}, {json.dumps(good)}{of})")

    def _end(self) -> None:
        """Tell the script that nothing more is said to its request."""
        if _asked.get() is not None:
            self._client.run_javascript(f"arboleda.over({_asked.get()})")
