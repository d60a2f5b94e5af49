"""Overview of `--help`: the commands of the first minutes on one screen, and the other ones by purpose."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from typing import Any

import typer
from typer.core import TyperGroup

from arboleda.model.verbs import Verb

from .commands import LoadedCommands, commands
from .help_language import WrongUse, complain, first_sentence, speaking, translated
from .language import help_words
from .misplaced_plant import with_option
from .old_names import in_new_names

FIRST: Mapping[str, str] = {
    "up": "Start a plant: simulated, with a page, until Ctrl-C",
    "new": "Write a plant of your own, or an example, into a folder",
    "check": "Say what is wrong with a plant file or a tree, line by line",
    "submit": "Give a task to the plant that runs",
    "status": "Show what the plant is doing",
    "stop": "Stop (software): halt and latch all robots; no safety function",
    "clear": "Take the latch of a stop off; moves nothing",
    "reset": "After clear, make the cells ready again; moves nothing",
    "tree": "Draw the behavior tree of a recipe, or the one that runs",
    "simulate": "Run whole plants under virtual time, with faults, and judge them",
    "prove": "Try every single fault at every step of every recipe",
    "report": "Write why a task failed, as one page",
}
SECTIONS: Mapping[str, tuple[str, ...]] = {
    "Run a plant": (*("up", "submit", "status", "tasks", "token", "service", "mcp", "help"),),
    "Operate it": tuple(verb.value for verb in Verb),
    "Make it yours": (
        *(
            "new",
            "examples",
            "extension",
            "check",
            "apply",
            "tree",
            "nodes",
            "urdf",
        ),
    ),
    "Put it to the test": ("simulate", "prove", "fault", "bench"),
    "Learn it": (),  # of packages alone, which have their place here
    "Look back": ("record", "report", "backup", "restore"),
}
TOPICS = dict(zip(("run", "operate", "make", "test", "learn", "history"), SECTIONS, strict=True))
MORE = (
    "More, by purpose: arboleda help {topics}\n"
    "What a command can do: arboleda COMMAND --help\n"
    "Also: --version, --install-completion"
)
BAD_INPUT = 2
LONGEST = 1000  # characters of a first sentence


class WholeSentences(TyperGroup):
    """A group that lists each command with its whole first sentence, in the language of the terminal."""

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """A command, whose help is in the language of the terminal."""
        command = super().get_command(ctx, cmd_name)
        if command is not None:
            command.context_class = speaking(command.context_class)
        return command

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[str | None, Any, list[str]]:
        """The command that is called, and its words; a plant file among them stands behind `--plant`."""
        name, command, words = super().resolve_command(ctx, args)
        if command is None or ctx.resilient_parsing:
            return name, command, words
        return name, command, with_option(command, ctx, words)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the commands in sections."""
        for title, names in self.sections(ctx).items():
            self.write_section(ctx, formatter, title, names)

    def write_section(self, ctx: Any, formatter: Any, title: str, names: Sequence[str]) -> None:
        """Write a heading, and the commands below it."""
        with formatter.section(help_words("sections").get(title, title)):
            formatter.write_dl([(name, self._what(ctx, name)) for name in names])

    def sections(self, ctx: Any) -> Mapping[str, Sequence[str]]:
        """The commands below each heading."""
        return {"Commands": self.list_commands(ctx)}

    def _what(self, ctx: Any, name: str) -> str:
        command = self.get_command(ctx, name)
        if command is None:
            return ""
        english: str = command.get_short_help_str(LONGEST)
        if not help_words("help"):
            return english
        return translated(command.short_help) if command.short_help else first_sentence(command.help or "")


class Overview(WholeSentences):
    """The group of all commands: none is loaded to list them."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self.commands: Any = LoadedCommands()

    def list_commands(self, ctx: Any) -> list[str]:
        """Names of all commands."""
        return list(self.commands)

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[str | None, Any, list[str]]:
        """The command that is called, by its name or by an old one."""
        return super().resolve_command(ctx, args if ctx.resilient_parsing else in_new_names(args))

    def format_options(self, ctx: Any, formatter: Any) -> None:
        """Write the commands of the first minutes, and how to find the other ones."""
        known, first = commands(), help_words("first")
        with formatter.section("Commands"):
            formatter.write_dl(
                [(name, first.get(name, text)) for name, text in FIRST.items() if name in known]
            )
        formatter.write_paragraph()
        more = help_words("frame").get("more", MORE)
        for line in more.format(topics=", ".join(self.topics())).splitlines():
            formatter.write_text(line)

    def topics(self) -> Mapping[str, str]:
        """The heading of each topic that has commands; a heading of a package's own is its own topic."""
        names = {title: topic for topic, title in TOPICS.items()}
        return {names.get(title, title.lower()): title for title in self.sections(None)}

    def topic_help(self, ctx: Any, topic: str) -> str:
        """The commands of a topic, each with its sentence."""
        formatter, title = ctx.make_formatter(), self.topics()[topic]
        self.write_section(ctx, formatter, title, self.sections(ctx)[title])
        written: str = formatter.getvalue()
        return written.rstrip("\n")

    def sections(self, ctx: Any) -> Mapping[str, Sequence[str]]:
        listed = {name for names in SECTIONS.values() for name in names}
        sections = {
            title: tuple(name for name in names if name in commands()) for title, names in SECTIONS.items()
        }
        for name in self.commands:
            if name not in listed:
                title = commands()[name].section
                sections[title] = (*sections.get(title, ()), name)
        return {title: names for title, names in sections.items() if names}

    def _what(self, ctx: Any, name: str) -> str:
        """The sentence of a command; in another language the first of the paragraph that begins with it."""
        brief, known = commands()[name].brief, help_words("help")
        if brief in known or not known:
            return translated(brief)
        return first_sentence(next((text for text in known if text.startswith(f"{brief} ")), brief))

    def main(self, *args: Any, **extra: Any) -> Any:
        """Run a command, and say in the language of the terminal what is wrong with its arguments."""
        self.context_class = speaking(self.context_class)
        if not (extra.get("standalone_mode", True) and help_words("help")):
            return super().main(*args, **extra)
        try:
            status = super().main(*args, **extra | {"standalone_mode": False})
        except WrongUse as error:
            complain(error)
            sys.exit(BAD_INPUT)
        except typer.Abort:
            typer.echo(help_words("frame")["Aborted"], err=True)
            sys.exit(1)
        sys.exit(status if isinstance(status, int) else 0)
