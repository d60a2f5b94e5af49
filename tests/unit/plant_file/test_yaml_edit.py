"""Edits of a YAML text: what they change, and that all else stays to the character."""

from __future__ import annotations

from difflib import ndiff
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from arboleda.plant_file.yaml_edit import EditRefused, with_value, without
from arboleda.plant_file.yaml_flow import flow
from arboleda.plant_file.yaml_marks import YamlFault, parse

ROOT = Path(__file__).parents[3]
PLANTS = sorted([*ROOT.glob("examples/*/plant.yaml"), *ROOT.glob("src/arboleda/arboleda/plants/*.yaml")])
TEXT = """\
# A cell.
name: a   # its name
cells:
  one:
    targets: # taught on Monday
      home:   {arm: {deg: [0,  0], mm: 0}}   # folded
      slot_1: {arm: {deg: [10, -5.5], mm: 80}}

      vise: &v
        arm:      # slowly
          deg: [1, 2]
    groups: {all: [home, slot_1]}
    needs: {}
    rows:
      - first
      - {x: 1}
    again: *v
# the end
"""


def plain(raw: bytes) -> Any:
    root, faults = parse(raw)
    assert not faults
    return root.value


def lines(before: str, after: bytes) -> list[str]:
    """The lines that differ, as `- old` and `+ new`."""
    rows = ndiff(before.splitlines(), after.decode().splitlines())
    return [row for row in rows if row[0] in "+-"]


@pytest.mark.parametrize(
    ("place", "value", "changed"),
    [
        (
            ("cells", "one", "targets", "home", "arm", "deg"),
            [0, 90],
            ["      home:   {arm: {deg: [0,  90], mm: 0}}   # folded"],
        ),
        (
            ("cells", "one", "targets", "slot_1"),
            {"arm": {"deg": [10, -6.0], "mm": 80}},
            ["      slot_1: {arm: {deg: [10, -6], mm: 80}}"],
        ),
        (("name",), "on b", ['name: "on b"   # its name']),
        (("cells", "one", "groups", "some"), ["home"], ["    groups: {all: [home, slot_1], some: [home]}"]),
        (("cells", "one", "needs", "a.b"), {"c": True}, ["    needs: {a.b: {c: true}}"]),
        (("cells", "one", "groups", "all", 2), "vise", ["    groups: {all: [home, slot_1, vise]}"]),
        (("cells", "one", "again", "arm", "deg", 0), 5, ["    again: {arm: {deg: [5, 2]}}"]),
    ],
)
def test_a_value_is_set_and_its_line_stays_as_it_was(
    place: tuple[str | int, ...], value: Any, changed: list[str]
) -> None:
    after = with_value(TEXT.encode(), place, value)
    assert [row[2:] for row in lines(TEXT, after) if row[0] == "+"] == changed
    assert len([row for row in lines(TEXT, after) if row[0] == "-"]) == len(changed)


def test_a_new_key_comes_below_the_others_as_they_are_aligned() -> None:
    aligned = "targets:\n  home:   {a: 1}\n  slot_1: {a: 2} # second\n\n# more\nname: x\n"
    after = with_value(aligned.encode(), ("targets", "vise"), {"a": 3})
    assert lines(aligned, after) == ["+   vise:   {a: 3}"]
    assert after.decode().index("vise") < after.decode().index("# more")


def test_what_leads_to_a_new_key_is_made() -> None:
    after = with_value(TEXT.encode(), ("timing", "dwell_s"), 0.5)
    assert lines(TEXT, after) == ["+ timing: {dwell_s: 0.5}"]


def test_an_entry_is_added_to_a_list_in_lines() -> None:
    after = with_value(TEXT.encode(), ("cells", "one", "rows", 2), "last")
    assert lines(TEXT, after) == ["+       - last"]


@pytest.mark.parametrize(
    ("place", "changed"),
    [
        (("cells", "one", "groups"), ["-     groups: {all: [home, slot_1]}"]),
        (("name",), ["- name: a   # its name"]),
        (("cells", "one", "rows", 0), ["-       - first"]),
        (
            ("cells", "one", "targets", "slot_1", "arm", "mm"),
            ["-       slot_1: {arm: {deg: [10, -5.5], mm: 80}}", "+       slot_1: {arm: {deg: [10, -5.5]}}"],
        ),
        (
            ("cells", "one", "targets", "slot_1", "arm", "deg"),
            ["-       slot_1: {arm: {deg: [10, -5.5], mm: 80}}", "+       slot_1: {arm: {mm: 80}}"],
        ),
        (("cells", "one", "rows", 1, "x"), ["-       - {x: 1}", "+       - {}"]),
    ],
)
def test_a_key_is_removed_and_nothing_else(place: tuple[str | int, ...], changed: list[str]) -> None:
    after = without(TEXT.encode(), place)
    assert [row for row in lines(TEXT, after) if row[0] != "?"] == changed


def test_lines_of_a_block_become_one_line_and_its_comment_stays() -> None:
    text = "a:\n  b:   # why\n    c: 1\n    d: 2\n  e: 3\n"
    assert with_value(text.encode(), ("a", "b"), 7).decode() == "a:\n  b: 7   # why\n  e: 3\n"


@pytest.mark.parametrize(
    "place", [("cells", "one", "targets", "vise", "arm", "deg", 0), ("cells", "one", "targets", "vise")]
)
def test_what_other_places_refer_to_is_not_changed_unseen(place: tuple[str | int, ...]) -> None:
    with pytest.raises(EditRefused, match=r"cannot be changed alone|is used before"):
        with_value(TEXT.encode(), place, 5)


@pytest.mark.parametrize(
    ("place", "sentence"), [(("name", "x"), "no such place"), (("cells", "one", "rows", 9), "no such place")]
)
def test_a_place_that_cannot_be_is_named(place: tuple[str | int, ...], sentence: str) -> None:
    with pytest.raises(EditRefused, match=sentence):
        with_value(TEXT.encode(), place, 1)
    with pytest.raises(EditRefused, match="nothing to remove"):
        without(TEXT.encode(), place)


@pytest.mark.parametrize("value", [float("nan"), [float("inf")], {"deg": [0, float("-inf")]}])
def test_what_is_no_number_is_refused_as_such(value: Any) -> None:
    with pytest.raises(EditRefused, match="neither nan nor infinity"):
        with_value(b"a: 1\n", ("a",), value)


def test_a_text_with_a_mistake_is_not_edited() -> None:
    with pytest.raises(EditRefused, match="line 2"):
        with_value(b"a: 1\na: 2\n", ("a",), 3)


@pytest.mark.parametrize(("begin", "newline"), [("", "\r\n"), ("\ufeff", "\n")])
def test_line_ends_and_byte_order_mark_stay(begin: str, newline: str) -> None:
    raw = (begin + newline.join(["a: 1 # one", "b: 2", ""])).encode()
    after = with_value(with_value(raw, ("a",), 5), ("c",), [1])
    assert after == (begin + newline.join(["a: 5 # one", "b: 2", "c: [1]", ""])).encode()


def test_characters_are_counted_and_not_bytes() -> None:
    text = "# ñandú \U0001f600 日本\na: {é: 'ü', b: 1} # ñ\nc: 2\n"
    after = with_value(with_value(text.encode(), ("a", "b"), "ö ß"), ("c",), 3)
    assert after.decode() == text.replace("b: 1", 'b: "ö ß"').replace("c: 2", "c: 3")


leaves = st.none() | st.booleans() | st.integers(-(10**17), 10**17) | st.floats() | st.text()
values = st.recursive(
    leaves,
    lambda each: st.lists(each, max_size=3) | st.dictionaries(st.text(), each, max_size=3),
    max_leaves=5,
)


@given(values)
def test_a_value_on_one_line_is_read_as_it_was(value: Any) -> None:
    try:
        after = with_value(b"a: 1\n", ("b",), value)
    except EditRefused:
        assert not _can_be_text(value)
        return
    assert plain(after)["b"] == value and after.startswith(b"a: 1\n")


def test_what_is_too_long_for_a_line_is_written_below_each_other() -> None:
    words = {"stopped": 0, "moving": 1, "fault": 2, "latched": 3}
    settings = {
        "host": "10.0.0.2",
        "state": {"input": 2, "words": words},
        "halt": [{"coil": 0, "value": True}],
    }
    raw = b"devices:\n  arm:   {kind: arm}\n  lamp:  {kind: lamp}\n"
    after = with_value(raw, ("devices", "door"), {"kind": "gate", "driver": {"modbus": settings}})
    assert after.decode().removeprefix(raw.decode()) == (
        "  door:\n    kind: gate\n    driver:\n      modbus:\n        host: 10.0.0.2\n"
        "        state: {input: 2, words: {stopped: 0, moving: 1, fault: 2, latched: 3}}\n"
        "        halt: [{coil: 0, value: true}]\n"
    )


def _can_be_text(value: Any) -> bool:
    """False where a character is none of a text file, or a number none of a plant file's."""
    try:
        root, faults = parse(f"b: {flow(value)}\n".encode())
    except (YamlFault, UnicodeEncodeError):
        return False
    return not faults and root.value["b"] == value


def _places(value: Any, place: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    entries = (
        value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    )
    inner = [each for key, entry in entries for each in _places(entry, (*place, key))]
    return [*([place] if place else []), *inner]


@pytest.mark.sampled(7)
@pytest.mark.parametrize("file", PLANTS, ids=lambda each: each.parent.name)
def test_every_value_of_a_plant_that_we_ship_is_edited_alone_or_refused(file: Path) -> None:
    raw = file.read_bytes()
    comments = raw.decode().count("#")
    refused = 0
    places = _places(plain(raw))[:: max(1, len(_places(plain(raw))) // 12)]
    for place in places:
        try:
            after = with_value(raw, place, 12.5)
            gone = without(raw, place)
        except EditRefused:
            refused += 1
            continue
        assert after.decode().count("#") <= comments
        assert len(after.splitlines()) <= len(raw.splitlines()) >= len(gone.splitlines())
    assert refused <= len(places) // 10
