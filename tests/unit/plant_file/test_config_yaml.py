"""Nothing in a file is silently turned into something else, and no file makes a traceback."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader
from arboleda.plant_file.yaml_marks import parse

SCALARS = {
    "on": "on",
    "yes": "yes",
    "No": "No",
    "012": "012",
    "0x1F": "0x1F",
    "12:30": "12:30",
    "1_000": "1_000",
    "2026-01-02": "2026-01-02",
    "3.1.1": "3.1.1",
    "0A": "0A",
    "'5'": "5",
    "true": True,
    "-7": -7,
    "1e3": 1000.0,
    ".5": 0.5,
    "~": None,
    "": None,
    "9" * 5000: float("inf"),
}
BOMB = "a: &a [1, 1, 1, 1]\n" + "".join(
    f"{new}: &{new} [*{old}, *{old}, *{old}, *{old}]\n" for old, new in pairwise("abcdefghijkl")
)
FATAL = {
    "empty": (b"", "1:1: the file is empty"),
    "only a comment": (b"# nothing\n", "1:1: the file is empty"),
    "a list": (b"- 1\n- 2\n", "1:1: must be a mapping (key: value), is a list"),
    "a word": (b"hello\n", '1:1: must be a mapping (key: value), is "hello"'),
    "latin-1": (b"name: x\n# se\xf1al\n", "2:5: the file is not UTF-8 text"),
    "utf-16": ("name: x\n".encode("utf-16"), "1:1: the file is not UTF-8 text"),
    "a nul": (b"name: x\x00\n", "1:8: the character '\\x00' is not allowed"),
    "a tab": (b"cells:\n\tsis_a: 1\n", "2:1: a tab stands before the text"),
    "bracket": (b"paths: {0A: [0, 3\nname: x\n", "this is not YAML"),
    "indent": (b"a: 1\n  b: 2\n", "2:4: this is not YAML: mapping values are not allowed"),
    "reserved character": (b"name: @x\n", "1:7: this is not YAML"),
    "two documents": (b"name: x\n---\nname: y\n", "2:1: a second document starts here"),
    "unknown alias": (b"name: *x\n", "1:7: *x is used before &x"),
    "alias inside itself": (b"name: &x [*x]\n", "1:11: *x is used before &x is complete"),
    "merge key": (b"a: &x {b: 1}\nc: {<<: *x}\n", "2:5: merging with << is not supported"),
    "list as key": (b"{[1]: 2}\n", "1:2: a key is a plain word here"),
    "too deep": (b"a: " + b"[" * 100_000, "nested deeper than 20 levels"),
    "too large": (b"# " + b"x" * 300_000, "is larger than 256 KiB"),
    "bomb": (BOMB.encode(), "repeat more than 5000 values"),
    "bomb of one level": (b"a: &a [1, 2]\nb: [" + b"*a, " * 2000 + b"]\n", "repeat more than 5000 values"),
    "bomb of texts": (
        b"a: &a " + b"x" * 90_000 + b"\nb: [" + b"*a, " * 9 + b"]\n",
        "repeat more than 5000 values",
    ),
    "bomb of keys": (
        b"a: &a {? " + b"x" * 90_000 + b" : 1}\nb: [" + b"*a, " * 9 + b"]\n",
        "repeat more than 5000 values",
    ),
    "many values": (b"a: [" + b"1," * 50_000 + b"]\n", "more than 50000 values"),
}


@pytest.mark.parametrize(("text", "value"), SCALARS.items(), ids=[text[:12] or "nothing" for text in SCALARS])
def test_a_scalar_is_what_it_looks_like(text: str, value: object) -> None:
    node, faults = parse(f"key: {text}\n".encode())
    assert node.value == {"key": value}
    assert type(node.value["key"]) is type(value)
    assert faults == []


@pytest.mark.parametrize(("raw", "sentence"), FATAL.values(), ids=FATAL)
def test_a_file_that_cannot_be_read_is_one_clear_sentence(tmp_path: Path, raw: bytes, sentence: str) -> None:
    file = tmp_path / "plant.yaml"
    file.write_bytes(raw)
    with pytest.raises(ConfigError) as refusal:
        loader.load(file)
    assert sentence in str(refusal.value)
    assert len(refusal.value.problems) == 1


def test_keys_are_text_and_a_repeated_key_is_refused_with_the_line_of_the_first() -> None:
    node, faults = parse(b"paths:\n  01: a\n  1: b\n  '01': c\n")
    assert node.value == {"paths": {"01": "a", "1": "b"}}
    assert [(fault.mark.line, fault.mark.column) for fault in faults] == [(4, 3)]
    assert faults[0].sentence == 'the key "01" is there twice; the first is on line 2'


def test_an_anchor_repeats_a_whole_value() -> None:
    node, faults = parse(b"a: &pose {deg: [1]}\nb: *pose\n")
    assert (node.value["a"], faults) == (node.value["b"], [])


def test_a_tag_is_refused_and_the_reading_goes_on() -> None:
    _, faults = parse(b"a: !!python/object:os.system 1\nb: !!str 2\n")
    assert [fault.mark.line for fault in faults] == [1, 2]


def test_a_byte_order_mark_is_no_part_of_the_text() -> None:
    assert parse(b"\xef\xbb\xbfname: x\n")[0].value == {"name": "x"}


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("absent.yaml", "there is no such file"),
        (".", "is a directory"),
        ("x" * 300, "cannot be read"),
        ("\0", "not the name"),
    ],
    ids=["absent", "directory", "name too long", "nul"],
)
def test_a_path_without_a_file_is_one_clear_sentence(tmp_path: Path, name: str, sentence: str) -> None:
    with pytest.raises(ConfigError, match=sentence):
        loader.load(tmp_path / name)
