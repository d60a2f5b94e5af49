"""Host: differences of operating systems, and substitutes for abilities that one lacks.

No other room asks which system this is; `tests/meta/test_other_systems.py` holds that.
"""
