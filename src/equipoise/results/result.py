"""What all results share: plain data, tables, pictures, blocks, and the words of a machine."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import fields
from numbers import Number
from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np

from equipoise.displays import Displayed, room
from equipoise.errors import UsageError
from equipoise.i18n import Note, to_say, wording
from equipoise.mechanism.parts.machine import Machine
from equipoise.mechanism.parts.shown_units import units_of
from equipoise.quantities import column_heading, showing_by_default
from equipoise.results.declaring import Declarations, columns_of, figures_of, values_of
from equipoise.signals import Array

if TYPE_CHECKING:
    import pandas
    import xarray

    from equipoise.results.blocks import Block
    from equipoise.results.charts import Chart

OF_CYCLES: Mapping[str, str] = {
    "{value} at crank angle {angle}": to_say("{value} at {angle} of the cycle"),
    "at crank angle {angle}": to_say("at {angle} of the cycle"),
    "{what}: up to {peak}, at crank angle {angle}": to_say(
        "{what}: up to {peak}, at {angle} of the cycle"
    ),
    "Joint {name} carries most at crank angle {angle}": to_say(
        "Joint {name} carries most at {angle} of the cycle"
    ),
    "{point} goes farthest: {length} in a turn of the crank": to_say(
        "{point} goes farthest: {length} in a cycle"
    ),
    "crank angle: phase of the cycle": to_say("angle of the cycle"),
    "crank angle": to_say("angle of the cycle"),
    "numbers: crank angle, deg": to_say("numbers: angle of the cycle, deg"),
    "in {unit}; numbers: crank angle, deg": to_say("in {unit}; numbers: angle of the cycle, deg"),
    "zero at every crank angle": to_say("zero all over the cycle"),
    "order: events in one turn of the crank": to_say("order: events in one cycle"),
    "{angles} crank angles in a cycle of {cycle}": to_say("{angles} angles of a cycle"),
    "Outputs over crank angle": to_say("Outputs over the cycle"),
    "Longest crank angle over which each moves by no more, from crank angle": to_say(
        "Longest part of the cycle over which each moves by no more, and where it begins"
    ),
    "On frame and drive; extremes with their crank angle, moments about {place}": to_say(
        "On frame and drive; extremes with where they are in the cycle, moments about {place}"
    ),
    "Force in each joint; largest with its crank angle": to_say(
        "Force in each joint; largest with where it is in the cycle"
    ),
    "Moving points: places, largest velocity and acceleration (at crank angle)": to_say(
        "Moving points: places, largest velocity and acceleration (where in the cycle)"
    ),
    "Sliders and rockers: stroke between dead positions (at crank angle), and time of the slower "
    "stroke over that of the faster": to_say(
        "Sliders and rockers: stroke between dead positions (where in the cycle), and time of the "
        "slower stroke over that of the faster"
    ),
    "Crank angle over which they rise; longest dwell within {share} % of the stroke": to_say(
        "Part of the cycle over which they rise; longest dwell within {share} % of the stroke"
    ),
    "Crank angle over which they rise; longest dwell within {share} % of the stroke; least "
    "mechanical advantage, which has no bound towards dead positions": to_say(
        "Part of the cycle over which they rise; longest dwell within {share} % of the stroke; "
        "least mechanical advantage, which has no bound towards dead positions"
    ),
    "Springs, each with its crank angle; below 0 they push their ends apart": to_say(
        "Springs, each with where in the cycle; below 0 they push their ends apart"
    ),
    "at every crank angle": to_say("all over the cycle"),
    "Zero at every crank angle: {names}": to_say("Zero all over the cycle: {names}"),
    "lowest at crank angle": to_say("lowest at angle of the cycle"),
    "highest at crank angle": to_say("highest at angle of the cycle"),
    "crank turns while it rises": to_say("part of the cycle while it rises"),
    "crank turns while it falls": to_say("part of the cycle while it falls"),
    "crank turns while it rests at the lowest place": to_say(
        "part of the cycle while it rests at the lowest place"
    ),
    "crank turns while it rests at the highest place": to_say(
        "part of the cycle while it rests at the highest place"
    ),
    "dwell begins at crank angle": to_say("dwell begins at angle of the cycle"),
    "lifts off at crank angle": to_say("lifts off at angle of the cycle"),
    "Any output over crank angle": to_say("Any output over the cycle"),
    "the crank stands still; playing swings the support": to_say(
        "the machine stands still; playing swings the support"
    ),
    "The shaking force on the frame as an arrow that goes around with the crank; numbers are crank "
    "angles. A long, narrow curve shakes in one direction, which a counterweight on the crank "
    "hardly helps; a round one is what such a counterweight takes away.": to_say(
        "The shaking force on the frame as an arrow over the cycle; numbers are angles of the "
        "cycle. A long, narrow curve shakes in one direction."
    ),
    "The path of a point, with marks at equal steps of the crank. Where marks are close the point "
    "is slow; a corner is a stop, and a straight stretch is guided motion.": to_say(
        "The path of a point, with marks at equal steps of the cycle. Where marks are close the "
        "point is slow; a corner is a stop, and a straight stretch is guided motion."
    ),
    "The torque that keeps the crank at its speed. Below zero the linkage drives the motor; the "
    "larger the swing, the more a flywheel or a larger motor is needed.": to_say(
        "The torque with which the drive keeps to its motion. Below zero the linkage drives the "
        "motor; the larger the peaks, the larger the motor."
    ),
    "How much of the signal comes once, twice and more often in 360° of crank angle. A "
    "counterweight on the crank acts on order 1 alone; an order that meets a natural frequency of "
    "the support shakes it most.": to_say(
        "How much of the signal comes once, twice and more often in a cycle. An order that meets a "
        "natural frequency of the support shakes it most."
    ),
    "The force in a joint over the crank angle. Its peak sizes the bearing; where it comes near "
    "zero and turns round, a joint with play knocks.": to_say(
        "The force in a joint over the cycle. Its peak sizes the bearing; where it comes near zero "
        "and turns round, a joint with play knocks."
    ),
    "Any figure that the machine has over the crank angle, such as velocities, transmission angles "
    "and forces: type some of its name.": to_say(
        "Any figure that the machine has over the cycle, such as velocities, transmission angles "
        "and forces: type some of its name."
    ),
    "at crank angles from {low} to {high}": to_say("from {low} to {high} of the cycle"),
}
"""What is said of a machine whose drive does not turn, for what is said of a crank."""
CYCLES_A_MINUTE: Mapping[str, str] = {
    "At {speed} rpm the linkage shakes its frame with a force of up to {peak} ({rms} RMS), largest "
    "at a crank angle of {angle}.": to_say(
        "At {speed} cycles a minute the linkage shakes its frame with a force of up to {peak} "
        "({rms} RMS), largest at {angle} of the cycle."
    ),
    "At {speed} rpm the linkage does not shake its frame by any force.": to_say(
        "At {speed} cycles a minute the linkage does not shake its frame by any force."
    ),
    "{rpm} rpm ({rate} rad/s)": to_say("{rpm} cycles a minute"),
    "{rpm} rpm ({rate} rad/s, clockwise)": to_say("{rpm} cycles a minute"),
    "{aims} at {speed} rpm": to_say("{aims} at {speed} cycles a minute"),
    "at {speeds} rpm": to_say("at {speeds} cycles a minute"),
}
"""What is said of a speed where a cycle is a turn of the phase and nothing turns with it."""
PUSHED: Mapping[str, str] = {
    "The shaking moment about the drive pivot reaches {peak} ({rms} RMS).": to_say(
        "The shaking moment about the pivot of the driven link reaches {peak} ({rms} RMS)."
    ),
    "There is no shaking moment about the drive pivot.": to_say(
        "There is no shaking moment about the pivot of the driven link."
    ),
}
"""What is said of the pivot of the drive, where all drives push."""


@contextmanager
def in_own_words(model: Any) -> Iterator[None]:
    """Inside, values are shown in the units of a model, where no others are chosen, and sentences
    speak of what it has.
    """
    with showing_by_default(units_of(model)), wording(words_of(model)):
        yield


def words_of(model: Any) -> Mapping[str, str]:
    """What is said of a model by what is said of a machine with a crank; empty of one with it."""
    if not isinstance(model, Machine) or model.crank_turns:
        return {}
    words = dict(OF_CYCLES)
    if all(item.pushes for item in model.driven):
        words |= PUSHED
    if model.only_swings and model.turns_given == 1:
        words |= CYCLES_A_MINUTE
    return words


PLAIN = (str, int, float, np.ndarray)


ProgressCallback = Callable[[int, int], None]
"""Called as work goes on, with how much is done, and of how much."""
Along = tuple[tuple[str, ...], Array]
"""Names of the axes of an array, and the array."""

ABSCISSAE = {"time": "s", "crank_angle": "rad", "speed": "rad/s", "places": "m"}
ABSCISSAE |= {"orders": "", "values": ""}
"""Name of an abscissa of arrays -> its SI unit.  An array has the first of these that is an
attribute of its own object, or else of the object that contains that."""


class Result(Displayed):
    """Base of all results.

    A result has `to_dict`, its machine-readable output in SI units, and `blocks`, what it shows;
    tables, pictures and notebooks follow from these.
    """

    @property
    def owner(self) -> Any:
        """The machine, tool or study of this result; None where it belongs to neither."""
        owners = (getattr(self, name, None) for name in ("machine", "original", "tool", "study"))
        return next((owner for owner in owners if owner is not None), None)

    @property
    def title(self) -> str:
        """Title of the machine, tool or study of this result; empty where it belongs to neither."""
        return "" if self.owner is None else str(self.owner.title)

    def in_own_units(self) -> AbstractContextManager[None]:
        """Inside, values are shown in the units and words of the machine, as of `in_own_words`."""
        return in_own_words(self.owner)

    def to_dict(self) -> dict[str, Any]:
        """The machine-readable output, in SI units: dicts, numbers and arrays.

        What it declares; where that is nothing, its fields that are plain values.
        """
        if self.declared:
            return values_of(self, self.declared)
        getattrs = {item.name: getattr(self, item.name) for item in fields(cast("Any", self))}
        return {name: value for name, value in getattrs.items() if isinstance(value, PLAIN)}

    declared: ClassVar[Declarations] = {}
    """Its outputs by key."""

    records: ClassVar[str] = ""
    """Entry of `to_dict` with a dict for each of its records, where it is a list of such."""

    def columns(self) -> list[tuple[str, str, Array]]:
        """Name, SI unit and values of the columns of its CSV file, over the first of them.

        Empty where it has none.
        """
        result = columns_of(self, self.declared, model=self.owner)
        return [*{column[0]: column for column in result}.values()]  # parts share an abscissa

    blocks_in: ClassVar[str]
    """Module and function of its blocks, such as ``vibration.blocks.response_blocks``."""

    def blocks(self, **options: Any) -> Sequence[Block]:
        """Its tables, sentences and notes, in the language that is spoken."""
        with self.in_own_units():
            own = _function(self.blocks_in)(self, **options)
            return (*own, *figures_of(self, self.declared))

    headline_in: ClassVar[str] = ""
    """Module and function of the blocks that come first, such as
    ``results.analysis_blocks.analysis_headline``; empty where its other blocks begin with the
    verdict.
    """

    def headline(self, alone: bool = False, **options: Any) -> Sequence[Block]:
        """What stands first of it wherever it is shown: a verdict, what is large, where.

        alone : whether nothing follows, as on a terminal; else its blocks do.
        options : of the function that `headline_in` names.
        """
        if not self.headline_in:
            return ()
        with self.in_own_units():
            return tuple(_function(self.headline_in)(self, alone, **options))

    @property
    def summary(self) -> Mapping[str, Any]:
        """The figures of it that matter most."""
        return {
            name: value for name, value in self.to_dict().items() if isinstance(value, int | float)
        }

    def to_dataset(self) -> xarray.Dataset:
        """Arrays of a result as an `xarray.Dataset`, by dotted path along their abscissae.

        Everything else is an attribute.  Loads xarray.
        """
        import xarray

        arrays, attributes = _split(self)
        columns = self.columns()
        units = ABSCISSAE | {name: unit for name, unit, _ in columns}
        if columns and columns[0][0] not in arrays and not self.records:
            arrays |= {name: ((columns[0][0],), values) for name, _, values in columns}
        by_name = {
            path: (axes, values, {"units": units[path]} if units.get(path) else {})
            for path, (axes, values) in arrays.items()
        }
        ticks = {path: by_name.pop(path) for path, (axes, _) in arrays.items() if axes == (path,)}
        return xarray.Dataset(by_name, ticks, attrs=attributes)

    def to_frame(self) -> pandas.DataFrame:
        """The columns of its CSV file where it has one, over the first of them, by name and SI unit
        such as ``drive_torque [N m]``; loads pandas.

        Else a row for each of its records, or for each sample of the common abscissa, with
        columns by dotted path, those of a table (N, K) by its path and a number.  A result without
        an abscissa gives one row.
        """
        import pandas

        columns = self.columns()
        if columns and not self.records:
            (first, unit, index), *rest = columns
            frame = {column_heading(name, item): values for name, item, values in rest}
            return pandas.DataFrame(frame, pandas.Index(index, name=column_heading(first, unit)))
        arrays, attributes = _split(self)
        along = self.records or next((name for name in ABSCISSAE if name in arrays), "")
        flat = {
            name: values
            for path, (axes, table) in arrays.items()
            if along in axes and path != along
            for name, values in _flat(path, np.moveaxis(table, axes.index(along), 0))
        }
        if along in arrays:
            head = column_heading(along, ABSCISSAE.get(along, ""))
            return pandas.DataFrame(flat, pandas.Index(arrays[along][1], name=head))
        if flat:
            return pandas.DataFrame(flat)
        row = {path: value for path, value in attributes.items() if not isinstance(value, list)}
        return pandas.DataFrame([row])

    pictures_in: ClassVar[str] = ""
    """Module and function that draw its pictures, such as ``figures.modes.mode_charts``: a chart
    for each name, the first of which `plot` draws unasked.  None where it has no pictures.
    """

    @property
    def pictures(self) -> tuple[str, ...]:
        """Names of its pictures, the first of which is the one that `plot` draws unasked."""
        with self.in_own_units():
            return tuple(self.charts())

    def charts(self) -> Mapping[str, Chart]:
        """Every picture of it by name, as a chart for `figures` to draw.

        Raises
        ------
        UsageError : a result of its kind has no pictures.
        """
        if not self.pictures_in:
            raise UsageError(
                Note("there are no pictures of {kind}; show its blocks", kind=type(self).__name__)
            )
        charts: Mapping[str, Chart] = _function(self.pictures_in)(self)
        return charts

    def plot(self, name: str = "", *, ax: Any = None) -> Any:
        """Draw one of its pictures; a notebook shows what comes back.

        name : of `pictures`; the first of them where not given.
        ax : axes of Matplotlib in which it is drawn, as large as these are; a new figure where not
            given.

        Returns
        -------
        matplotlib.figure.Figure, to which `ax` belongs where that is given.

        Raises
        ------
        UsageError : there is no such picture.
        """
        with self.in_own_units():
            return room("figures").plot(self, name, ax)

    @property
    def caption(self) -> str:
        return repr(self.title) if self.title else ""


def _function(place: str) -> Callable[..., Any]:
    """What a class declares by module and name, imported when it is wanted."""
    module, _, name = place.rpartition(".")
    function: Callable[..., Any] = getattr(room(module), name)
    return function


def _flat(path: str, values: Array) -> Iterator[tuple[str, Array]]:
    """Columns (N,) of an array (N, ...), the last of whose axes may be several."""
    if values.ndim == 1:
        yield path, values
    else:
        for k, column in enumerate(values.reshape(len(values), -1).T):
            yield f"{path}.{k}", column


# -- paths -----------------------------------------------------------------------------------------


def _split(result: Result) -> tuple[dict[str, Along], dict[str, Any]]:
    """Arrays with their axes, and what is no array, by dotted path."""
    arrays: dict[str, Array] = {}
    attributes: dict[str, Any] = {}
    records: dict[str, str] = {}  # path -> records to which it belongs
    for path, value in _leaves(result.to_dict()):
        if isinstance(value, list) and value and isinstance(value[0], Mapping):
            items = [dict(_leaves(item)) for item in value]
            for key in dict.fromkeys(key for item in items for key in item):
                arrays[f"{path}.{key}"] = _array([item.get(key) for item in items])
                records[f"{path}.{key}"] = path
        elif isinstance(value, np.ndarray):
            arrays[path] = value
        elif isinstance(value, list) and value and _is_numeric(value):
            arrays[path] = _array(value)
        elif value is not None:
            attributes[path] = value
    single = {path: item for path, item in arrays.items() if item.ndim == 1 and path not in records}
    by_name = {
        path: (_axes(path, values, single, records.get(path)), values)
        for path, values in arrays.items()
    }
    return by_name, attributes


def _leaves(values: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in values.items():
        name = f"{path}.{key}" if path else str(key)
        if isinstance(value, Mapping):
            yield from _leaves(value, name)
        else:
            yield name, list(value) if isinstance(value, tuple) else value


def _is_numeric(values: Sequence[Any]) -> bool:
    """Whether these are numbers, none in the place of some, or lists of such."""
    return all(
        _is_numeric(value)
        if isinstance(value, list | tuple)
        else value is None or isinstance(value, Number)
        for value in values
    )


def _array(values: Sequence[Any]) -> Array:
    """Values (N, ...), filled up with NaN where there are none; other than numbers as objects."""
    if _is_numeric(values):
        if not any(isinstance(value, list | tuple) for value in values):
            return np.array([np.nan if value is None else value for value in values])
        parts = {
            k: _array(value) for k, value in enumerate(values) if isinstance(value, list | tuple)
        }
        shape = np.max([part.shape for part in parts.values()], axis=0)
        filled = np.full((len(values), *shape), np.nan)
        for k, part in parts.items():
            filled[k][tuple(map(slice, part.shape))] = part
        return filled
    numbers = np.empty(len(values), dtype=object)
    numbers[:] = values
    return numbers


def _axes(
    path: str, values: Array, single: Mapping[str, Array], record: str | None
) -> tuple[str, ...]:
    """Names of the axes of an array; what stands nearest of an abscissa goes before others."""
    axes: list[str] = [] if record is None else [record]
    abscissae = [f"{scope}{name}" for name in ABSCISSAE for scope in _scopes(path)]
    for k, size in list(enumerate(values.shape))[len(axes) :]:
        fitting = (item for item in abscissae if item in single and len(single[item]) == size)
        free = (item for item in fitting if item not in axes)
        axes.append(next(free, f"{path}.index_{k}"))
    return tuple(axes)


def _scopes(path: str) -> Iterator[str]:
    """What stands before a name beside the last of a path, and beside what that stands in."""
    parts = path.split(".")[:-1]
    for k in range(len(parts), -1, -1):
        yield "".join(f"{part}." for part in parts[:k])
