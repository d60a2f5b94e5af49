"""A page that is open in one browser: its frames, its requests and the answers to them."""

from __future__ import annotations

import json
from collections.abc import Callable

from arboleda.web.access.auth import Role

from .toolkit import Client, GenericEventArguments
from .wording import Words

LONGEST = 300  # characters of a name that a browser sends
SEEN = "seen"


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
        """Take one event of the page: [act, of, more]; anything else is ignored."""
        args = event.args if isinstance(event.args, list) else [event.args]
        act, of, more = [*args, None, None, None][:3]
        if act == SEEN and isinstance(of, int):
            self._note_shown(self, of)
        elif isinstance(act, str) and isinstance(of, str) and len(of) <= LONGEST:
            await self.take(act, of, more)

    async def take(self, act: str, of: str, more: object) -> None:
        """Take a request of the page."""
        raise NotImplementedError

    def say(self, sentence: str, *, good: bool | None) -> None:
        """Show an answer; `good` is None while the outcome is unknown."""
        self._client.run_javascript(f"arboleda.answer({json.dumps(sentence)}, {json.dumps(good)})")
