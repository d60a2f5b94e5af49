"""Whole plants under virtual time: the shipped core, bridge and boards, a failing network, the truth."""
