"""Lower bounds of the cost of rows over boxes of phases, and of masses: branch and bound.

A linear program for all boxes, each in rows and columns of its own.  What is returned follows from
its multipliers alone: any that are not negative bound the least from below, so that nothing rests
on how closely the program was solved.

Every measure is the largest of linear readings of a signal: of a mean square the reading along any
signal of length 1 (Cauchy and Schwarz), of a peak that at any crank angle, and so on.  So is the
cost that objectives make together, and any one reading bounds it from below.  A reading of a sum of
rows is a sum of functions of one phase each, linear in the numbers x_j of masses (x_0 = 1),

    cost >= sum_k R_k(phi_k, x),   R_k(phi, x) = sum_j x_j Re sum_n z_jkn exp(i n phi)

At given numbers its least over a box is found row by row.  About them, the slope by each number is
that of the middle, which what is allowed bounds, and a rest that is the less the smaller the box.

`box_bounds` bounds the cost over a box of phases and numbers from below.  What it takes for the
cost is exact in the middle and wrong at the ends by the square of the box's width, so that boxes
need not be small.  That whose bound is least is cut in two again and again, until none could hold
anything better by more than a stated share, or until so many have been looked at; the result then
has the least bound of those left.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field, replace
from functools import cached_property
from itertools import pairwise

import numpy as np

from equipoise.balancing.cylinder_phasing import AREA_SAMPLES, Cost, PhaseObjective, by_orders
from equipoise.balancing.jump_bounds import Forms, JumpReadings, linear_forms
from equipoise.balancing.jumping_rows import JumpingDesigns, smoothed
from equipoise.balancing.phase_grid import alike
from equipoise.balancing.rounding import TINY
from equipoise.dataclass import dataclass
from equipoise.signals import AT_ONCE, Array, Periodic

PENALTY = 1e4
"""Most that a limit may count, over what all objectives do: with an end to it, the program of a box
in which limits clash has a solution, too, whose multipliers show that."""


@dataclass(frozen=True, eq=False)
class Bounded:
    """Of B boxes: bounds (B,), numbers (B, K) with which readings are least, and the slopes (B, K)
    there of what counts.
    """

    bounds: Array
    numbers: Array
    slopes: Array


@dataclass(frozen=True, eq=False)
class FormSum:
    """A sum of groups of forms, times factors (B,); at most 1 where it is a limit."""

    groups: tuple[Forms, ...]
    factors: Array
    is_limit: bool = False


def least_of_forms(
    parts: Sequence[FormSum],
    low: Array,
    high: Array,
    start: Array,
    directions: Array,
    least: Array,
    slack: float,
) -> Bounded:
    """The least sum of parts with numbers between low and high (B, K), and directions (I, K) @
    numbers of at least so much (I,); limits are kept to a share `slack`.

    start : (B, K) numbers where no program is solved.
    """
    solution = None
    if low.shape[1]:
        solution = _solved(parts, low, high, directions, least, slack)
    numbers, prices, weights, pushed = (
        (start, None, None, np.zeros((len(low), len(least)))) if solution is None else solution
    )
    constant, slopes = np.zeros(len(low)), np.zeros(low.shape)
    place = 0
    for part in parts:
        price = np.ones(len(low))
        if part.is_limit:
            price = np.zeros(len(low)) if prices is None else prices.pop(0)
            constant -= price * (1 + slack)
        for forms in part.groups:
            weight = np.zeros(forms.constants.shape)
            if weights is not None:
                weight = weights[place]
            place += 1
            weight = _shared(weight, forms.at(numbers)) * (price * part.factors)[:, None]
            constant += np.sum(weight * forms.constants, axis=1)
            slopes += np.einsum("br,brk->bk", weight, forms.slopes)
    left = slopes - pushed @ directions
    bounds = constant + pushed @ least + np.sum(np.minimum(left * low, left * high), axis=1)
    return Bounded(bounds, numbers, slopes)


def _shared(weights: Array, values: Array) -> Array:
    """Weights (B, R) that are not negative and sum up to 1; of the largest where all are 0."""
    weights = np.maximum(weights, 0.0)
    whole = np.sum(weights, axis=1, keepdims=True)
    largest = np.eye(values.shape[1])[np.argmax(values, axis=1)]
    return np.asarray(np.where(whole > 0, weights / np.maximum(whole, TINY), largest))


def _solved(
    parts: Sequence[FormSum],
    low: Array,
    high: Array,
    directions: Array,
    least: Array,
    slack: float,
) -> tuple[Array, list[Array], list[Array], Array] | None:
    """Numbers (B, K); multipliers of limits (B,), of the forms of each group (B, R) and of the
    directions (B, I); None where the program is not solved.

    Columns of a box: its numbers over their ranges, the largest of each group, what limits are
    passed by.
    """
    from scipy import sparse
    from scipy.optimize import linprog

    (boxes, count), width = low.shape, np.maximum(high - low, TINY)
    groups = sum(len(part.groups) for part in parts)
    limits = sum(part.is_limit for part in parts)
    blocks, right = _rows(parts, low, width, directions, least, slack)
    matrix = np.concatenate(blocks, axis=1)
    cost = np.zeros((boxes, count + groups + limits))
    of_terms = [not part.is_limit for part in parts for _ in part.groups]
    cost[:, count : count + groups] = of_terms
    cost[:, count + groups :] = PENALTY
    ends = np.full((*cost.shape, 2), (-np.inf, np.inf))
    ends[:, :count] = (0.0, 1.0)
    ends[:, count + groups :, 0] = 0.0
    result = linprog(
        cost.ravel(),
        sparse.block_diag(matrix, format="csr"),
        np.concatenate(right, axis=1).ravel(),
        bounds=ends.reshape(-1, 2),
        method="highs",
    )
    if result.x is None or result.ineqlin.marginals is None:
        return None
    numbers = low + width * np.clip(result.x.reshape(boxes, -1)[:, :count], 0.0, 1.0)
    prices = np.maximum(-result.ineqlin.marginals.reshape(boxes, -1), 0.0)
    each = np.split(prices, np.cumsum([block.shape[1] for block in blocks])[:-1], axis=1)
    return numbers, [item[:, 0] for item in each[groups:-1]], each[:groups], each[-1]


def _rows(
    parts: Sequence[FormSum],
    low: Array,
    width: Array,
    directions: Array,
    least: Array,
    slack: float,
) -> tuple[list[Array], list[Array]]:
    """Rows (B, R, columns) of the program and what they are at most (B, R): those of the forms of
    each group, of the limits, and of the directions.
    """
    boxes, count = low.shape
    groups = [(part, forms) for part in parts for forms in part.groups]
    limits = [part for part in parts if part.is_limit]
    columns = count + len(groups) + len(limits)
    blocks, right = [], []
    for place, (part, forms) in enumerate(groups, count):
        factors = part.factors[:, None]
        block = np.zeros((*forms.constants.shape, columns))
        block[..., :count] = factors[..., None] * forms.slopes * width[:, None]
        block[..., place] = -1.0
        blocks.append(block)
        right.append(-factors * forms.at(low))
    for k, part in enumerate(limits, count + len(groups)):
        block = np.zeros((boxes, 1, columns))
        block[..., count : count + len(groups)] = [other is part for other, _ in groups]
        block[..., k] = -1.0
        blocks.append(block)
        right.append(np.full((boxes, 1), 1 + slack))
    block = np.zeros((boxes, len(least), columns))
    block[..., :count] = -directions * width[:, None]
    return [*blocks, block], [*right, low @ directions.T - least]


HALVINGS = 48
"""Halvings of a side at most: what is left of a turn is some twenty steps of double precision, so
that phases in such a box count as equal."""
POINTS = 7
"""At which a row's function is taken over its interval: the bound allows for what lies between, by
the square of their distance, so that more of them gain where boxes are wide alone."""
PEAK_SAMPLES = 720
"""In a turn, at which a peak is read: a bound holds whichever is read, and is the better the nearer
to the top; of order 10 they miss 0.1 % at most."""
MOST_AT_ONCE = 2**25
"""Products of points and amplitudes over which boxes are bounded together: half a GiB."""
MOST_CUTS, STIFF, STEPS, SMALL = 60, 1e3, 10, 1e-6
"""Directions in which numbers are bounded, each of which is a row of every box's program; how hard
they are pushed back, and in how many steps; share of an objective from which it counts as that much
where it vanishes, as the slope of its root has no end there."""


@dataclass(frozen=True, eq=False)
class Numbers:
    """K numbers in which signals are linear, and which may be chosen with the phases.

    columns : of each term, what a unit of each number adds to its amplitudes, (K, V, m, C, N).
    low, high, start : (K,) ends of each, and the best known.
    least : of a direction (K,), the least of direction @ numbers over all that is allowed.
    jumping : of each term, the rows by these numbers as functions of the crank angle, where its
        extremes jump.
    cuts : directions (K,) with their least.
    """

    columns: tuple[Array, ...]
    low: Array
    high: Array
    start: Array
    least: Callable[[Array], float]
    jumping: tuple[JumpingDesigns | None, ...] = ()
    cuts: list[tuple[Array, float]] = field(default_factory=list)

    @classmethod
    def none(cls, cost: Cost) -> Numbers:
        """Where phases alone are free."""
        nothing = np.zeros(0)
        columns = tuple(term.signals.amplitudes[None][:0] for term in cost.measured)
        return cls(columns, nothing, nothing, nothing, lambda _: 0.0)

    def of_terms(self, count: int) -> Numbers:
        """What the same numbers do to the first terms."""
        return replace(self, columns=self.columns[:count], jumping=self.jumping[:count])

    def cut(self, slope: Array) -> None:
        """Learn how far the numbers can go against a slope (K,)."""
        size = float(np.max(np.abs(slope) * (self.high - self.low), initial=0.0))
        if size > 0 and len(self.cuts) < MOST_CUTS:
            self.cuts.append((slope / size, self.least(slope / size)))

    @property
    def directions(self) -> tuple[Array, Array]:
        """The cuts' directions (I, K), and their least (I,)."""
        result = np.array([item for item, _ in self.cuts]).reshape(len(self.cuts), len(self.low))
        return result, np.array([least for _, least in self.cuts])


@dataclass(frozen=True, eq=False)
class Boxes:
    """Boxes of phases and numbers.

    middles : of the phases (B, m), rad.  halvings : how often each of their sides was halved.
    low, high : of the numbers (B, K).  numbers : (B, K) about which the bound was taken.
    bounds : (B,).  widest : (B,) the row whose side is to be cut; beyond the rows, the number.
    """

    middles: Array
    halvings: Array
    low: Array
    high: Array
    numbers: Array
    bounds: Array
    widest: Array

    def of(self, places: Array) -> Boxes:
        """Some of them."""
        return Boxes(*(each[places] for each in vars(self).values()))

    def with_more(self, other: Boxes) -> Boxes:
        pairs = zip(vars(self).values(), vars(other).values(), strict=True)
        return Boxes(*(np.concatenate(pair) for pair in pairs))


@dataclass(frozen=True, eq=False)
class Bounder:
    """Bounds the cost over boxes.

    cost : where all numbers are 0.
    prices : what the cost falls by for as much more of each limit as it is; any bound what is
        allowed, as long as none is negative, and the right ones do it best.
    jumps : of each term and limit whose extremes jump, what bounds it where phases alone are free.
    designs : of the same, what reads it where numbers are free too.
    """

    cost: Cost
    numbers: Numbers
    prices: tuple[float, ...]
    jumps: Mapping[int, JumpReadings] = field(default_factory=dict)
    designs: Mapping[int, JumpReadings] = field(default_factory=dict)

    @classmethod
    def of(cls, cost: Cost, numbers: Numbers | None, prices: tuple[float, ...]) -> Bounder:
        """For a cost whose terms may jump: read smoothed, and by the pieces between jumps."""
        if numbers is None:
            jumps = {
                place: JumpReadings(JumpingDesigns((rows,)), term.measure)
                for place, term in enumerate(cost.measured)
                if (rows := term.jumping) is not None
            }
            return cls(cost.smoothed, Numbers.none(cost.smoothed), prices, jumps)
        designs, columns = {}, list(numbers.columns)
        pairs = zip(cost.measured, numbers.jumping, strict=False)
        for place, (term, by_number) in enumerate(pairs):
            if term.jumping is not None and by_number is not None:
                designs[place] = JumpReadings(by_number, term.measure)
                columns[place] = smoothed(columns[place], term.signals.turns)
        numbers = replace(numbers, columns=tuple(columns))
        return cls(cost.smoothed, numbers, prices, designs=designs)

    @property
    def most_at_once(self) -> int:
        """Boxes that are bounded together at most: few where signals have very many orders."""
        of_one = (1 + len(self.numbers.low)) * self.cost.rows * len(self._orders) * POINTS
        return max(1, MOST_AT_ONCE // (2 * of_one))

    @property
    def half(self) -> float:
        """Half a period, rad."""
        return self.cost.period / 2

    def bounded(self, boxes: Boxes) -> tuple[Boxes, Array, Array]:
        """Boxes with their bounds and numbers; there the cost (B,) in their middles, as it is read,
        and its slopes (B, K) by the numbers.

        A box in which some limit cannot be kept is bounded by infinity.
        """
        turning = np.exp(1j * boxes.middles[..., None] * self._orders)
        totals = [
            np.einsum("jvkcn,bkn->bjvcn", each, turning[..., : each.shape[-1]], optimize=True)
            for each in self._amplitudes
        ]
        if self.designs:
            return self._by_forms(boxes, totals, turning)
        for _ in range(2):
            boxes, pushed = self._near_best(boxes, totals)
        readings = [self._reading(*each, boxes) for each in self._each(totals)]
        count = len(self.cost.terms)
        values, reading = self._combined(readings[:count])
        worth, priced, impossible = values, reading, np.zeros(len(values), bool)
        limits = zip(self.cost.limits, self.prices, readings[count:], strict=True)
        for term, price, (value, item) in limits:
            lost, _, _ = self._over(boxes, item * turning[:, None], 0 * pushed)
            impossible |= value - lost > term.scale * (1 + SMALL)
            worth = worth + price * (value / term.scale - 1)
            priced = priced + price / term.scale * item
        lost, bends, slopes = self._over(boxes, priced * turning[:, None], pushed)
        bounds = np.maximum(worth - lost, boxes.bounds)
        if any(self.prices):
            lost, _, _ = self._over(boxes, reading * turning[:, None], 0 * pushed)
            bounds = np.maximum(values - lost, bounds)
        bounds = np.where(impossible, np.inf, bounds)
        widest = np.where(np.max(bends, axis=1) > 0, np.argmax(bends, axis=1), 1)
        boxes = replace(boxes, bounds=bounds, widest=widest)
        if self.jumps:
            boxes, values = self._by_pieces(boxes, readings, turning)
        return boxes, values, slopes

    def _by_pieces(
        self, boxes: Boxes, readings: list[tuple[Array, Array]], turning: Array
    ) -> tuple[Boxes, Array]:
        """Boxes with the bounds that terms have each by itself, those that jump by their pieces,
        where these are better; and the cost in their middles.
        """
        lows, middles = [], []
        halves, drops = self.half / 2.0**boxes.halvings, np.zeros(boxes.middles.shape)
        none = np.zeros((len(boxes.bounds), 0))
        for place, (value, reading) in enumerate(readings):
            lost, bends, _ = self._over(boxes, reading * turning[:, None], none)
            low = np.maximum(value - lost, 0.0)
            middles.append(value)
            if (jump := self.jumps.get(place)) is not None:
                over = jump.over(boxes.middles, halves)
                low, bends = np.maximum(low, over.bounds), over.losses
                middles[-1] = np.maximum(value, over.values)
            lows.append(low)
            drops += bends / self.cost.measured[place].scale
        apart = self.cost.of(lows)
        by_pieces = apart > boxes.bounds
        widest = np.where(by_pieces, np.maximum(np.argmax(drops, axis=1), 1), boxes.widest)
        bounds = np.maximum(apart, boxes.bounds)
        return replace(boxes, bounds=bounds, widest=widest), self.cost.of(middles)

    def _by_forms(
        self, boxes: Boxes, totals: list[Array], turning: Array
    ) -> tuple[Boxes, Array, Array]:
        """Bounds where numbers are free and terms jump: readings at many crank angles at once,
        whose smallest possible maximum a linear program gives.
        """
        halves, losses = self.half / 2.0**boxes.halvings, np.zeros(boxes.middles.shape)
        values, here, parts, terms = [], [], [], len(self.cost.terms)
        for place, (term, total, amplitudes) in enumerate(self._each(totals)):
            value, reading = self._reading(term, total, amplitudes, boxes)
            form, bends = self._form(boxes, reading * turning[:, None])
            groups: tuple[Forms, ...] = (form,)
            lost = bends
            if (jump := self.designs.get(place)) is not None and jump.possible:
                ends = boxes.numbers, boxes.low, boxes.high
                read = jump.readings(boxes.middles, halves, *ends)
                groups, lost = read.groups, read.losses
                value = np.maximum(value, read.values)
                if len(groups) == 1:
                    groups = (groups[0].with_more(form),)
            values.append(value)
            here.append(sum(np.max(item.at(boxes.numbers), axis=1) for item in groups))
            parts.append(FormSum(groups, np.full(len(value), 1.0 / term.scale), place >= terms))
            losses += lost / term.scale
        shares = self._shares(self.cost.factors[:, None] * values[:terms])
        for place, share in enumerate(shares):
            parts[place] = replace(parts[place], factors=share * self.cost.factors[place])
        ends = boxes.low, boxes.high, boxes.numbers
        bounded = least_of_forms(parts, *ends, *self.numbers.directions, SMALL)
        bounds, cost = np.maximum(bounded.bounds, boxes.bounds), self.cost.of(values)
        # what the phases' sides lose at these numbers, and what the numbers' sides lose beyond it
        above, beyond = cost - self.cost.of(here), self.cost.of(here) - bounds
        widest = np.argmax(losses + TINY * halves * (np.arange(self.cost.rows) > 0), axis=1)
        by_number = self.cost.rows + np.argmax(
            np.abs(bounded.slopes) * (boxes.high - boxes.low), axis=1
        )
        of_phases = (above >= beyond) | (len(self.numbers.low) == 0)
        boxes = replace(boxes, numbers=bounded.numbers, bounds=bounds)
        return replace(boxes, widest=np.where(of_phases, widest, by_number)), cost, bounded.slopes

    def _form(self, boxes: Boxes, turned: Array) -> tuple[Forms, Array]:
        """A reading, turned to the middles (B, 1 + K, m, N), as a form over boxes (B,); and how far
        the sides of each row let it fall (B, m).
        """
        along = np.swapaxes((np.swapaxes(turned, 1, 2) @ self._points[boxes.halvings]).real, 1, 2)
        spacing = 2 * self.half / 2.0**boxes.halvings / (POINTS - 1)
        bend = np.abs(turned) @ self._orders**2 * spacing[:, None] ** 2 / 8
        least, most = np.min(along, axis=3) - bend, np.max(along, axis=3) + bend
        middle = along[..., POINTS // 2]
        least[..., 0] = most[..., 0] = middle[..., 0]  # row 1 is not moved
        whole = _with_one(boxes.numbers)[..., None]
        drops = np.sum(whole * middle - np.minimum(whole * least, whole * most), axis=1)
        least, most = (np.sum(item, axis=2)[:, None] for item in (least, most))
        return linear_forms(least, most, boxes.low, boxes.high), drops

    def _each(self, totals: list[Array]) -> list[tuple[PhaseObjective, Array, Array]]:
        return list(zip(self.cost.measured, totals, self._amplitudes, strict=True))

    def _over(self, boxes: Boxes, turned: Array, pushed: Array) -> tuple[Array, Array, Array]:
        """How far a reading, turned to the middles (B, 1 + K, m, N), falls over boxes (B,); the
        share of each row and number in it (B, m + K); its slopes (B, K) by the numbers.

        pushed : (B, I) multipliers of the cuts.
        """
        along = np.swapaxes((np.swapaxes(turned, 1, 2) @ self._points[boxes.halvings]).real, 1, 2)
        middle = along[..., POINTS // 2]
        # Between points a function falls below their chord by no more than its bend allows.
        spacing = 2 * self.half / 2.0**boxes.halvings / (POINTS - 1)
        whole = _with_one(boxes.numbers)
        here = np.einsum("bj,bjkp->bkp", whole, along)
        bend = np.abs(np.einsum("bj,bjkn->bkn", whole, turned)) @ self._orders**2
        drops = here[..., POINTS // 2] - np.min(here, axis=2) + bend * spacing**2 / 8
        drops[:, 0] = 0.0
        curvature = np.abs(turned[:, 1:]) @ self._orders**2 * spacing[:, None] ** 2 / 8
        rise, fall = (
            np.sum((end(along[:, 1:], axis=3) - middle[:, 1:] + sign * curvature)[:, :, 1:], axis=2)
            for end, sign in ((np.max, 1.0), (np.min, -1.0))
        )
        slopes = np.sum(middle[:, 1:], axis=2)
        low, high = boxes.low - boxes.numbers, boxes.high - boxes.numbers
        rest = -np.min([rise * low, rise * high, fall * low, fall * high], axis=0, initial=0.0)
        by_number, gained = self._by_cuts(boxes, slopes, pushed, low, high)
        bends = np.concatenate([drops, rest + by_number], axis=1)
        return np.sum(bends, axis=1) - gained, bends, slopes

    def _by_cuts(
        self, boxes: Boxes, slopes: Array, pushed: Array, low: Array, high: Array
    ) -> tuple[Array, Array]:
        """How far slopes lead down over the numbers: (B, K), less what the cuts keep (B,)."""
        plain = -np.minimum(slopes * low, slopes * high)
        directions, least = self.numbers.directions
        left = slopes - pushed @ directions
        bounds = -np.minimum(left * low, left * high)
        gained = np.sum(pushed * (least - boxes.numbers @ directions.T), axis=1)
        better = np.sum(bounds, axis=1) - gained < np.sum(plain, axis=1)
        return np.where(better[:, None], bounds, plain), np.where(better, gained, 0.0)

    # -- readings ----------------------------------------------------------------------------------

    @cached_property
    def _amplitudes(self) -> list[Array]:
        """Of each term as it is, and by each number, (1 + K, V, m, C, N)."""
        pairs = zip(self.cost.measured, self.numbers.columns, strict=True)
        return [np.concatenate([item.signals.amplitudes[None], columns]) for item, columns in pairs]

    @cached_property
    def _orders(self) -> Array:
        return max((term.signals.orders for term in self.cost.measured), key=len)

    @cached_property
    def _points(self) -> Array:
        """exp(i n d) (levels, N, POINTS) at points d of an interval halved so many times."""
        places = np.linspace(-1.0, 1.0, POINTS)
        halves = self.half / 2.0 ** np.arange(HALVINGS + 2)
        return np.exp(1j * self._orders[:, None] * halves[:, None, None] * places)

    def _reading(
        self, term: PhaseObjective, total: Array, amplitudes: Array, boxes: Boxes
    ) -> tuple[Array, Array]:
        """Value (B,) of a term in the middles of boxes, and its reading (B, 1 + K, m, N)."""
        whole = np.einsum("bj,bjvcn->bvcn", _with_one(boxes.numbers), total)
        values, readings, loudest = largest_reading(term, whole)
        if amplitudes.shape[1] == 1:
            result = np.einsum("bcn,jkcn->bjkn", readings, amplitudes[:, 0], optimize=True)
        else:
            result = np.einsum("bcn,jbkcn->bjkn", readings, amplitudes[:, loudest])
        missing = len(self._orders) - result.shape[-1]
        return values, np.pad(result, ((0, 0),) * 3 + ((0, missing),))

    def _combined(self, readings: list[tuple[Array, Array]]) -> tuple[Array, Array]:
        """The cost (B,), and the reading (B, 1 + K, m, N) of it."""
        parts = self.cost.factors[:, None] * [value for value, _ in readings]
        shares = self._shares(parts)
        factors = shares * self.cost.factors[:, None]
        pairs = zip(factors, readings, strict=True)
        reading = sum(factor[:, None, None, None] * item for factor, (_, item) in pairs)
        return np.sum(shares * parts, axis=0), np.asarray(reading)

    def _shares(self, parts: Array) -> Array:
        """Slopes (T, B) of the cost by its parts (T, B)."""
        if self.cost.combine == "sum":
            return np.ones(parts.shape)
        return np.asarray(parts / np.maximum(np.linalg.norm(parts, axis=0), TINY))

    # -- numbers -----------------------------------------------------------------------------------

    def _near_best(self, boxes: Boxes, totals: list[Array]) -> tuple[Boxes, Array]:
        """Boxes with the numbers of least mean-square cost in their middles, and multipliers (B, I)
        of the cuts that limit them.

        One step of reweighted least squares: Newton's method within each box's ends.
        """
        x, (directions, least) = boxes.numbers, self.numbers.directions
        if not len(self.numbers.low):
            return boxes, np.zeros((len(x), 0))
        gram = self._gram(x, totals)
        second, first, each = gram[:, 1:, 1:], gram[:, 1:, 0], np.arange(x.shape[1])
        widths = self.numbers.high - self.numbers.low
        stiff = STIFF * np.max(second[:, each, each] * widths**2, axis=1)[:, None]
        second = second + CONVEX * np.eye(len(each)) * stiff[..., None] / np.max(widths**2)
        for _ in range(STEPS):
            pushed = stiff * np.maximum(least - x @ directions.T, 0.0)
            slope = first + np.einsum("bij,bj->bi", second, x) - pushed @ directions
            stopped = ((x <= boxes.low) & (slope > 0)) | ((x >= boxes.high) & (slope < 0))
            firm = stiff * (pushed > 0)
            bend = second + np.einsum("bi,ij,ik->bjk", firm, directions, directions, optimize=True)
            bend = np.where(stopped[:, :, None] | stopped[:, None], 0.0, bend)
            bend[:, each, each] += stopped
            step = np.linalg.solve(bend, np.where(stopped, 0.0, slope)[..., None])[..., 0]
            x = np.clip(x - step, boxes.low, boxes.high)
        return replace(boxes, numbers=x), stiff * np.maximum(least - x @ directions.T, 0.0)

    def _gram(self, x: Array, totals: list[Array]) -> Array:
        """The cost's square (B, 1 + K, 1 + K) over itself at numbers (B, K): its slope is that of
        the cost.
        """
        sizes, grams = [], []
        for term, total, _ in self._each(totals):
            here = np.einsum("bj,bjvcn->bvcn", _with_one(x), total)
            size = np.sqrt(np.sum(np.abs(here) ** 2 * term.shares, axis=(2, 3)))
            places, loudest = np.arange(len(x)), np.argmax(size, axis=1)
            item = (total[places, :, loudest] * np.sqrt(term.shares)).reshape(*total.shape[:2], -1)
            grams.append((item.conj() @ np.swapaxes(item, 1, 2)).real)
            sizes.append(np.maximum(size[places, loudest], SMALL * term.scale))
        parts = self.cost.factors[:, None] * sizes[: len(self.cost.terms)]
        factors = self._shares(parts) * self.cost.factors[:, None]
        pairs = zip(self.prices, self.cost.limits, strict=True)
        prices = np.array([price / term.scale for price, term in pairs]).reshape(-1, 1)
        whole = np.vstack([factors, np.repeat(prices, len(x), axis=1)]) / sizes
        return np.asarray(np.einsum("tb,tbij->bij", whole, np.array(grams)))


def _with_one(numbers: Array) -> Array:
    """Numbers (B, 1 + K) with the 1 of what is there anyway."""
    return np.concatenate([np.ones((len(numbers), 1)), numbers], axis=1)


def largest_reading(term: PhaseObjective, total: Array) -> tuple[Array, Array, Array]:
    """Value (B,) of a term of signals (B, V, C, N), and amplitudes (B, C, N) of the reading that is
    the term's there, and nowhere more than it; and which speed (B,) is read, the loudest.
    """
    if by_orders(term.measure):
        sizes = term.each(total)
        readings = total.conj() * term.shares / np.maximum(sizes, TINY)[..., None, None]
    else:
        sizes, readings = _read_in_time(term, total)
    places, loudest = np.arange(len(total)), np.argmax(sizes, axis=1)
    return sizes[places, loudest], readings[places, loudest], loudest


def _read_in_time(term: PhaseObjective, total: Array) -> tuple[Array, Array]:
    """Values (B, V) of signals (B, V, C, K + 1) as they are read at crank angles, and the readings
    (B, V, C, K + 1).
    """
    turns, area = term.signals.turns, term.measure == "area"
    count = (AREA_SAMPLES if area else PEAK_SAMPLES) * turns
    step = max(1, AT_ONCE // (total[0].size + total[0, ..., 0].size * count)) if len(total) else 1
    if len(total) > step:
        parts = [_read_in_time(term, total[k : k + step]) for k in range(0, len(total), step)]
        sizes, readings = (np.concatenate(part) for part in zip(*parts, strict=True))
        return sizes, readings
    values = Periodic(total, turns).samples(count)
    if area:
        signs = np.sign(values[..., :1, :])
        orders = np.arange(total.shape[-1]) % count
        readings = (2 * np.pi / count) * np.fft.fft(signs, axis=-1)[..., orders].conj()
        return 2 * np.pi * np.mean(np.abs(values[..., 0, :]), axis=-1), readings

    def at(places: Array) -> tuple[Array, Array]:
        """Values (B, V, C) at crank angles (B, V), and their waves (B, V, 1, K + 1)."""
        result = np.take_along_axis(values, places[..., None, None], axis=-1)[..., 0]
        theta = places * (2 * np.pi * turns / count)
        return result, np.exp(1j * np.multiply.outer(theta, term.signals.orders))[..., None, :]

    if values.shape[2] > 1:
        outcome, wave = at(np.argmax(np.sum(values**2, axis=2), axis=-1))
        sizes = np.linalg.norm(outcome, axis=-1)
        return sizes, (outcome / np.maximum(sizes, TINY)[..., None])[..., None] * wave
    (high, rising), (low, falling) = (
        at(pick(values[..., 0, :], axis=-1)) for pick in (np.argmax, np.argmin)
    )
    if term.measure == "peak_to_peak":
        return (high - low)[..., 0], rising - falling
    upper = high >= -low
    return np.maximum(high, -low)[..., 0], np.where(upper[..., None], rising, -falling)


SLACK, CONVEX = 1e-6, 1e-9
"""Share of the room below the least value that is rounding of its bound; share of the stiffness
that is added to squares, so that those of a singular Gram matrix are strictly convex."""
CLOSE = 1e-4
"""Between cost and bound, over the cost before, at which the search ends."""
MOST_BOXES, HOPELESS, BATCH = 40_000, 10_000, 512
"""Boxes that are looked at, half as many with numbers; where none of these bounds anything, as of
many rows; cut in two at once."""
BETTER, ROUNDING = 1e-9, 1e-9
"""Shares of the cost before: what is better by less is as good; what a bound may be above by
rounding."""
LEAST_PART = 0.2
"""Share of a number's range that a cut leaves on either side: one at its end would leave a box as
large as before."""

Improve = Callable[[Array, float], tuple[Array, float]]
"""Leads from phases (m,), at which the cost looks like so much, to the best next to them with its
cost; infinite where these are no better than is known."""


@dataclass(frozen=True, eq=False)
class PhaseProof:
    """phases : the best that were found (m,), rad.  bound : of the cost.  boxes : looked at.

    complete : whether the search ended as near to the best as it was to come.
    """

    phases: Array
    bound: float
    boxes: int
    complete: bool


def prove(
    cost: Cost,
    phases: Array,
    improve: Improve,
    numbers: Numbers | None = None,
    least: float | None = None,
    close: float = CLOSE,
    prices: tuple[float, ...] = (),
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> PhaseProof:
    """Bound the cost from below over all phases, and over all numbers; row 1 is at 0.

    Parameters
    ----------
    cost : where all numbers are 0.
    phases : (m,) the best known, rad.  least : cost there, with the best numbers known.
    prices : of each limit, where they are known; see `Bounder`.
    progress : is called with the boxes looked at, and how many these are at most.
    """
    prices = prices or (0.0,) * len(cost.limits)
    bounder = Bounder.of(cost, numbers, prices)
    known = float(cost.values(phases)) if least is None else least
    return _PhaseSearch(cost, bounder, improve, close).run(phases, known, progress)


@dataclass(frozen=True, eq=False)
class _PhaseSearch:
    cost: Cost
    bounder: Bounder
    improve: Improve
    close: float

    def run(self, phases: Array, least: float, progress: Callable[[int, int], None]) -> PhaseProof:
        best, looked, room = phases, 1, self.close * self.cost.whole
        most = MOST_BOXES // (2 if len(self.numbers.low) else 1)
        batch = min(BATCH, self.bounder.most_at_once)
        boxes, _, _ = self.bounder.bounded(self._first)
        left = np.inf
        while len(boxes.bounds) and np.min(boxes.bounds) < least - room:
            if looked >= (most if np.min(boxes.bounds) > 0 else HOPELESS):
                break
            progress(looked, most)
            order = np.argsort(boxes.bounds, kind="stable")
            cut, values, slopes = self.bounder.bounded(self._halves(boxes.of(order[:batch])))
            looked += len(values)
            if len(values):
                self.numbers.cut(slopes[np.argmin(cut.bounds)])
                if np.min(values) < least - BETTER * self.cost.whole:
                    place = np.argmin(values)
                    result, value = self.improve(cut.middles[place], float(values[place]))
                    best, least = (result, value) if value < least else (best, least)
            boxes = boxes.of(order[batch:]).with_more(cut)
            closed = (boxes.bounds >= least - room) | (np.max(boxes.halvings, axis=1) > HALVINGS)
            left = min(left, float(np.min(boxes.bounds[closed], initial=np.inf)))
            boxes = boxes.of(~closed)
        bound = min(least, left, float(np.min(boxes.bounds, initial=np.inf)))
        return PhaseProof(best, bound, looked, bound >= least - (1 + SLACK) * room)

    @property
    def numbers(self) -> Numbers:
        return self.bounder.numbers

    @property
    def _first(self) -> Boxes:
        """All phases and numbers, as one box."""
        middles = np.full((1, self.cost.rows), self.bounder.half)
        middles[:, 0] = 0.0
        ends, values = self.numbers, np.zeros(1)
        low, high, start = ends.low[None], ends.high[None], ends.start[None]
        return Boxes(
            middles, np.zeros(middles.shape, int), low, high, start, values, values.astype(int)
        )

    def _halves(self, boxes: Boxes) -> Boxes:
        """Boxes cut in two, of which those are left out in which nothing is allowed.

        Of equal rows only rising phases are looked at, since they may be swapped.
        """
        rows, each = self.cost.rows, np.arange(len(boxes.bounds))
        turned = boxes.widest < rows
        halvings, step = boxes.halvings.copy(), np.zeros(boxes.middles.shape)
        at = each[turned], boxes.widest[turned]
        halvings[at] += 1
        step[at] = self.bounder.half / 2.0 ** halvings[at]
        low, high = np.vstack([boxes.low] * 2), np.vstack([boxes.high] * 2)
        at = each[~turned], boxes.widest[~turned] - rows
        ends, width = boxes.low[at], boxes.high[at] - boxes.low[at]
        here = (boxes.numbers[at] - ends) / np.maximum(width, TINY)
        here = np.clip(here, LEAST_PART, 1 - LEAST_PART)
        high[at] = low[at[0] + len(each), at[1]] = ends + width * (here + 0.5) / 2
        twice = boxes.of(np.tile(each, 2))
        middles = np.vstack([boxes.middles - step, boxes.middles + step])
        numbers = np.clip(twice.numbers, low, high)
        result = Boxes(
            middles, np.vstack([halvings] * 2), low, high, numbers, twice.bounds, twice.widest
        )
        return result.of(self._possible(result))

    def _possible(self, boxes: Boxes) -> Array:
        """Whether boxes (B,) hold anything that is allowed, and nothing that others hold too."""
        halves, values = self.bounder.half / 2.0**boxes.halvings, np.ones(len(boxes.bounds), bool)
        for item, other in self._ordered:
            low = boxes.middles[:, item] - halves[:, item]
            values &= low < boxes.middles[:, other] + halves[:, other]
        for direction, least in self.numbers.cuts:
            most = np.sum(np.maximum(direction * boxes.low, direction * boxes.high), axis=1)
            values &= most >= least - ROUNDING
        return values

    @cached_property
    def _ordered(self) -> list[tuple[int, int]]:
        """Pairs of equal rows, row 1 left out."""
        groups = ([k for k in group if k > 0] for group in alike(self.cost, self.numbers.columns))
        return [pair for group in groups for pair in pairwise(group)]
