"""Host: what operating systems have differently, and whatever stands in where one lacks it.

Nothing else asks which system this is; `tests/meta/test_other_systems.py` holds that.
"""
