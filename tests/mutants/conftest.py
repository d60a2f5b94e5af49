"""Planted bugs are looked for in the process of the test."""

from packages.conftest import no_forks as no_forks
