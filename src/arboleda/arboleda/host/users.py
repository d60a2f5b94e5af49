"""Users of this machine."""

from __future__ import annotations

import getpass
import os
from pathlib import Path

try:
    import pwd
except ImportError:  # Windows
    pwd = None  # type: ignore[assignment]


def home_of(user: str) -> Path | None:
    """The home directory of a user; None if there is no such user, or this system does not tell of others."""
    if pwd is None:
        return None
    try:
        return Path(pwd.getpwnam(user).pw_dir)
    except KeyError:
        return None


def own_mark() -> str:
    """A word that another user of this machine does not have, for names of files."""
    return str(os.getuid()) if hasattr(os, "getuid") else getpass.getuser()
