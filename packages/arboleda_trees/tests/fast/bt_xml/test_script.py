from __future__ import annotations

import pytest

from arboleda_trees.bt_xml import script
from arboleda_trees.bt_xml.script import (
    Assignment,
    Choice,
    Comparison,
    Infix,
    Name,
    Prefix,
    ScriptFault,
    Value,
)


@pytest.mark.parametrize(
    ("text", "read"),
    [
        ("x := 3", Assignment("x", ":=", Value(3))),
        ("x = y = 2", Assignment("x", "=", Assignment("y", "=", Value(2)))),
        ("1 + 2 * 3", Infix(Value(1), "+", Infix(Value(2), "*", Value(3)))),
        ("a - b - c", Infix(Infix(Name("a"), "-", Name("b")), "-", Name("c"))),
        ("'to ' .. goal", Infix(Value("to "), "..", Name("goal"))),
        ("65..x", Infix(Value(65), "..", Name("x"))),
        ("a < b <= 0x1F", Comparison((Name("a"), Name("b"), Value(31)), ("<", "<="))),
        ("!ok && -1.5e3", Infix(Prefix("!", Name("ok")), "&&", Prefix("-", Value(1500.0)))),
        ("a || b && c", Infix(Name("a"), "||", Infix(Name("b"), "&&", Name("c")))),
        ("a ? 1 : b ? 2 : 3", Choice(Name("a"), Value(1), Choice(Name("b"), Value(2), Value(3)))),
        ("true != @door", Comparison((Value(1.0), Name("@door")), ("!=",))),
        ("~a & b | c", Infix(Infix(Prefix("~", Name("a")), "&", Name("b")), "|", Name("c"))),
        ("a | b ^ c", Infix(Infix(Name("a"), "|", Name("b")), "^", Name("c"))),
        ('word == "no"', Comparison((Name("word"), Value("no")), ("==",))),
    ],
)  # fmt: skip
def test_a_statement_is_read_by_the_strength_of_its_signs(text: str, read: script.Expression) -> None:
    assert script.parse(text) == (read,)


def test_statements_are_separated_by_semicolons_the_last_may_have_one() -> None:
    assert len(script.parse("a:=1;; b:=a+1 ;")) == 2


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "empty, at character 1"),
        ("x := ", "the script ends, at character 6"),
        ("3x", "nothing here, at character 1"),
        ("0x1F..x", "nothing here, at character 1"),
        ("a == 'b", "without its closing quote, at character 6"),
        ("(1 + 2", r"a \) is missing, at character 7"),
        ("1 := 2", "only a variable can stand before :=, at character 3"),
        ("a ? 1", "a : is missing"),
        ("__import__('os').x", "nothing here"),
        ("@", "a name is missing"),
        ("-" * 100 + "1", "nested deeper"),
        ("9" * 5000, "at most 40 digits"),
        ("1" + "+1" * 6000, "at most 10000 characters"),
    ],
)
def test_what_is_no_script_is_refused_with_the_character(text: str, words: str) -> None:
    with pytest.raises(ScriptFault, match=words):
        script.parse(text)


def test_what_a_script_reads_and_writes() -> None:
    statements = script.parse("a := b + c; d += a; e = 1; a == 'f' ? g : @h")
    assert script.reads(statements) == {"b", "c", "d", "e", "g", "@h"}
    assert script.writes(statements) == {"a", "d", "e"}
