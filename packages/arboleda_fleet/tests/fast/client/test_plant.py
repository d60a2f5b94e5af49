"""A client follows from a standby to the leader."""

from __future__ import annotations

from pathlib import Path
from socket import gethostname

import pytest
from tests.guarded_plant import guarded
from tests.in_process import ORIGIN, Machine
from tests.in_process import machine as machine
from tests.unit.client.test_plant import client as client
from tests.web_plant import Plant
from tests.web_plant import plant as plant

from arboleda.client import (
    NoAnswer,
)
from arboleda.client import Plant as Client
from arboleda.runtime.leader import LeaderInfo
from arboleda.runtime.web_options import WebOptions
from arboleda_fleet.standby.waiting_room import WaitingRoom


def test_a_leader_that_a_standby_names_is_followed(machine: Machine, plant: Plant, tmp_path: Path) -> None:
    led = LeaderInfo(plant="demo", host=gethostname(), process=7, url="http://127.0.0.1:8081", epoch=7)
    room = WaitingRoom("demo", tmp_path, WebOptions(port=8080))
    room.show("waits for its end", led)
    machine.listen(8080, room.app)
    machine.listen(8081, guarded(plant).app)
    client = Client(ORIGIN, patience_s=0.0)
    assert client.submit("sis_a 0B 7").state == "queued" and client.stop().verb == "stop"
    assert machine.asked == [8080, 8081, 8081]
    room.show("begins to wait", None)
    with pytest.raises(NoAnswer, match="it begins to wait"):
        Client(ORIGIN, patience_s=0.0).submit("sis_a 0B 7")
    assert len(plant.texts) == 1
