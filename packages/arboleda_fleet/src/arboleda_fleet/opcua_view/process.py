"""The process that serves a plant over OPC UA, read only. Values come in on its standard input, a line of
JSON for each cell; only that it listens goes out on its standard output. It ends where its input does.

It is a process of its own so that whatever clients send, and however much of it, takes neither the
interpreter nor the memory of the plant.
"""

from __future__ import annotations

import asyncio
import json
import os
import signal
import sys
from collections.abc import Mapping, Sequence
from datetime import timezone
from typing import Any, cast

from asyncua import Server, ua
from asyncua.crypto.permission_rules import PermissionRuleset, SimpleRoleRuleset, User, UserRole
from asyncua.server.internal_server import InternalServer
from asyncua.server.user_managers import UserManager

from arboleda.host.limits import give_way, limit_memory

MEMORY_BYTES = 1 << 30  # limit of memory: filling it ends this process, not the machine
LINE_BYTES = 1 << 22
NICE = 10  # the plant goes first
NAMESPACE = "urn:arboleda:plant"
ALLOWED = (
    "FindServers",
    "GetEndpoints",
    "CreateSession",
    "ActivateSession",
    "CloseSession",
    "CloseSecureChannel",
    "Read",
    "Browse",
    "TranslateBrowsePathsToNodeIds",
    "RegisterNodes",
    "UnregisterNodes",
    "CreateSubscription",
    "ModifySubscription",
    "DeleteSubscriptions",
    "SetPublishingMode",
    "Publish",
    "Republish",
    "CreateMonitoredItems",
    "ModifyMonitoredItems",
    "DeleteMonitoredItems",
    "SetMonitoringMode",
)
"""The services that look; no other one is carried out: no Write, no Call, no change of nodes."""


class Readers(PermissionRuleset):
    """Rule that whoever comes may look, and do nothing else."""

    def __init__(self) -> None:
        names = [f"{name}Request_Encoding_DefaultBinary" for name in ALLOWED]
        self._allowed = {ua.NodeId(getattr(ua.ObjectIds, name)) for name in names}

    def check_validity(self, user: User, action_type_id: ua.NodeId, body: object) -> bool:
        """True for a service that looks."""
        return action_type_id in self._allowed


class Anybody(UserManager):
    """Users: everybody is one without rights, whatever name is given."""

    def get_user(self, *_: object, **__: object) -> User:
        return User(role=UserRole.User)


class Alone(InternalServer):
    """Server that keeps no list of others: asyncua asks no rule before it takes one into it."""

    def register_server(self, server: object, conf: object = None) -> None:
        raise ua.uaerrors.BadUserAccessDenied


class View:
    """Address space of a plant: folders by their names, then its cells, then their variables."""

    def __init__(self, server: Server, plant: str, folders: Sequence[str]) -> None:
        self._server, self._path = server, [*folders, plant]
        self._known: set[tuple[str, ...]] = set()
        self._shown: dict[str, dict[tuple[str, ...], str]] = {}  # by cell: paths with their types
        self._index = 2

    async def prepare(self) -> None:
        """Make the folders down to the plant."""
        self._index = await self._server.register_namespace(NAMESPACE)
        await self._object(tuple(self._path))

    async def show(self, cell: str, at_us: int, tags: Sequence[tuple[list[str], str, Any]]) -> None:
        """Set the variables of a cell; those that are new are made, those that are gone have no value."""
        at = ua.DateTime.fromtimestamp(at_us / 1e6, timezone.utc)
        before, now = self._shown.get(cell, {}), {tuple(path): type for path, type, _ in tags}
        self._shown[cell] = before | now
        for path, type, value in tags:
            await self._set((*self._path, cell, *path), type, value, at)
        for gone, type in before.items():
            if gone not in now:
                await self._set((*self._path, cell, *gone), type, None, at)

    async def _set(self, path: tuple[str, ...], type: str, value: Any, at: ua.DateTime) -> None:
        kind = getattr(ua.VariantType, type)
        if path not in self._known:
            parent = await self._object(path[:-1])
            first = {"String": "", "Boolean": False, "Double": 0.0}.get(type, 0)
            await parent.add_variable(self._id(path), self._name(path), first, kind)
            self._known.add(path)
        if value is None:
            data = ua.DataValue(
                StatusCode=ua.StatusCode(ua.UInt32(ua.StatusCodes.BadNoData)), SourceTimestamp=at
            )
        else:
            data = ua.DataValue(ua.Variant(value, kind), SourceTimestamp=at)
        await self._server.write_attribute_value(self._id(path), data)

    async def _object(self, path: tuple[str, ...]) -> Any:
        """The node of a folder or of an object, made with all above it."""
        if not path:
            return self._server.nodes.objects
        if path not in self._known:
            parent = await self._object(path[:-1])
            made = parent.add_folder if len(path) < len(self._path) else parent.add_object
            await made(self._id(path), self._name(path))
            self._known.add(path)
        return self._server.get_node(self._id(path))

    def _id(self, path: tuple[str, ...]) -> ua.NodeId:
        return ua.NodeId(ua.String("/".join(path)), ua.Int16(self._index))

    def _name(self, path: tuple[str, ...]) -> ua.QualifiedName:
        return ua.QualifiedName(path[-1], self._index)


async def serve(host: str, port: int, plant: str, folders: Sequence[str]) -> None:
    """Listen, say so, and show what comes until there is nothing more to come."""
    server = Server(iserver=Alone(user_manager=Anybody()))
    server.name, server.manufacturer_name = f"Arboleda: {plant}", "Arboleda"
    await server.init()
    await server.set_application_uri(f"{NAMESPACE}:{plant}")
    server.set_endpoint(f"opc.tcp://{f'[{host}]' if ':' in host else host}:{port}/")
    rules = cast(SimpleRoleRuleset, Readers())  # asyncua takes any rule, and names only its own
    server.set_security_policy([ua.SecurityPolicyType.NoSecurity], permission_ruleset=rules)
    server.set_identity_tokens([ua.AnonymousIdentityToken])
    view = View(server, plant, folders)
    await view.prepare()
    try:
        await server.start()
    except OSError as error:
        say({"error": f"cannot listen on {host}, port {port}: {error.strerror}"})
        return
    say({"port": port})
    lines = asyncio.StreamReader(limit=LINE_BYTES)
    loop = asyncio.get_running_loop()
    await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(lines), sys.stdin)
    while line := await lines.readline():
        news: Mapping[str, Any] = json.loads(line)
        await view.show(news["cell"], news["at_us"], news["tags"])


def main(host: str, port: int, plant: str, folders: Sequence[str]) -> None:
    """Print that it listens, or the reason why it does not; then serve."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C ends the plant, which ends this
    limit_memory(MEMORY_BYTES)
    give_way(NICE)
    asyncio.run(serve(host, port, plant, folders))
    os._exit(0)  # sessions are not waited for


def say(what: dict[str, Any]) -> None:
    """Print a line of JSON for the plant."""
    print(json.dumps(what), flush=True)
