"""File of the shipped plant, and its name, which is read without loading the whole plant."""

from __future__ import annotations

from importlib.resources import files

SHIPPED = "plant.yaml"
NAME = "name: "


def shipped() -> bytes:
    """The content of its file."""
    return (files("arboleda") / "plants" / SHIPPED).read_bytes()


def shipped_name() -> str:
    """The name that its file gives it."""
    lines = shipped().decode().splitlines()
    return next(line.removeprefix(NAME) for line in lines if line.startswith(NAME))
