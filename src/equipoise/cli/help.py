"""How help is laid out: what each option wants, in lines that fill the terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cyclopts.help import HelpEntry, HelpPanel
    from rich.console import Console, ConsoleOptions

PLAIN = {"INT": "NUMBER", "FLOAT": "NUMBER"}
"""What is said instead of the names that types have in Python."""


class Laid:
    """Help as Cyclopts lays it out, whose own parts are imported where help is asked for.

    Texts are plain: those of docstrings have line breaks that are none of the reader's, and reading
    them as Markdown would import a parser of it into every `--help`.
    """

    def __call__(self, console: Console, options: ConsoleOptions, panel: HelpPanel) -> None:
        """Print a panel of commands, arguments or options."""
        entries = [_entry(entry) for entry in panel.entries]
        self._usual(console, options, panel.copy(entries=entries))

    def render_usage(self, console: Console, options: ConsoleOptions, usage: Any) -> None:
        """Print the usage line, with the order of arguments."""
        self._usual.render_usage(console, options, usage)

    def render_description(
        self, console: Console, options: ConsoleOptions, description: Any
    ) -> None:
        """Print what a command does."""
        _unfold(description)
        self._usual.render_description(console, options, description)

    @property
    def _usual(self) -> Any:
        from cyclopts.help import DefaultFormatter

        return DefaultFormatter()


def _entry(entry: HelpEntry) -> HelpEntry:
    """With what is wanted in words; that something is not done unless asked for goes unsaid."""
    _unfold(entry.description)
    metavar = PLAIN.get(entry.metavar or "", entry.metavar)
    return entry.copy(metavar=metavar, default=None if entry.default == "False" else entry.default)


def _unfold(description: Any) -> None:
    """Paragraphs as one line each."""
    text = getattr(description, "primary_renderable", None)
    if text is not None and hasattr(text, "plain"):
        parts = (map(str.strip, part.split("\n")) for part in text.plain.split("\n\n"))
        text.plain = "\n\n".join(map(" ".join, parts))
