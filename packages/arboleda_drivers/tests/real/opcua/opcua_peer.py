"""A server of OPC UA as anybody writes it with asyncua, in a process of its own; nothing of Arboleda in it.

Arguments: port, a file that keeps the nodes which every server has, then optionally the files of a
certificate and a key: with them it wants Sign or Sign & Encrypt, and the user "cell" with the password
"secret". Its method Load is done at once, Advance takes 5 s to return, Scan and Halt refuse. A line on its
input is "sessions", which ends every session and leaves the connections, or the new place of the part.
"""

import asyncio
import sys
from pathlib import Path

from asyncua import Server, ua
from asyncua.crypto.permission_rules import SimpleRoleRuleset
from asyncua.server.internal_server import InternalServer
from asyncua.server.user_managers import User, UserRole


class Users:
    def get_user(self, iserver, username=None, password=None, certificate=None):
        return User(role=UserRole.User) if (username, password) == ("cell", "secret") else None


class Sessions(InternalServer):
    """It knows who is there, and sends everybody away."""

    def __init__(self, **given):
        super().__init__(**given)
        self.open = []

    def register_external_session(self, session):
        super().register_external_session(session)
        self.open.append(session)

    async def end(self):
        while self.open:
            await self.open.pop().close_session()


ADVANCE_S = 3600.0  # nobody waits for it


async def main(port, shelf, files):
    sessions = Sessions(user_manager=Users() if files else None)
    server = Server(iserver=sessions)
    await server.init(shelf)
    server.set_endpoint(f"opc.tcp://127.0.0.1:{port}/")
    kind = ua.SecurityPolicyType
    safe = [kind.Basic256Sha256_Sign, kind.Basic256Sha256_SignAndEncrypt]
    server.set_security_policy(safe if files else [kind.NoSecurity], SimpleRoleRuleset() if files else None)
    if files:
        await server.load_certificate(files[0])
        await server.load_private_key(files[1])
    await server.register_namespace("urn:peer")
    belt = await server.nodes.objects.add_object(ua.NodeId("Device", 2), ua.QualifiedName("Device", 2))
    names = ("part_at", "gate", "mm_s", "seen", "boot", "state", "accepted", "done", "rejected", "failed")
    held = {}
    for name in (*names, "reason", "failure"):
        place = (ua.NodeId(name, 2), ua.QualifiedName(name, 2))
        held[name] = await belt.add_variable(*place, 0, ua.VariantType.UInt16)

    async def put(name, value):
        await held[name].write_value(ua.Variant(value, ua.VariantType.UInt16))

    async def load(parent, number):
        await put("accepted", number.Value)
        await put("part_at", 1)
        await put("done", number.Value)
        return []

    async def advance(parent, to, speed, number):
        await asyncio.sleep(ADVANCE_S)
        return []

    async def scan(parent, number):
        await asyncio.sleep(0.05)
        return ua.StatusCode(ua.StatusCodes.BadInvalidState)

    async def halt(parent):
        return ua.StatusCode(ua.StatusCodes.BadUserAccessDenied)

    methods = (("Load", load, 1), ("Advance", advance, 3), ("Scan", scan, 1), ("Halt", halt, 0))
    for name, method, count in methods:
        place = (ua.NodeId(name, 2), ua.QualifiedName(name, 2))
        await belt.add_method(*place, method, [ua.VariantType.UInt16] * count, [])

    spoilt = {
        "null": ua.DataValue(ua.Variant(None, ua.VariantType.Null)),
        "list": ua.DataValue(ua.Variant([1, 1], ua.VariantType.UInt16)),
        "bad": ua.DataValue(StatusCode=ua.StatusCode(ua.StatusCodes.BadSensorFailure)),
        "uncertain": ua.DataValue(
            ua.Variant(1, ua.VariantType.UInt16), ua.StatusCode(ua.StatusCodes.UncertainLastUsableValue)
        ),
        "none": ua.DataValue(ua.Variant(0, ua.VariantType.UInt16)),
    }
    async with server:
        print("ready", server.bserver.port, flush=True)
        while line := (await asyncio.to_thread(sys.stdin.readline)).strip():
            place = held["part_at"].nodeid
            if line == "sessions":
                await sessions.end()
            elif line == "none":
                await server.write_attribute_value(place, spoilt[line])
            else:  # another type would not be written
                server.set_attribute_value_callback(place, lambda node, attribute, line=line: spoilt[line])


asyncio.run(main(int(sys.argv[1]), Path(sys.argv[2]), sys.argv[3:]))
