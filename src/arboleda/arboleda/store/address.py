"""The address of a database that keeps a plant's memory, as far as it is known without its library."""

from __future__ import annotations

from urllib.parse import parse_qsl, urlsplit

SCHEMES = ("postgresql://", "postgres://")
SECRETS = {"password", "sslpassword"}


def is_address(text: str) -> bool:
    """Whether it names a database."""
    return text.startswith(SCHEMES)


def has_password(address: str) -> bool:
    """Whether anybody who reads it reads a password, too; True where nobody can tell."""
    try:
        parts = urlsplit(address)
        return bool(parts.password) or any(key in SECRETS for key, _ in parse_qsl(parts.query))
    except ValueError:
        return True
