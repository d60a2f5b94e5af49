"""`arboleda certs`: what it makes, what it leaves alone, and who believes it in a handshake in memory."""

from __future__ import annotations

import builtins
import ssl
import stat
import sys
from datetime import datetime, timedelta, timezone
from pathlib import Path
from typing import Any

import pytest

from arboleda.cli import main

pytestmark = pytest.mark.requires("cryptography")
ADDRESSES = ["127.0.0.1", "192.0.2.7"]  # of this machine


@pytest.fixture
def certs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Any:
    """`certs("--name", "mill.lab")`: exit status, and what was printed."""

    monkeypatch.setattr("arboleda.cli.certs.own_addresses", lambda: ADDRESSES)

    def run(*words: str) -> tuple[int, str]:
        monkeypatch.setattr(sys, "argv", ["arboleda", "certs", str(tmp_path / "lab"), *words])
        with pytest.raises(SystemExit) as ended:
            main.main()
        said = capsys.readouterr()
        return ended.value.code or 0, said.out + said.err

    return run


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    return tmp_path / "lab"


def contents(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def talk(server: tuple[Path, Path], client: tuple[Path, Path] | None, authority: Path, name: str) -> None:
    """A whole handshake in memory, both sides strict; ssl.SSLError where one does not believe the other."""
    ours = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH, cafile=authority)
    ours.load_cert_chain(*server)
    ours.verify_mode = ssl.CERT_REQUIRED if client else ssl.CERT_NONE
    theirs = ssl.create_default_context(cafile=authority)
    for context in (ours, theirs):
        context.verify_flags |= ssl.VERIFY_X509_STRICT
    if client:
        theirs.load_cert_chain(*client)
    up, down = ssl.MemoryBIO(), ssl.MemoryBIO()
    ends = [ours.wrap_bio(up, down, server_side=True), theirs.wrap_bio(down, up, server_hostname=name)]
    for _ in range(4):
        for end in reversed(ends):
            try:
                end.do_handshake()
            except ssl.SSLWantReadError:
                continue
    ends[1].write(b"hello")
    assert ends[0].read(5) == b"hello"


def pair(folder: Path, name: str) -> tuple[Path, Path]:
    return folder / f"{name}.crt", folder / f"{name}.key"


def test_the_plant_and_each_board_get_one_that_the_others_believe(certs: Any, lab: Path) -> None:
    status, said = certs("--name", "mill.lab", "--name", "10.9.8.7")
    assert status == 0 and f"{lab}/boards/ra_1.crt  made, until " in said
    assert {path.stem for path in (lab / "boards").glob("*.crt")} >= {"ra_1", "rm_sis_a", "ra_3"}
    for name in ("mill.lab", "10.9.8.7", "localhost", *ADDRESSES):
        talk(pair(lab, "plant"), pair(lab / "boards", "ra_1"), lab / "ca.crt", name)
    with pytest.raises(ssl.SSLCertVerificationError, match="ostname mismatch"):
        talk(pair(lab, "plant"), None, lab / "ca.crt", "pump.lab")


def test_a_boards_certificate_is_no_servers(certs: Any, lab: Path) -> None:
    certs()
    with pytest.raises(ssl.SSLCertVerificationError, match="purpose"):
        talk(pair(lab / "boards", "ra_1"), None, lab / "ca.crt", "ra_1")


def test_keys_are_for_their_owner_only(certs: Any, lab: Path) -> None:
    certs()
    modes = {stat.S_IMODE(path.stat().st_mode) for path in lab.rglob("*.key")}
    assert modes == {0o600} and stat.S_IMODE(lab.stat().st_mode) == 0o700


def test_a_second_time_everything_stays_as_it_is(certs: Any, lab: Path) -> None:
    certs()
    before = contents(lab)
    status, said = certs()
    assert status == 0 and contents(lab) == before
    assert "  made" not in said and f"{lab}/plant.crt  was there, until " in said


def test_a_board_that_came_since_gets_its_own_of_the_same_authority(certs: Any, lab: Path) -> None:
    certs()
    for each in pair(lab / "boards", "ra_2"):
        each.unlink()
    before = contents(lab)
    certs()
    assert {name for name in contents(lab) if contents(lab)[name] != before.get(name)} == {
        "boards/ra_2.crt",
        "boards/ra_2.key",
    }
    talk(pair(lab, "plant"), pair(lab / "boards", "ra_2"), lab / "ca.crt", "localhost")


def test_only_what_is_named_is_made_anew(certs: Any, lab: Path) -> None:
    certs()
    before = contents(lab)
    assert certs("--renew", "ra_1")[0] == 0
    now = contents(lab)
    assert {name for name in now if now[name] != before[name]} == {"boards/ra_1.crt", "boards/ra_1.key"}


def test_a_name_that_is_missing_is_not_added_silently(certs: Any, lab: Path) -> None:
    certs()
    before = contents(lab)
    status, said = certs("--name", "mill.lab")
    assert status == 1 and "does not have 'mill.lab'; --renew plant makes it anew" in " ".join(said.split())
    assert contents(lab) == before
    assert certs("--name", "mill.lab", "--renew", "plant")[0] == 0
    talk(pair(lab, "plant"), None, lab / "ca.crt", "mill.lab")


@pytest.mark.parametrize(
    ("gone", "said"),
    [
        ("ca.key", "ca.crt is there without"),
        ("ca.crt", "ca.key is there without"),
        ("boards/ra_1.key", "ra_1.key"),
    ],
)
def test_half_of_a_pair_is_named_and_nothing_written(certs: Any, lab: Path, gone: str, said: str) -> None:
    certs()
    (lab / gone).unlink()
    before = contents(lab)
    status, sentence = certs("--renew", "plant")
    assert status == 1 and said in sentence and contents(lab) == before


def test_certificates_of_another_authority_are_told_apart(certs: Any, lab: Path) -> None:
    certs()
    for name in ("ca.crt", "ca.key"):
        (lab / name).unlink()
    status, said = certs()
    assert status == 1 and f"plant.crt is not of {lab}/ca.crt; --renew plant makes it anew" in " ".join(
        said.split()
    )
    assert not (lab / "ca.crt").exists()


def test_a_key_of_another_authority_signs_nothing(certs: Any, lab: Path) -> None:
    certs()
    (lab / "ca.key").write_bytes((lab / "plant.key").read_bytes())
    status, said = certs()
    assert status == 1 and "ca.crt certificate and key do not belong together" in " ".join(said.split())


@pytest.mark.parametrize("content", ["", "no certificate"])
def test_a_file_that_is_no_certificate_is_named(certs: Any, lab: Path, content: str) -> None:
    certs()
    (lab / "plant.crt").write_text(content)
    status, said = certs()
    assert status == 1 and "plant.crt holds no certificate" in " ".join(said.split())


def test_what_has_expired_or_soon_will_is_said(certs: Any, lab: Path) -> None:
    assert "plant.crt  made, expires " in certs("--days", "5")[1]
    from arboleda.adapters import authority

    known = authority.Authority(
        authority.Pair(certificate=(lab / "ca.crt").read_bytes(), key=(lab / "ca.key").read_bytes())
    )
    old = known.client("ra_1", datetime.now(timezone.utc) - timedelta(days=3), 2)
    (lab / "boards/ra_1.crt").write_bytes(old.certificate)
    assert "ra_1.crt  was there, HAS EXPIRED" in certs()[1]


def test_nothing_outlasts_its_authority(certs: Any, lab: Path) -> None:
    certs("--days", "3650")
    from arboleda.adapters import authority

    known = authority.Authority(
        authority.Pair(certificate=(lab / "ca.crt").read_bytes(), key=(lab / "ca.key").read_bytes())
    )
    facts = known.signed(
        known.client("late", datetime.now(timezone.utc) + timedelta(days=9), 3650).certificate
    )
    assert facts is not None and facts.until == known.until


@pytest.mark.parametrize(
    "name", ["mill lab", "*.lab", "10.0.0.300", "-x", "x" * 300, "mühle.lab", "::zz", ""]
)
def test_what_is_neither_name_nor_address_is_refused(certs: Any, lab: Path, name: str) -> None:
    status, said = certs(f"--name={name}")
    assert status == 2 and "neither a name of a machine nor an address" in " ".join(said.split())
    assert not lab.exists()


def test_a_name_counts_however_it_is_written(certs: Any, lab: Path) -> None:
    certs("--name", "Mill.LAB", "--name", "FD00::A")
    before = contents(lab)
    assert certs("--name", "mill.lab", "--name", "fd00::a", "--name", "FD00::A")[0] == 0
    assert contents(lab) == before


def test_nobody_of_that_name_is_made_anew(certs: Any, lab: Path) -> None:
    status, said = certs("--renew", "ra_9")
    assert status == 2 and "nobody here is called 'ra_9'" in " ".join(said.split()) and not lab.exists()


def test_a_board_cannot_log_in_as_the_plant(certs: Any, lab: Path, tmp_path: Path) -> None:
    text = (Path(main.__file__).parents[1] / "plants/plant.yaml").read_text()
    assert "mqtt: ra_1" in text
    (tmp_path / "plant.yaml").write_text(text.replace("mqtt: ra_1", "mqtt: plant"))
    status, said = certs("--plant", str(tmp_path / "plant.yaml"))
    assert status == 1 and "cannot have the MQTT name plant" in said and not lab.exists()


MOSQUITTO = ("--mosquitto", "127.0.0.1", "--mosquitto", "mill.lab")


def test_the_files_of_a_mosquitto_stay_and_another_place_for_them_is_refused(certs: Any, lab: Path) -> None:
    at = ("--at", str(lab / "mosquitto"))
    assert certs(*MOSQUITTO, *at)[0] == 0
    before = contents(lab)
    assert certs(*MOSQUITTO, *at)[0] == 0
    status, said = certs(*MOSQUITTO, "--at", "/somewhere/else")
    assert status == 1 and "mosquitto.conf is there and says something else" in " ".join(said.split())
    assert contents(lab) == before


def test_the_certificate_of_a_mosquitto_has_the_names_that_it_was_given_and_no_others(
    certs: Any, lab: Path
) -> None:
    _, said = certs(*MOSQUITTO, "--at", str(lab / "mosquitto"))
    (line,) = [line for line in said.splitlines() if "broker.crt" in line]
    assert set(line.rpartition("  ")[2].split()) == {"mill.lab", "127.0.0.1"}


def test_without_its_library_it_says_how_to_have_it(
    certs: Any, lab: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delitem(sys.modules, "arboleda.adapters.authority", raising=False)
    real = builtins.__import__

    def missing(name: str, *rest: Any) -> Any:
        if name.partition(".")[0] == "cryptography":
            raise ModuleNotFoundError(f"No module named {name!r}", name="cryptography")
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", missing)
    monkeypatch.setattr(sys.modules["arboleda.adapters"], "authority", None, raising=False)
    monkeypatch.delattr(sys.modules["arboleda.adapters"], "authority")
    status, said = certs()
    assert status == 1 and "pip install" in said and "'arboleda[certs]'" in said and not lab.exists()
