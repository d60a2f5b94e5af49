"""Who leads a plant, as others say it; who is to stand by is told which package that needs."""

from __future__ import annotations

import socket
from pathlib import Path

import pytest
from tests.packages import leave_out

from arboleda.model.errors import StartError
from arboleda.runtime.leader import LeaderInfo, leader_row, of_standby
from arboleda.runtime.options import Options
from arboleda.runtime.standing_by import take_over
from arboleda.runtime.web_options import WebOptions
from arboleda.testing import shipped

LED = LeaderInfo(plant="demo", host="host-a", process=7, url="http://10.0.0.5:8080", epoch=3)


def led(host: str, url: str) -> LeaderInfo:
    return LeaderInfo(plant="demo", host=host, process=7, url=url, epoch=3)


@pytest.mark.parametrize(
    "url", ["http://127.0.0.1:8080", "http://127.3.0.1", "http://localhost:8080", "https://[::1]:9"]
)
def test_the_address_of_one_machine_leads_there_from_that_machine_alone(url: str) -> None:
    assert (led("host-a", url).is_far, led("host-a", url).way) == (True, "")
    assert (led(socket.gethostname(), url).is_far, led(socket.gethostname(), url).way) == (False, url)


@pytest.mark.parametrize("url", ["http://10.0.0.5:8080", "https://plant.lab", "http://[fd00::1]:8080"])
def test_other_addresses_lead_there_from_everywhere(url: str) -> None:
    assert led("host-a", url).way == url


def test_what_a_standby_says_is_read_as_it_was_known() -> None:
    assert of_standby({"plant": "demo", **leader_row(LED)}) == LED


@pytest.mark.parametrize(
    "said",
    [
        {},
        leader_row(None),
        {"leader": "javascript:alert(1)", "host": "a\x1b[2J", "process": "7", "epoch": None},
        {"leader": "http://user:word@a/x"},
        {"leader": ["http://a"]},
    ],
)
def test_what_is_no_address_counts_as_none(said: dict[str, object]) -> None:
    read = of_standby(said)
    assert (read.url, read.way, read.process, read.epoch) == ("", "", 0, 0)
    assert read.host.isprintable()


@pytest.mark.parametrize(
    ("options", "own", "origin"),
    [
        ({}, "10.0.0.5", "http://127.0.0.1:8090"),
        ({"host": "10.0.0.7"}, "10.0.0.5", "http://10.0.0.7:8090"),
        ({"host": "0.0.0.0"}, "10.0.0.5", "http://10.0.0.5:8090"),
        ({"host": "0.0.0.0"}, "", "http://127.0.0.1:8090"),
        ({"host": "::"}, "fd00::5", "http://[fd00::5]:8090"),
        ({"host": "0.0.0.0", "public_url": "https://plant.lab"}, "10.0.0.5", "https://plant.lab"),
    ],
)
def test_a_server_on_every_network_is_reached_at_the_address_of_its_host(
    options: dict[str, str], own: str, origin: str
) -> None:
    assert WebOptions(**options).origin(8090, lambda: own) == origin


def test_standing_by_without_its_package_is_refused_with_the_line_that_installs_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    leave_out(monkeypatch, tmp_path, "arboleda_fleet")
    model = shipped("sis_a")
    with pytest.raises(StartError, match=r"needs the package fleet.*: type pip install 'arboleda\[fleet\]'"):
        take_over(model, {"orchestrator"}, Options(), print, lambda: (model, None))
