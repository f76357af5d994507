"""Pictures of pages that need more than a machine: a day of work, a record, a study, a drawing.

``/demonstrations/NAME/PICTURE.svg`` is one of those that the function of that name writes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path

import numpy as np

import equipoise as eq
from equipoise.cli import run

DAY = ("brush saw: 4.6 m/s^2 for 2 h", "felling: 6.0 m/s^2 for 1 h", "stripping: 3.6 m/s^2 for 2 h")
"""A forester's day of ISO 5349-2, E.3, as in `exposure.md`."""
STUDY = "study-of-lengths"
RIG = "yamashita-rig"
"""Examples of the pages."""
DRAWN = (0.5, 4.2, 7.8, 11.4)
"""Of a sheet of A4: left, bottom, right and top of what is not empty, inches."""


def exposure(folder: Path) -> None:
    """A(8) of a day against hours of work."""
    _run("exposure", *DAY, "--plot", str(folder))


def decay(folder: Path) -> None:
    """The decay of `decay.md`, read from a record."""
    decay = eq.measured.simulate_decay(
        np.linspace(0, 5, 2500),
        natural_frequency=12.4, damping_ratio=0.02, coulomb=0.5e-3, start=0.04, noise=1e-4,
    )  # fmt: skip
    lines = [f"{t:.4f},{1e3 * x:.4f}" for t, x in zip(decay.time, decay.displacement, strict=True)]
    record = folder / "rig.csv"
    record.write_text("\n".join(["time [s],displacement [mm]", *lines, ""]), encoding="utf-8")
    _run("decay", str(record), "--stiffness", "2 N/mm", "--plot", str(folder))


def studies(folder: Path) -> None:
    """The best designs of a bundled study."""
    store = str(folder / "designs.zarr")
    _run("sweep", STUDY, "-o", store)
    _run("best", store, "--plot", str(folder))


def workshop(folder: Path) -> None:
    """The sheet of the counterweight that is advised for a machine on its mounts."""
    from matplotlib.transforms import Bbox

    from equipoise.exchange.formats import Job
    from equipoise.figures.workshop_sheet import sheets

    advice = eq.balancing.advise(eq.load(RIG))
    with sheets(Job(advice.machine, changes=advice.changes)) as (sheet,):
        sheet.savefig(
            folder / "counterweight.svg",
            bbox_inches=Bbox.from_extents(*DRAWN),
            metadata={"Date": None},
        )


DEMONSTRATIONS: Mapping[str, Callable[[Path], None]] = {
    shown.__name__: shown for shown in (exposure, decay, studies, workshop)
}


def _run(*words: str) -> None:
    """A command, whose messages are of no use to who makes the documentation, unless it fails."""
    with redirect_stdout(StringIO()), redirect_stderr(StringIO()) as messages:
        status = run(list(words))
    if status:
        raise RuntimeError(f"equipoise {' '.join(words)}: {messages.getvalue()}")
