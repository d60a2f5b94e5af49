"""The commands of this package; the module of one is loaded when it is called."""

from arboleda.extension import Command

COMMANDS = {
    "ended": Command("arboleda_ended.command", "Show how many tasks ended in each cell.", "Look back")
}
