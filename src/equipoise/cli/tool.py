"""The command `tool`."""

from __future__ import annotations

from typing import Annotated

from equipoise.cli.app import FILE, OUT, SIGNED, app
from equipoise.cli.options import check_belonging, naming
from equipoise.cli.results import Kind


@app.command
def tool(
    file: Annotated[str, FILE],
    /,
    *,
    modes: bool = False,
    number: Annotated[str | None, SIGNED] = None,
    respond: Annotated[str | None, SIGNED] = None,
    speeds: Annotated[str | None, SIGNED] = None,
    at: Annotated[str | None, SIGNED] = None,
    exposure: bool = False,
    duration: Annotated[str | None, SIGNED] = None,
    vary: Annotated[str | None, SIGNED] = None,
    sensitivities: bool = False,
    design: bool = False,
    out: Annotated[str | None, OUT] = None,
    units: str = "",
    json: bool = False,
    csv: str | None = None,
    plot: str | None = None,
    format: Kind | None = None,
) -> None:
    """A hand-held tool: how its shaft vibrates, what the hands get, and what to change.

    Without one of --modes, --respond, --exposure, --vary, --sensitivities and --design it tells the
    first three.

    Parameters
    ----------
    file
        Path of a tool's file, with a table [shaft], or the name of a bundled example.
    modes
        Natural frequencies, eigenvalues with damping, shapes and their nodes.
    number
        With --modes or --vary: how many natural frequencies, 6 if not given.
    respond
        Transmission, forces and motion over a range of speeds of the engine: "2000 rpm : 9000 rpm".
    speeds
        Number of speeds in the range, 400 if not given; more are added about resonances.
    at
        With --respond: further places of the shaft to be told of, "300 mm, 1200 mm".
    exposure
        Weighted acceleration of the hands, and what a day of work amounts to.
    duration
        Time a day at the working speed, "2 h", in the place of the file's [[work]].
    vary
        Natural frequencies against a number of a station: "harness position = 0 mm : 400 mm".
    sensitivities
        What each number of the tool does to the hands, over the band of [design] or of [operation].
    design
        Change what [design] allows so that the hands feel least.
    out
        With --design: write the better tool to this new file.
    units
        Units of the printed tables where they are not to be mm, mm/s, m/s^2 and rpm: "um, rad/s".
    json
        Print one JSON object in SI units, natural frequencies in Hz, and nothing else.
    csv
        With --respond: write every figure against speed to this file.
    plot
        Draw what was asked for into this folder.
    format
        With --plot: kind of the pictures, svg if not given.
    """
    from equipoise.cli.tool_asked import Asked
    from equipoise.cli.tool_parts import PARTS, give
    from equipoise.schema.models import load_tool
    from equipoise.terminal.units import OF_VIBRATION, Units

    check_belonging("--plot", plot, format=format)
    check_belonging("--design", design or None, out=out)
    asked = Asked(
        load_tool(file),
        file,
        number,
        respond,
        speeds,
        duration,
        vary,
        at,
        Units.read(units, OF_VIBRATION),
    )
    chosen = {
        "modes": modes,
        "respond": any(one is not None for one in (respond, speeds, at, csv)),
        "exposure": exposure or duration is not None,
        "vary": vary is not None,
        "sensitivities": sensitivities,
        "design": design,
    }
    names = asked.names([name for name, is_chosen in chosen.items() if is_chosen])
    asked.check_places(csv, plot, out)
    with naming(file):
        parts = [PARTS[name](asked) for name in names]
    give(asked, parts, json, csv, plot, format or "svg", out)
