"""Names that the editor Groot2, and BehaviorTree.CPP from 4.8 on, refuse."""

from __future__ import annotations

FORBIDDEN = frozenset(" \t\n\r<>&\"'/\\:*?|.")
PRE = ("_failureIf", "_successIf", "_skipIf", "_while")
POST = ("_onHalted", "_onFailure", "_onSuccess", "_post")
SCRIPTS = (*PRE, *POST)
RESERVED = ("name", "ID", "_autoremap", *SCRIPTS)


def of_node(name: str) -> str | None:
    """The reason why a kind of node or a tree cannot have this name; None if it can."""
    if name in ("Root", "root"):
        return "this name is reserved"
    return _letters(name)


def of_port(name: str) -> str | None:
    """The reason why a port cannot have this name; None if it can."""
    if name[:1].isdigit():
        return "it begins with a digit"
    return "this name is reserved" if name in RESERVED else _letters(name)


def of_one_node(name: str) -> str | None:
    """The reason why the attribute `name` of a node cannot be this; None if it can."""
    wrong = next((each for each in name if _is_control(each) and each not in "\t\n\r"), None)
    return None if wrong is None else f"it has the control character {ord(wrong)}"


def _letters(name: str) -> str | None:
    if not name:
        return "it is empty"
    wrong = next((each for each in name if each in FORBIDDEN or _is_control(each)), None)
    return None if wrong is None else f"Groot2 takes no {wrong!r} in it"


def _is_control(letter: str) -> bool:
    return ord(letter) < 32 or ord(letter) == 127
