"""Certificates of a lab, in files."""

from __future__ import annotations

from datetime import datetime, timedelta, timezone
from pathlib import Path

from .shared import need_tool


class Lab:
    """A certificate authority in a folder, and what it signs."""

    def __init__(self, folder: Path) -> None:
        need_tool("trustme")
        from trustme import CA

        folder.mkdir()
        self._authority, self._folder, self.certificate = CA(), folder, folder / "ca.crt"
        self._authority.cert_pem.write_to_path(self.certificate)

    def sign(self, name: str, *, days: int = 1) -> tuple[Path, Path]:
        """Certificate and key of a server, or of a client with that name, which expire in so many days."""
        until = datetime.now(timezone.utc) + timedelta(days=days)  # OpenSSL has no other clock
        host = name.replace("_", "-")  # no name of a machine has a low line, and a client's does not count
        signed = self._authority.issue_cert(host, common_name=name, not_after=until)
        certificate, key = (self._folder / f"{name}.{ending}" for ending in ("crt", "key"))
        signed.cert_chain_pems[0].write_to_path(certificate)
        signed.private_key_pem.write_to_path(key)
        return certificate, key
