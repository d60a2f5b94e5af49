"""The client of the commands over real connections."""

from __future__ import annotations

import socket
import threading
from pathlib import Path

import pytest
from tests.web_plant import QUEUED, VIEW, Plant

from arboleda.cli.client import PlantClient
from arboleda.client import NoAnswer
from arboleda.runtime.state import StateDir

from .conftest import Web


def test_the_client_submits_and_looks_whatever_proxy_there_is(
    local: Web, plant: Plant, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("http_proxy", "http://127.0.0.1:9")
    with StateDir(tmp_path) as made:
        made.announce(local.port)
        client = PlantClient(tmp_path)
        assert client.submit("sis_a 0B 7") == QUEUED
        assert client.status() == VIEW and client.task("t-1") == QUEUED
    assert (plant.texts, plant.asked_by) == (["sis_a 0B 7"], ["command"])


def test_a_process_that_cuts_a_connection_has_not_answered(tmp_path: Path) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener, StateDir(tmp_path) as made:
        cutting = threading.Thread(target=lambda: listener.accept()[0].close())
        cutting.start()
        made.announce(listener.getsockname()[1])
        with pytest.raises(NoAnswer, match=r"did not answer\.") as silent:
            PlantClient(tmp_path).submit("sis_a 0B 7")
        cutting.join()
    assert silent.value.may_have_heard
