"""The tokens of a plant that is open to a network: one per role, in a file for its owner only."""

from __future__ import annotations

import json
import secrets
import stat
from collections.abc import Collection
from pathlib import Path

from arboleda.model.errors import StartError
from arboleda.web.access.auth import Role

from .state import replace_file

TOKENS = "tokens.json"
FROM_THE_FIRST = (Role.VIEWER, Role.OPERATOR)  # files of before have no other ones
BYTES, SHORTEST = 24, 20  # nobody guesses 192 bits; a hand-made word of 8 letters somebody does
OWNER_ONLY = 0o077


def read(state: Path) -> dict[Role, str]:
    """The token of each role, made if there is none yet; StartError if the file cannot be used."""
    if not (state / TOKENS).exists():
        renew(state, tuple(Role))
    missing = set(Role) - set(TokenFile(state)())
    if missing:
        renew(state, missing)
    return TokenFile(state)()


def renew(state: Path, roles: Collection[Role]) -> None:
    """Give these roles new tokens; the old ones are refused at once."""
    try:
        state.mkdir(mode=0o700, parents=True, exist_ok=True)
        present = TokenFile(state)() if (state / TOKENS).exists() and set(roles) != set(Role) else {}
        fresh = {role: present.get(role) if role not in roles else None for role in Role}
        tokens = {role.value: token or secrets.token_urlsafe(BYTES) for role, token in fresh.items()}
        replace_file(state / TOKENS, json.dumps(tokens) + "\n")
    except OSError as error:
        raise StartError(f"The tokens cannot be kept in {state}: {error.strerror}.") from error


class TokenFile:
    """TokenFile: gives the tokens as the file has them now; reads it anew only if it has changed."""

    def __init__(self, state: Path) -> None:
        self._file = state / TOKENS
        self._last_file: tuple[int, int] | None = None
        self._tokens: dict[Role, str] = {}

    def __call__(self) -> dict[Role, str]:
        """The tokens by role; StartError if the file is missing, readable by others, or malformed."""
        try:
            about = self._file.stat()
            if (about.st_ino, about.st_mtime_ns) != self._last_file:
                self._tokens = self._read(about.st_mode)
                self._last_file = (about.st_ino, about.st_mtime_ns)
        except OSError as error:
            raise StartError(f"The tokens in {self._file} cannot be read: {error.strerror}.") from error
        return self._tokens

    def _read(self, mode: int) -> dict[Role, str]:
        if stat.S_IMODE(mode) & OWNER_ONLY:
            raise StartError(
                f"Others can read the tokens in {self._file}; chmod 600 {self._file}, then --new."
            )
        try:
            content = json.loads(self._file.read_bytes())
            tokens = {
                role: content[role.value] for role in Role if role in FROM_THE_FIRST or role.value in content
            }
            good = all(isinstance(token, str) and len(token) >= SHORTEST for token in tokens.values())
        except (ValueError, KeyError, TypeError):
            good = False
        if not good or len(set(tokens.values())) < len(tokens):
            raise StartError(f"{self._file} is no file of tokens; make a new one: arboleda token --new")
        return tokens
