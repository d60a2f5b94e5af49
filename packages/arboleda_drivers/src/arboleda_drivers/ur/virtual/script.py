"""The little of URScript that a virtual controller runs: lines that call a function each, in their order."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

HEAD = re.compile(r"(def|sec) (\w+)\(\):")
CALL = re.compile(r"(\w+)\((.*)\)")
LONGEST = 65536  # characters of a program without an end
FUNCTIONS = {
    "movej": 1,
    "stopj": 1,
    "sleep": 1,
    "textmsg": 1,
    "rtde_set_watchdog": 3,
    "write_output_integer_register": 2,
    "set_standard_digital_out": 2,
    "set_configurable_digital_out": 2,
    "set_tool_digital_out": 2,
}
"""Functions that it knows, with the number of values without a name."""


@dataclass(frozen=True, kw_only=True)
class Call:
    """Line of a program: a function, its values, and those with a name."""

    line: int
    function: str
    values: tuple[Any, ...]
    named: dict[str, Any]


@dataclass(frozen=True, kw_only=True)
class Program:
    """Program, or a secondary one, which runs beside the program and takes no time."""

    name: str
    calls: tuple[Call, ...]
    is_secondary: bool = False

    @property
    def moves(self) -> bool:
        return any(call.function == "movej" for call in self.calls)


class ScriptError(ValueError):
    """Error in a program: the line, and what is wrong there."""

    def __init__(self, line: int, text: str) -> None:
        super().__init__(text)
        self.line, self.text = line, text


class ProgramReader:
    """Splitter of what a client sends into programs."""

    def __init__(self) -> None:
        self._rest = ""

    def feed(self, data: bytes) -> Iterator[Program]:
        """The programs that are complete now; raises ScriptError for one that cannot be run."""
        self._rest = (self._rest + data.decode("utf-8", "replace"))[-LONGEST:]
        while "\nend\n" in self._rest:
            text, _, self._rest = self._rest.partition("\nend\n")
            yield program(text.strip("\n"))


def program(text: str) -> Program:
    """Parses a program without its last line; raises ScriptError."""
    first, *lines = text.split("\n")
    head = HEAD.fullmatch(first.strip())
    if head is None:
        raise ScriptError(1, "syntax error")
    calls = tuple(_call(number, line.strip()) for number, line in enumerate(lines, start=2) if line.strip())
    return Program(name=head[2], calls=calls, is_secondary=head[1] == "sec")


def _call(line: int, text: str) -> Call:
    found = CALL.fullmatch(text)
    if found is None or found[1] not in FUNCTIONS:
        raise ScriptError(line, f"compile_error_name_not_found:{text.partition('(')[0][:40]}")
    try:
        parsed = ast.parse(text, mode="eval").body
        assert isinstance(parsed, ast.Call)
        values = tuple(ast.literal_eval(each) for each in parsed.args)
        named = {each.arg or "": ast.literal_eval(each.value) for each in parsed.keywords}
    except (SyntaxError, ValueError, AssertionError) as error:
        raise ScriptError(line, "syntax error") from error
    if len(values) != FUNCTIONS[found[1]]:
        raise ScriptError(line, f"{found[1]} takes {FUNCTIONS[found[1]]} values")
    return Call(line=line, function=found[1], values=values, named=named)
