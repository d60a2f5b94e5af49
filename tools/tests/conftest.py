"""Tests of tools begin faults of proofs in their own process where packages are, as tests of packages do."""

from __future__ import annotations

from tests.packages import PACKAGES

if PACKAGES:
    from packages.conftest import no_forks as no_forks
