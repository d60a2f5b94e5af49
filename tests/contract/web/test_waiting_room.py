"""The server of a process that stands by."""

from __future__ import annotations

from pathlib import Path

import httpx
from tests.patience import PATIENCE_S

from arboleda.runtime.standby.leader import LeaderInfo
from arboleda.runtime.standby.waiting_room import WaitingRoom
from arboleda.runtime.web_options import WebOptions


def test_a_client_at_the_announced_port_is_sent_on_to_the_leader(tmp_path: Path) -> None:
    announced: list[int] = []
    room = WaitingRoom("demo", tmp_path, WebOptions(port=0))
    room.start(lambda port, **_: announced.append(port))
    try:
        room.show(
            "waits", LeaderInfo(plant="demo", host="host-a", process=7, url="http://10.0.0.5:8080", epoch=3)
        )
        with httpx.Client(base_url=room.url, trust_env=False, timeout=PATIENCE_S) as client:
            assert client.get("/api/plant").json()["standby"] is True
            sent = client.post("/api/cells/a%2Fb%20c/hold?x=1&y=%C3%A9")
    finally:
        room.stop()
    assert (sent.status_code, announced) == (307, [room.port])
    assert sent.headers["location"] == "http://10.0.0.5:8080/api/cells/a%2Fb%20c/hold?x=1&y=%C3%A9"
