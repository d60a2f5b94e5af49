"""The address of a database that keeps a plant's memory, as far as it is known without its library."""

from __future__ import annotations

from urllib.parse import parse_qsl, urlsplit

SCHEMES = ("postgresql://", "postgres://")
SECRETS = {"password", "sslpassword"}


def is_address(text: str) -> bool:
    """True if `text` is the address of a database."""
    return text.startswith(SCHEMES)


def has_password(address: str) -> bool:
    """True if an address holds a password in the clear, or cannot be parsed."""
    try:
        parts = urlsplit(address)
        return bool(parts.password) or any(key in SECRETS for key, _ in parse_qsl(parts.query))
    except ValueError:
        return True
