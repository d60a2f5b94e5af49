"""Help and errors of wrong arguments in the language of the terminal, looked up by their English."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from typing import Any

import typer
from click import HelpFormatter

from arboleda.web.languages.templates import Templates

from .language import help_words

WrongUse: type[Exception] = typer.BadParameter.__bases__[0]  # typer exports only that one of its errors
VERBATIM = "\b"  # typer keeps the lines of such a paragraph as they are
BLANK_LINE = re.compile(r"\n[ \t]*\n")
PLACEHOLDER = re.compile(r"[A-Z]{2,}")  # FILE, [OPTIONS], HOST:PORT
NOTES = re.compile(r"(?P<text>.*?)(?:(?:^|  )\[(?P<notes>[^][]*)\])?", re.DOTALL)


def units(text: str) -> Iterator[str]:
    """The parts of a help text that are said in another language one by one: paragraphs, and lines of those
    that are kept as they are."""
    for paragraph in BLANK_LINE.split(text):
        parts = paragraph.splitlines() if VERBATIM in paragraph else [paragraph]
        yield from (words for part in parts if (words := " ".join(part.replace(VERBATIM, "").split())))


def translated(text: str) -> str:
    """A help text in the language of the terminal, as far as that has words for it."""
    known = help_words("help")
    return BLANK_LINE.sub("\n\n", "\n\n".join(_paragraph(each, known) for each in BLANK_LINE.split(text)))


def first_sentence(text: str) -> str:
    """The first sentence of a help text, in the language of the terminal."""
    found = re.match(r".+?\.(?=\s|$)", translated(text), re.DOTALL)
    return translated(text) if found is None else " ".join(found[0].split())


def error_words(message: str) -> str:
    """A sentence of typer on a wrong argument, in the language of the terminal."""
    return _errors()(message)


def _slot(name: str, value: str) -> str:
    """A part of an error: a sentence, the name of a parameter, or the words of a person as they are."""
    if name == "message":
        return error_words(value)
    return placeholders(value) if name == "parameter" and not value.startswith("'-") else value


def speaking(context: Any) -> Any:
    """The context of a command: its help and its errors are for the language of the terminal."""
    return _speaking(context, has_words=bool(help_words("help")))


def complain(error: Any) -> None:
    """Print that a command was called wrongly: how it is called, where its help is, and what is wrong."""
    context, message, words = error.ctx, error.format_message(), help_words("frame")
    if context is not None and message == context.get_help():
        typer.echo(message, err=True)  # a group that was called without a command
        return
    if context is not None:
        command = f"{context.command_path} {context.help_option_names[-1]}"
        typer.echo(f"{context.get_usage()}\n{words['try'].format(command=command)}\n", err=True)
    typer.echo(f"{words['Error']}: {error_words(message)}", err=True)


def placeholders(text: str) -> str:
    """The words in capitals of a usage, as FILE, in the language of the terminal."""
    known = help_words("placeholders")
    return PLACEHOLDER.sub(lambda found: known.get(found[0], found[0]), text)


class HelpWriter(HelpFormatter):
    """Writer of help: has usage, headings, texts and notes in the language of the terminal."""

    def write_usage(self, prog: str, args: str = "", prefix: str | None = None) -> None:
        super().write_usage(prog, placeholders(args), prefix or f"{_frame('Usage')}: ")

    def section(self, name: str) -> Any:
        return super().section(_frame(name))

    def write_text(self, text: str) -> None:
        super().write_text(translated(text))

    def write_dl(self, rows: Iterable[tuple[str, str]], col_max: int = 30, col_spacing: int = 2) -> None:
        translated = [(placeholders(name), _option_help(text)) for name, text in rows]
        super().write_dl(translated, col_max, col_spacing)


def _paragraph(paragraph: str, known: Mapping[str, str]) -> str:
    if VERBATIM not in paragraph:
        return known.get(" ".join(paragraph.split()), paragraph)
    return "\n".join(known.get(" ".join(line.split()), line) for line in paragraph.splitlines())


def _option_help(text: str) -> str:
    """The text of an option, and the notes that typer puts behind it: [default: 1; required]."""
    known = help_words("help")
    if text in known:
        return known[text]
    found = NOTES.fullmatch(text)
    if found is None or found["notes"] is None:
        return translated(text)
    notes = "; ".join(_note(each) for each in found["notes"].split("; "))
    return "  ".join(part for part in (translated(found["text"]), f"[{notes}]") if part)


def _note(note: str) -> str:
    name, colon, value = note.partition(": ")
    return f"{_frame(name)}{colon}{value}"


def _frame(word: str) -> str:
    return help_words("frame").get(word, word)


@cache
def _speaking(context: Any, *, has_words: bool) -> Any:
    writer = HelpWriter if has_words else context.formatter_class
    return type(context.__name__, (context,), {"formatter_class": writer})


@cache
def _errors() -> Templates:
    """The errors of typer, and what they are in the language of the terminal."""
    return Templates(help_words("errors"), _slot)
