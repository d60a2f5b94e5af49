"""Certificates of a lab, in files."""

from __future__ import annotations

from datetime import datetime, timedelta, timezone
from pathlib import Path

from arboleda.adapters import authority
from arboleda.adapters.authority import Pair

Files = tuple[Path, Path]
"""A certificate and its key."""


class Lab:
    """An authority, and the servers and clients that it knows."""

    def __init__(self, folder: Path, name: str = "lab") -> None:
        self.folder = folder / name
        self.folder.mkdir()
        self._now = datetime.now(timezone.utc)  # OpenSSL has no other clock
        self._authority, files = authority.new(name, self._now - timedelta(days=9)), self.folder / "ca.crt"
        files.write_bytes(self._authority.pair.certificate)
        self.certificate = files

    def host(self, name: str, *, days: int = 1) -> Files:
        """Those of a server, which expire in so many days; before now where that is less than nothing."""
        begun = self._now + timedelta(days=min(days - 1, 0))
        return self._written(name, self._authority.host(name, [name], begun, days - min(days - 1, 0)))

    def client(self, name: str) -> Files:
        return self._written(name, self._authority.client(name, self._now, 1))

    def _written(self, name: str, pair: Pair) -> Files:
        certificate, key = self.folder / f"{name}.crt", self.folder / f"{name}.key"
        certificate.write_bytes(pair.certificate)
        key.write_bytes(pair.key)
        return certificate, key
