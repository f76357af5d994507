"""What a page is sent of a record: its signals at the crank angles of the curves beside them."""

from __future__ import annotations

import numpy as np

from equipoise.errors import EquipoiseError
from equipoise.web.block import FloatBlock, Values
from equipoise.web.edits import Computed
from equipoise.web.figures import told_signals
from equipoise.web.recorded import MeasuredSignals, compared_with
from equipoise.web.shaken import SAMPLES

GAUGES = "gauges."


def gauges_of(computed: Computed) -> tuple[str, ...]:
    """Names of the gauges of a machine's support."""
    support = computed.design.machine.support
    return () if support is None else tuple(support.gauges)


def charted(output: str) -> bool:
    """Whether an output has a chart without being asked for."""
    if output.startswith("joints."):
        return output.count(".") == 1
    return output in told_signals()


def measured_told(
    record: MeasuredSignals | None, computed: Computed, block: FloatBlock
) -> Values | None:
    """A record beside a design: its name and what is to be said; signals go to the block.

    ``measured.`` and the name of an output : (N,) SI units, NaN in gaps; what gauges read has as
    many numbers as their response.
    """
    if record is None:
        return None
    try:
        compared = compared_with(record, computed.analysis, gauges_of(computed))
    except EquipoiseError as error:  # of a machine that has been changed meanwhile
        return {"name": record.name, "told": [str(error)], "left_out": []}
    for name, values in compared.signals.items():
        count, own = len(values), len(values)
        if name.startswith(GAUGES):
            count = SAMPLES * computed.motion.turns
        at = np.arange(count) * own / count
        block.add(f"measured.{name}", np.interp(at, np.arange(own), values, period=own))
    text = {"told": [*compared.told], "left_out": [*compared.left_out]}
    return {"name": record.name, **text}
