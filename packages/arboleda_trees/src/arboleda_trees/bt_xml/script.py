"""The script language of BehaviorTree.CPP 4: text -> statements that can be checked and evaluated.

Semicolons stand between statements. Texts stand in single quotes, or, in some dialects, in double quotes.
Operators from weak to strong: assignments, `? :`, `||`, `&&`, comparisons,
`|` and `^`, `&`, `+ - ..`, `* /`, and the prefixes `- ! ~`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

Literal = float | int | str
LONGEST = 10_000  # characters
LONGEST_NUMBER = 40
DEEPEST = 50  # levels of parentheses and prefixes
TOKEN = re.compile(
    r"""\s*(?:
      (?P<string>'[^']*' | "[^"]*")
    | (?P<number>0[xX][0-9a-fA-F]+(?!\.) | [0-9]+(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?)(?![A-Za-z0-9_@]|\.(?!\.))
    | (?P<name>[A-Za-z_@][A-Za-z0-9_]*)
    | (?P<sign>\.\.|&&|\|\||==|!=|<=|>=|:=|\+=|-=|\*=|/=|[-+*/&|^~!<>=?:();])
    )""",
    re.VERBOSE,
)
ASSIGNS = frozenset({":=", "=", "+=", "-=", "*=", "/="})
COMPARES = frozenset({"==", "!=", "<", ">", "<=", ">="})
WEAKEST, ASSIGNMENT, TERNARY, COMPARISON, PREFIX = 0, 2, 4, 10, 20
STRENGTHS = {
    **dict.fromkeys(ASSIGNS, ASSIGNMENT),
    "?": TERNARY,
    "||": 6,
    "&&": 8,
    **dict.fromkeys(COMPARES, COMPARISON),
    **dict.fromkeys(("|", "^"), 12),
    "&": 14,
    **dict.fromkeys(("+", "-", ".."), 16),
    **dict.fromkeys(("*", "/"), 18),
}


class ScriptFault(Exception):
    """Error: a script cannot be read, with the number of a character, from 1, and the reason."""

    def __init__(self, at: int, sentence: str) -> None:
        super().__init__(f"{sentence}, at character {at} of the script")


@dataclass(frozen=True)
class Value:
    """Number or text; true and false are 1 and 0."""

    value: Literal


@dataclass(frozen=True)
class Name:
    """Variable, `@x` for a variable of the outermost tree; or a word of an enumeration."""

    name: str


@dataclass(frozen=True)
class Prefix:
    sign: str
    operand: Expression


@dataclass(frozen=True)
class Infix:
    left: Expression
    sign: str
    right: Expression


@dataclass(frozen=True)
class Comparison:
    """Comparison `a < b <= c`: each neighbouring pair is compared."""

    operands: tuple[Expression, ...]
    signs: tuple[str, ...]


@dataclass(frozen=True)
class Choice:
    condition: Expression
    then: Expression
    otherwise: Expression


@dataclass(frozen=True)
class Assignment:
    """Assignment; `:=` may make a variable, other signs change an existing one."""

    name: str
    sign: str
    value: Expression


Expression = Value | Name | Prefix | Infix | Comparison | Choice | Assignment


def parse(text: str) -> tuple[Expression, ...]:
    """The statements of a script; raises ScriptFault if it has none, or cannot be read."""
    if len(text) > LONGEST:
        raise ScriptFault(LONGEST, f"a script has at most {LONGEST} characters")
    parser = _Parser(list(_tokens(text)), len(text))
    statements = []
    while not parser.is_at_end:
        statements.append(parser.expression(WEAKEST))
        while parser.take(";"):
            pass
    if not statements:
        raise ScriptFault(1, "the script is empty")
    return tuple(statements)


def reads(statements: Sequence[Expression]) -> set[str]:
    """The names that a script reads and that no earlier statement of it makes."""
    made: set[str] = set()
    names: set[str] = set()
    for statement in statements:
        names |= {each.name for each in _names(statement)} - made
        made |= {
            each.name for each in _parts(statement) if isinstance(each, Assignment) and each.sign == ":="
        }
    return names


def writes(statements: Sequence[Expression]) -> set[str]:
    """The names that a script may set."""
    parts = (each for statement in statements for each in _parts(statement))
    return {each.name for each in parts if isinstance(each, Assignment)}


def compared(statements: Sequence[Expression]) -> Iterator[Expression]:
    """All that a script compares."""
    for statement in statements:
        for each in _parts(statement):
            if isinstance(each, Comparison):
                yield from each.operands


def _names(expression: Expression) -> Iterator[Name]:
    for each in _parts(expression):
        if isinstance(each, Name):
            yield each
        elif isinstance(each, Assignment) and each.sign != ":=":
            yield Name(each.name)


def _parts(expression: Expression) -> Iterator[Expression]:
    """An expression with all its parts."""
    waiting = [expression]
    while waiting:
        each = waiting.pop()
        yield each
        if isinstance(each, Prefix):
            waiting.append(each.operand)
        elif isinstance(each, Infix):
            waiting += (each.left, each.right)
        elif isinstance(each, Comparison):
            waiting += each.operands
        elif isinstance(each, Choice):
            waiting += (each.condition, each.then, each.otherwise)
        elif isinstance(each, Assignment):
            waiting.append(each.value)


@dataclass(frozen=True)
class _Token:
    kind: str
    text: str
    at: int  # of its first character, from 1


def _tokens(text: str) -> Iterator[_Token]:
    at, end = 0, len(text.rstrip())
    while at < end:
        match = TOKEN.match(text, at)
        if match is None or match.lastgroup is None:
            text_from_here = text[at:].lstrip()
            why = (
                "a text without its closing quote"
                if text_from_here[:1] in ("'", '"')
                else f"{text_from_here[:12]!r} is nothing here"
            )
            raise ScriptFault(len(text) - len(text_from_here) + 1, why)
        yield _Token(match.lastgroup, match[match.lastgroup], match.start(match.lastgroup) + 1)
        at = match.end()


class _Parser:
    """Parser by operator precedence: an expression goes on while the next operator binds as strongly."""

    def __init__(self, tokens: list[_Token], length: int) -> None:
        self._tokens = tokens
        self._next = 0
        self._depth = 0
        self._end = _Token("end", "", length + 1)

    @property
    def is_at_end(self) -> bool:
        return self._next >= len(self._tokens)

    @property
    def _token(self) -> _Token:
        return self._end if self.is_at_end else self._tokens[self._next]

    def take(self, sign: str) -> bool:
        """Skip the next token if it is this sign; True if it was."""
        is_there = self._token.kind == "sign" and self._token.text == sign
        self._next += is_there
        return is_there

    def expression(self, weakest: int) -> Expression:
        left = self._prefix()
        while self._token.kind == "sign" and STRENGTHS.get(self._token.text, -1) >= weakest:
            sign = self._token
            if sign.text in COMPARES:
                left = self._comparison(left)
                continue
            self._next += 1
            if sign.text in ASSIGNS:
                return self._assignment(left, sign)
            if sign.text == "?":
                return self._choice(left)
            left = Infix(left, sign.text, self.expression(STRENGTHS[sign.text] + 1))
        return left

    def _assignment(self, left: Expression, sign: _Token) -> Expression:
        if not isinstance(left, Name):
            raise ScriptFault(sign.at, f"only a variable can stand before {sign.text}")
        return Assignment(left.name, sign.text, self._deeper(WEAKEST))

    def _choice(self, condition: Expression) -> Expression:
        then = self._deeper(WEAKEST)
        if not self.take(":"):
            raise ScriptFault(self._token.at, "a : is missing after ? and its value")
        return Choice(condition, then, self._deeper(TERNARY))

    def _comparison(self, first: Expression) -> Expression:
        operands, signs = [first], []
        while self._token.kind == "sign" and self._token.text in COMPARES:
            signs.append(self._token.text)
            self._next += 1
            operands.append(self.expression(COMPARISON + 1))
        return Comparison(tuple(operands), tuple(signs))

    def _prefix(self) -> Expression:
        token = self._token
        self._next += 1
        if token.kind == "string":
            return Value(token.text[1:-1])
        if token.kind == "number":
            return Value(_number(token))
        if token.kind == "name":
            return _word(token)
        if token.text in ("-", "!", "~"):
            return Prefix(token.text, self._deeper(PREFIX))
        if token.text == "(":
            inner = self._deeper(WEAKEST)
            if not self.take(")"):
                raise ScriptFault(self._token.at, "a ) is missing")
            return inner
        if token.text:
            raise ScriptFault(token.at, f"a value or a variable is expected, not {token.text!r}")
        raise ScriptFault(token.at, "a value or a variable is expected, and the script ends")

    def _deeper(self, weakest: int) -> Expression:
        self._depth += 1
        if self._depth > DEEPEST:
            raise ScriptFault(self._token.at, f"nested deeper than {DEEPEST} levels")
        expression = self.expression(weakest)
        self._depth -= 1
        return expression


def _word(token: _Token) -> Expression:
    if token.text == "@":
        raise ScriptFault(token.at, "a name is missing after @")
    return Value(float(token.text == "true")) if token.text in ("true", "false") else Name(token.text)


def _number(token: _Token) -> Literal:
    text = token.text
    if len(text) > LONGEST_NUMBER:
        raise ScriptFault(token.at, f"a number has at most {LONGEST_NUMBER} digits")
    if text[:2] in ("0x", "0X"):
        return int(text, 16)
    return int(text) if text.isdigit() else float(text)
