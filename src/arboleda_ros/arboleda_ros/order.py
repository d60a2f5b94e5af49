"""Text of a device's topic `order`: a verb with its values, or a stop, with the id of the command.

`{"id": "7-1", "verb": "run", "values": {"program": 1001}, "heard": 512, "token": "0a3f9x001201"}`,
`{"id": "7-2", "stop": 2}`.
A command without an id is foreign. All commands of a device go on this one topic, so that no stop overtakes
the command that it ends.
"""

from __future__ import annotations

from dataclasses import replace

from arboleda.drivers import Command, Device, PayloadError, Stop, StopMode, UseError, VerbCommand
from arboleda.wire import strict
from arboleda.wire.status import command_id


def write(command: Command, *, copied: bool = False) -> str:
    """The text of a command; `copied`: a copy without the id comes on the plain topic."""
    fields: dict[str, object] = {"id": command.id} if command.id else {}
    if isinstance(command, VerbCommand):
        fields |= {"verb": command.verb, "values": dict(command.values)}
        fields |= {} if command.heard is None else {"heard": command.heard}
        fields |= {} if command.token is None else {"token": command.token}
    elif isinstance(command, Stop):
        fields |= {"stop": int(command.mode)}
    else:
        raise TypeError(f"{type(command).__name__} is no command of a device")
    text = fields | ({"copied": 1} if copied else {})
    # Escapes could make the text longer than a message to a board may be. Only half a pair of surrogates,
    # which is no letter, stays an escape.
    return strict.to_json(text).encode(errors="backslashreplace").decode()


def read(device: Device, text: str) -> tuple[Command, bool]:
    """The command in a text, its id "" if it has none, and True if a copy comes; raises PayloadError."""
    fields = strict.read(text.encode())
    id = fields.matching("id", command_id) if "id" in fields else ""
    copied = fields.flag("copied") is True
    if "stop" in fields:
        fields.refuse("a stop", "verb", "values")
        return Stop(id=id, robot=device.name, mode=StopMode(fields.integer("stop", 2))), copied
    verb, values = fields.name("verb"), dict(fields.facts("values") or ())
    try:
        command = device.kind.command(id=id, robot=device.name, verb=verb, values=values)
    except UseError as error:
        raise PayloadError(str(error)) from error
    return replace(command, heard=fields.optional("heard"), token=fields.token("token")), False
