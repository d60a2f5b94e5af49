"""Files that a person names: read whole or refused, whatever they are; and the users of a broker."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from arboleda.host.files import AT_ONCE
from arboleda.model.errors import ConfigError
from arboleda.model.outside import quoted

from .document import shown
from .yaml_marks import LARGEST


def read_bytes(path: Path, largest: int) -> bytes:
    """All of a regular file of at most `largest` bytes; ConfigError, at once, for anything else."""
    try:
        with os.fdopen(os.open(path, os.O_RDONLY | AT_ONCE), "rb") as file:
            if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                raise ConfigError((f"{path}: is not a regular file",))
            content = file.read(largest + 1)
    except FileNotFoundError:
        raise ConfigError((f"{path}: there is no such file",)) from None
    except IsADirectoryError:
        raise ConfigError((f"{path}: is a directory; a file is wanted",)) from None
    except ValueError:
        raise ConfigError((f"{quoted(str(path), 200)}: is not the name of a file",)) from None
    except OSError as error:
        raise ConfigError((f"{path}: cannot be read: {error.strerror}",)) from None
    if len(content) > largest:
        raise ConfigError((f"{path}: is larger than {largest // 1024} KiB; is it the file that you mean?",))
    return content


def read_text(path: Path, largest: int) -> str:
    """The text of a file in UTF-8, with or without a byte order mark; ConfigError as in `read_bytes`."""
    try:
        return read_bytes(path, largest).decode("utf-8-sig")
    except UnicodeDecodeError:
        raise ConfigError((f"{path}: is not UTF-8 text; save it as UTF-8",)) from None


def check_writable(path: Path) -> None:
    """Raise ConfigError if a file cannot be written, before minutes of work; makes a new one."""
    try:
        os.close(os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT | AT_ONCE, 0o666))
    except ValueError:
        raise ConfigError((f"{quoted(str(path), 200)}: is not the name of a file",)) from None
    except OSError as error:
        raise ConfigError((f"{path}: cannot be written: {error.strerror}",)) from None


def check_new(path: Path) -> None:
    """Raise ConfigError if a file exists or cannot be made, before minutes of work."""
    if path.exists():
        raise ConfigError((f"{path}: is there already; name another file",))
    check_writable(path)
    path.unlink()


def broker_users(path: Path) -> dict[str, str]:
    """Passwords by user from lines `NAME:PASSWORD`; ConfigError with every problem, never with a password."""
    lines = read_text(path, LARGEST).splitlines()
    users: dict[str, str] = {}
    problems = []
    for number, line in enumerate(lines, start=1):
        if not line.strip() or line.startswith("#"):
            continue
        name, _, password = line.partition(":")
        if not (name.strip() and password):
            problems.append(f"{path}:{number}:1: must be NAME:PASSWORD, neither of them empty")
        elif name.strip() in users:
            problems.append(f"{path}:{number}:1: the user {shown(name.strip())} is there twice")
        users[name.strip()] = password
    if not users:
        problems.append(f"{path}: names no user; write lines of NAME:PASSWORD")
    if problems:
        raise ConfigError(tuple(problems))
    return users
