"""Which hosts and origins are ours."""

from __future__ import annotations

import pytest

from arboleda.model.errors import StartError
from arboleda.web.access.names import (
    is_address,
    is_loopback,
    listen_address,
    names_for,
    public_origin,
    url_host,
)


@pytest.mark.parametrize(("host", "near"), [("127.0.0.1", True), ("127.9.9.9", True), ("::1", True)])
def test_loopback(host: str, near: bool) -> None:
    assert is_loopback(host) is near


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5"])
def test_networks(host: str) -> None:
    assert not is_loopback(host)


@pytest.mark.parametrize("host", ["", "plant.example", "127.1", "0.0.0.0:80", "1.2.3.4/24", "fe80::1%eth0"])
def test_what_is_no_address_to_listen_on_is_refused(host: str) -> None:
    with pytest.raises(StartError, match="is not an address to listen on"):
        listen_address(host)


@pytest.mark.parametrize(
    ("host", "address"),
    [
        ("localhost", "127.0.0.1"),
        ("[::1]", "::1"),
        ("0::1", "::1"),
        ("0:0::0", "::"),
        ("10.0.0.1", "10.0.0.1"),
    ],
)
def test_an_address_is_written_in_its_usual_spelling(host: str, address: str) -> None:
    assert listen_address(host) == address


@pytest.mark.parametrize("host", ["127.0.0.1", "127.0.0.2", "::1", "0.0.0.0", "::", "192.168.1.5", "fd00::2"])
def test_a_server_is_called_as_this_machine_reaches_it(host: str) -> None:
    assert names_for(host, None).knows_host(f"{url_host(host)}:8080")


def test_another_address_of_this_machine_is_not_the_one_it_listens_on() -> None:
    assert not names_for("127.0.0.1", None).knows_host("127.0.0.2:8080")


@pytest.mark.parametrize(
    ("url", "origin"),
    [
        ("https://Plant.Example", "https://plant.example"),
        ("https://plant.example/", "https://plant.example"),
        ("https://plant.example:443", "https://plant.example"),
        ("http://plant.lan:8080", "http://plant.lan:8080"),
        ("https://[2001:db8::1]:8443", "https://[2001:db8::1]:8443"),
    ],
)
def test_a_public_url_is_an_origin(url: str, origin: str) -> None:
    assert public_origin(url) == origin


@pytest.mark.parametrize(
    "url",
    ["", "plant.example", "ftp://a", "https://", "https://a/b", "https://u@a", "https://a?b", "https://a b"],
)
def test_more_or_less_than_an_origin_is_refused(url: str) -> None:
    with pytest.raises(StartError, match="is not the address of a plant"):
        public_origin(url)


def test_a_public_name_counts_under_its_own_scheme_only() -> None:
    names = names_for("0.0.0.0", "https://plant.example")
    assert names.knows_host("plant.example") and names.knows_host("10.0.0.1:8080")
    assert names.knows_origin("https://plant.example", "plant.example")
    assert not names.knows_origin("http://plant.example", "plant.example")
    assert names.knows_origin("http://10.0.0.1:8080", "10.0.0.1:8080")
    assert not names.knows_origin("http://10.0.0.1", "10.0.0.1:8080")


def test_on_one_machine_only_its_own_names_are_known() -> None:
    names = names_for("127.0.0.1", None)
    assert names.knows_host("LOCALHOST:1") and names.knows_host("[::1]")
    assert not names.knows_host("192.168.1.5") and not names.knows_host("")


@pytest.mark.parametrize("name", ["1.2.3.4", "[::1]", "[fe80::1]"])
def test_addresses(name: str) -> None:
    assert is_address(name)


@pytest.mark.parametrize(
    "name", ["1.2.3", "01.2.3.4", "::1", "[1.2.3.4]", "[0::1]", "[::1%eth0]", "\u0661.2.3.4"]
)
def test_other_spellings_are_none(name: str) -> None:
    assert not is_address(name)


def test_a_page_in_clear_is_no_page_of_a_server_with_tls() -> None:
    names = names_for("127.0.0.1", None, scheme="https")
    assert names.knows_origin("https://127.0.0.1:8080", "127.0.0.1:8080")
    assert not names.knows_origin("http://127.0.0.1:8080", "127.0.0.1:8080")
