"""The command `modes`."""

from __future__ import annotations

from typing import Annotated

from equipoise.cli.app import FILE, app
from equipoise.cli.options import Model, naming
from equipoise.cli.results import Kind, Wanted, vibration


@app.command
def modes(
    file: Annotated[str, FILE],
    /,
    *,
    model: Model | None = None,
    json: bool = False,
    plot: str | None = None,
    format: Kind | None = None,
) -> None:
    """Natural frequencies, damping and shapes of a machine on its support.

    Parameters
    ----------
    file
        Path of a model file with a table [support], or the name of a bundled example.
    model
        linear or torque: the linkages' mass at the drive's pivot; moment: spread as in the mean.
    json
        Print one JSON object in SI units, and nothing else.
    plot
        Draw every mode into this folder.
    format
        With --plot: kind of the pictures, svg if not given.
    """
    from equipoise.schema.models import load_linkage
    from equipoise.vibration.free import vibrate_freely

    machine = load_linkage(file)
    wanted = Wanted(json, None, plot, format)
    wanted.check(file, machine)
    with naming(file):
        found = vibrate_freely(machine, model)

    def show() -> None:
        from equipoise.terminal.modes import print_modes

        print_modes(found)

    wanted.give(None, lambda: vibration().mode_drawings(found), found.to_dict, show)
