"""Measures of signals that are linear in the numbers to be found, as parts of a cone program.

A signal over equally spaced crank angles of a whole cycle is start (N,) + numbers @ columns (K, N),
real, or complex where it is a vector in the plane.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

import numpy as np

from equipoise.balancing.program import Affine, Block, Program
from equipoise.mechanism.balance import Measure, Objective
from equipoise.mechanism.model import Machine
from equipoise.mechanism.objectives import output_of, quantity_of
from equipoise.quantities import SI
from equipoise.signals import Array


@dataclass(frozen=True, eq=False)
class Signal:
    """start (N,) + numbers @ columns (K, N); turns of the crank in the N samples."""

    start: Array
    columns: Array
    turns: int = 1

    def at(self, numbers: Array) -> Array:
        """The signal (N,) for numbers (K,)."""
        found: Array = self.start + numbers @ self.columns
        return found

    def kept(self, orders: tuple[float, ...]) -> Signal:
        """The signal with these orders of the crank's speed only; all of them if there are none."""
        if not orders:
            return self
        both = np.vstack([self.start, self.columns])
        places = np.fft.fftfreq(both.shape[-1], 1 / both.shape[-1]) / self.turns
        wanted = np.any(np.isclose(np.abs(places)[:, None], orders, atol=1e-9), axis=1)
        kept: Array = np.fft.ifft(np.where(wanted, np.fft.fft(both), 0.0))
        if not np.iscomplexobj(both):
            kept = kept.real
        return Signal(kept[0], kept[1:], self.turns)

    def divided(self, scale: float) -> Signal:
        return Signal(self.start / scale, self.columns / scale, self.turns)


def measured(values: Array, measure: Measure) -> float:
    """Measure of a signal (N,) over a whole cycle."""
    if measure == "rms":
        return float(np.sqrt(np.mean(np.abs(values) ** 2)))
    if measure == "ripple":
        return float(np.sqrt(np.mean(np.abs(values - np.mean(values)) ** 2)))
    if measure == "peak":
        return float(np.max(np.abs(values)))
    if measure == "peak_to_peak":
        return float(np.max(values) - np.min(values))
    return float(2 * pi * np.mean(np.abs(values)))


def unit_of(objective: Objective, machine: Machine) -> str:
    """SI unit of a measure of an output."""
    quantity = quantity_of(objective, machine)
    if quantity is None:  # the area under what is no torque
        return f"{SI[output_of(objective.output, machine).dimension]} rad"
    return SI[quantity]


def mean_square_rows(signal: Signal, measure: Measure) -> tuple[Array, Array]:
    """Matrix (R, K) and vector (R,), R <= K + 1, of which |matrix numbers + vector| is the RMS.

    By the orthogonal factor of all samples, so that few rows are left and no digits are lost as in
    a Gram matrix.
    """
    both = np.vstack([signal.columns, signal.start])
    if measure == "ripple":
        both = both - np.mean(both, axis=1, keepdims=True)
    samples = np.concatenate([both.real, both.imag], axis=1) if np.iscomplexobj(both) else both
    upper = np.linalg.qr(samples.T, mode="r") / np.sqrt(both.shape[1])
    return upper[:, :-1], upper[:, -1]


def bound_measure(
    program: Program,
    numbers: Array,
    signal: Signal,
    measure: Measure,
    bound: Affine,
    name: str = "",
) -> None:
    """Keep a measure of a signal at or below a bound.

    Parameters
    ----------
    numbers : (K,) places of the signal's numbers in the program.
    bound : one row; where it is a limit by itself, `name` is the limit's, in the bound's unit.
    """
    if measure in {"rms", "ripple"}:
        matrix, vector = mean_square_rows(signal, measure)
        rows = _beside(bound, 1, Affine(matrix, numbers, vector))
        program.cones(rows, len(vector) + 1, name, Affine.fixed(np.eye(1, len(vector) + 1)[0]))
    elif measure == "peak" and np.iscomplexobj(signal.start):
        count = len(signal.start)
        parts = np.stack([signal.columns.real, signal.columns.imag], axis=-1)
        starts = np.stack([signal.start.real, signal.start.imag], axis=-1)
        inner = Affine(parts.reshape(len(parts), -1).T, numbers, starts.ravel())
        rows, slope = _beside(bound, count, inner), Affine.fixed(np.tile([1.0, 0.0, 0.0], count))
        program.gradually(Block("second-order", rows, 3, name, slope))
    else:
        _bound_sizes(program, numbers, signal, measure, bound, name)


def _bound_sizes(
    program: Program, numbers: Array, signal: Signal, measure: Measure, bound: Affine, name: str
) -> None:
    """Peak, peak to peak and area of a scalar signal, by linear rows."""
    value = Affine(signal.columns.T, numbers, signal.start)
    if measure == "peak":
        for sign in (1.0, -1.0):
            slope = Affine.fixed(np.ones(len(signal.start)))
            program.gradually(Block("nonnegative", bound + sign * value, 1, name, slope))
    elif measure == "peak_to_peak":
        high, low = program.numbers(2)
        for place, sign in ((high, -1.0), (low, 1.0)):
            program.gradually(Block("nonnegative", Affine.of(place, 1.0) + sign * value))
        width = Affine.of([high, low], [1.0, 1.0])
        program.nonnegative(bound - width, name, Affine.fixed(1.0))
    else:
        from scipy import sparse

        sizes = program.numbers(len(signal.start))
        columns, each = np.concatenate([sizes, numbers]), sparse.eye_array(len(sizes))
        for sign in (1.0, -1.0):
            factors = sparse.hstack([each, sign * value.factors])
            program.nonnegative(Affine(factors, columns, sign * value.constant))
        area = Affine.of(sizes, np.full(len(sizes), 2 * pi / len(sizes)))
        program.nonnegative(bound - area, name, Affine.fixed(1.0))


def _beside(bound: Affine, count: int, inner: Affine) -> Affine:
    """The bound as first row of each of `count` cones, followed by that cone's share of `inner`."""
    columns = np.concatenate([bound.columns, inner.columns])
    split = len(bound.columns)
    size = len(inner.constant) // count + 1
    factors, constant = np.zeros((count, size, len(columns))), np.zeros((count, size))
    factors[:, 0, :split], constant[:, 0] = bound.factors[0], bound.constant[0]
    factors[:, 1:, split:] = inner.factors.reshape(count, size - 1, -1)
    constant[:, 1:] = inner.constant.reshape(count, size - 1)
    return Affine(factors.reshape(count * size, -1), columns, constant.ravel())
