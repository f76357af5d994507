"""The application: its commands, each imported when it is run."""

from __future__ import annotations

from cyclopts import App, Parameter

from equipoise import __version__

app = App(
    name="equipoise",
    help="How a planar linkage moves, what that does to its frame, drive and joints.",
    version=__version__,
    default_parameter=Parameter(negative=""),
    suppress_keyboard_interrupt=False,
)

COMMANDS = {
    "analyze": "analyze",
    "animate": "reports",
    "balance": "balance:app",
    "best": "designs",
    "check": "files",
    "decay": "decay",
    "examples": "files",
    "export": "designs",
    "exposure": "exposure",
    "modes": "vibration",
    "new": "files",
    "plant": "planting:app",
    "plot": "pictures:plot_app",
    "report": "reports",
    "respond": "vibration",
    "resume": "sweep",
    "schema": "files",
    "search": "designs",
    "serve": "files",
    "simulate": "vibration",
    "sweep": "sweep",
    "tolerance": "sweep",
    "tool": "handheld:app",
}
"""Command -> module beside this one, and what it is called there if not like the command."""

for _name, _place in COMMANDS.items():
    _module, _, _what = _place.partition(":")
    app.command(f"equipoise.cli.{_module}:{_what or _name}", name=_name)


def import_commands() -> None:
    """Import every command, so that the application's help has a line of each."""
    for name in COMMANDS:
        app[name]
