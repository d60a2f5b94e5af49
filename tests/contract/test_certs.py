"""The certificates of `arboleda certs` before openssl, which had no part in making them."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli.main import cli


@pytest.mark.requires("cryptography", "openssl")
def test_openssl_finds_nothing_wrong_with_them(tmp_path: Path) -> None:
    lab = tmp_path / "lab"
    assert CliRunner().invoke(cli, ["certs", str(lab)]).exit_code == 0
    verify = ["openssl", "verify", "-x509_strict", "-CAfile", lab / "ca.crt"]
    for purpose, file in (
        ("sslserver", "plant.crt"),
        ("sslclient", "plant.crt"),
        ("sslclient", "boards/ra_1.crt"),
    ):
        subprocess.run([*verify, "-purpose", purpose, lab / file], check=True, capture_output=True)
