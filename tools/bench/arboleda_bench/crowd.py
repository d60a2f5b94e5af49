"""A crowd in front of a plant's web server: 25 browsers at once, again and again, and readers.

A process of its own, started by `stop`. It says `ready` once every reader has its first answer, and then, for
each line that it is handed, how many pages were opened and how many answers were read so far.
"""

from __future__ import annotations

import asyncio
import re
import sys
from collections import Counter
from contextlib import suppress
from itertools import count
from typing import Any

from websockets.asyncio.client import connect
from websockets.exceptions import WebSocketException
from websockets.typing import Origin

PAGES = 25  # at once
STREAMS, LOOKERS = 10, 4
ROUND_S = 0.5
PATIENCE_S = 5.0
CLIENT = re.compile(rb"'client_id': '([^']+)'")
TAB = "00000000-0000-4000-8000-000000000000"


class Crowd:
    """Opens pages, streams and views of the plant at a port of this machine; `done` counts them.

    Each page comes from an address of its own, as the server limits how often one may open it.
    """

    def __init__(self, port: int) -> None:
        self._port = port
        self._numbers = count()
        self.done: Counter[str] = Counter()

    async def run(self) -> None:
        readers = [asyncio.create_task(self._stream()) for _ in range(STREAMS)]
        readers += [asyncio.create_task(self._look()) for _ in range(LOOKERS)]
        opening = asyncio.create_task(self._open_pages())
        await self._answer()
        for task in (*readers, opening):
            task.cancel()

    async def _answer(self) -> None:
        while self.done["streams"] < STREAMS or not self.done["pages"]:
            await asyncio.sleep(0.05)
        print("ready", flush=True)
        lines = asyncio.StreamReader()
        loop = asyncio.get_running_loop()
        await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(lines), sys.stdin)
        while await lines.readline():
            print(self.done["pages"], self.done["views"], flush=True)

    async def _open_pages(self) -> None:
        while True:
            await asyncio.gather(*(self._page() for _ in range(PAGES)), asyncio.sleep(ROUND_S))

    async def _page(self) -> None:
        """Open a page as a browser does: its HTML, its socket, and the first frame over that."""
        number = next(self._numbers) % 250
        with suppress(OSError, WebSocketException, asyncio.TimeoutError):
            html = await self._got("/", f"127.0.0.{number + 2}")
            found = CLIENT.search(html)
            if found is None:
                self.done["refused"] += 1
                return
            await self._first_frame(found[1].decode())
            self.done["pages"] += 1

    async def _first_frame(self, client: str) -> None:
        """Read the page's socket up to the plant's first frame, after the greetings."""
        query = f"client_id={client}&document_id={TAB}&tab_id={TAB}&next_message_id=0&implicit_handshake=true"
        address = f"ws://127.0.0.1:{self._port}/_nicegui_ws/socket.io/?EIO=4&transport=websocket&{query}"
        async with connect(
            address, origin=Origin(f"http://127.0.0.1:{self._port}"), compression=None
        ) as socket:
            await socket.recv()
            await socket.send("40")
            while b"arboleda.live" not in (await asyncio.wait_for(socket.recv(decode=False), PATIENCE_S)):
                pass

    async def _stream(self) -> None:
        reader, writer = await self._open("/api/events", "127.0.0.1")
        await reader.readuntil(b"\n\n")
        self.done["streams"] += 1
        while await reader.read(65536):
            pass
        writer.close()

    async def _look(self) -> None:
        while True:
            await self._got("/api/plant", "127.0.0.1")
            self.done["views"] += 1
            await asyncio.sleep(0.1)

    async def _got(self, path: str, address: str) -> bytes:
        reader, writer = await self._open(path, address)
        try:
            return bytes(await reader.read())
        finally:
            writer.close()

    async def _open(self, path: str, address: str) -> tuple[Any, Any]:
        reader, writer = await asyncio.open_connection(
            "127.0.0.1", self._port, local_addr=(address, 0), limit=2**24
        )
        head = f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{self._port}\r\nConnection: close\r\n\r\n"
        writer.write(head.encode())
        return reader, writer


if __name__ == "__main__":
    asyncio.run(Crowd(int(sys.argv[1])).run())
