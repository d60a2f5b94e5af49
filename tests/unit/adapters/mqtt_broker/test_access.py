"""Who comes in, and how much each may have."""

from __future__ import annotations

import pytest

from arboleda.adapters.mqtt_broker.access import Access, ClientIdentity, Role
from arboleda.adapters.mqtt_broker.limits import Bucket

USERS = {"ra_1": "one", "ana": "look"}


def access(*, guests: bool = False) -> Access:
    return Access(
        plant=("arboleda", "secret"),
        passwords={} if guests else USERS,
        boards=frozenset({"ra_1"}),
        guests=guests,
    )


@pytest.mark.parametrize(
    ("user", "password", "role"),
    [("arboleda", b"secret", Role.PLANT), ("ra_1", b"one", Role.BOARD), ("ana", b"look", Role.READER)],
)
def test_each_user_has_a_role(user: str, password: bytes, role: Role) -> None:
    assert access().login(user, password) == ClientIdentity(role=role, user=user)


@pytest.mark.parametrize(
    ("user", "password"),
    [
        (None, None),
        (None, b""),
        ("", b""),
        ("arboleda", None),
        ("arboleda", b"one"),
        ("ra_1", b"look"),
        ("x", b""),
    ],
)
def test_strangers_are_nobody(user: str | None, password: bytes | None) -> None:
    assert access().login(user, password) is None


def test_where_nobody_needs_a_password_only_the_plant_itself_is_the_plant() -> None:
    open_door = access(guests=True)
    assert open_door.login("arboleda", b"secret") == ClientIdentity(role=Role.PLANT, user="arboleda")
    for user, password in ((None, None), ("arboleda", b"guess"), ("ra_1", b"x")):
        assert open_door.login(user, password) == ClientIdentity(role=Role.GUEST)


def test_a_bucket_gives_a_seconds_worth_at_once_and_then_its_rate() -> None:
    bucket = Bucket(10.0, now=0.0)
    assert [bucket.take(1.0, now=0.0) for _ in range(10)] == [0.0] * 10
    assert bucket.take(1.0, now=0.0) == pytest.approx(0.1)
    assert bucket.take(1.0, now=5.0) == 0.0
    assert bucket.take(29.0, now=5.0) == pytest.approx(2.0)
