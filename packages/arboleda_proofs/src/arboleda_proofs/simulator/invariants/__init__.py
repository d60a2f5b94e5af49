"""Invariants: rules that hold after every step, each a small function with one sentence."""

from __future__ import annotations

from .invariant import Invariant

__all__ = ["Invariant"]
