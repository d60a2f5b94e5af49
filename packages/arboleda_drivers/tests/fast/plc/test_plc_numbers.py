"""Numbers that a PLC echoes."""

from __future__ import annotations

from arboleda_drivers.plc.numbers import LAST, Numbers


def test_what_a_plc_shows_already_is_given_to_no_command() -> None:
    numbers = Numbers()
    numbers.see([1, 0, 3])
    assert [numbers.give("c1"), numbers.give("c2")] == [2, 4]
    assert numbers.id_of(2) == "c1"
    assert (numbers.id_of(1), numbers.id_of(0), numbers.id_of(None)) == (None, None, None)


def test_at_a_new_connection_no_number_names_a_command() -> None:
    numbers = Numbers()
    numbers.give("c1")
    numbers.begin(1)
    assert numbers.id_of(1) is None


def test_the_first_numbers_go_on_from_the_last_that_the_plc_accepted() -> None:
    numbers = Numbers()
    numbers.begin(41)
    assert numbers.give("c1") == 42
    numbers.begin(41)
    assert numbers.give("c2") == 43, "the command of 42 may still be on its way"


def test_numbers_begin_anew_after_the_last_and_never_are_0() -> None:
    numbers = Numbers()
    given = [numbers.give(f"c{at}") for at in range(LAST + 1)]
    assert (given[0], given[-2], given[-1]) == (1, LAST, 1)
    assert 0 not in given
    assert numbers.id_of(1) == f"c{LAST}"


def test_only_the_last_commands_are_remembered() -> None:
    numbers = Numbers()
    for at in range(300):
        numbers.give(f"c{at}")
    assert numbers.id_of(1) is None
    assert numbers.id_of(300) == "c299"
