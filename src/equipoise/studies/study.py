"""A study as a value: what varies of which model, how it is sampled, and what is computed."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np

from equipoise.errors import ModelError
from equipoise.mechanism.checks import wrong_text
from equipoise.studies import checks
from equipoise.studies.checks import check_numbers, shape_of
from equipoise.studies.design_space import (
    KEYS,
    SPREADS,
    Correlation,
    Model,
    Output,
    Range,
    Sampling,
    Spread,
    Vary,
)

if TYPE_CHECKING:
    pass

Array = np.ndarray[Any, Any]

CHUNK, SLOW_CHUNK = 65_536, 256
"""Designs that are computed and stored together: of analyses, and of whatever takes longer."""


@dataclass(frozen=True)
class Study:
    """Many designs of one model.

    angles : crank angles in a turn; None for as many as `tolerance` asks for.
    tolerance : to which all figures stand still when the number of crank angles doubles, over the
        RMS of their signal.
    chunk : designs that are computed and stored together; 0 for a usual number.
    file : text of the file that it was read from, for whoever reads a store.

    Raises
    ------
    ModelError : something contradicts itself; `where` is the key of the study file.
    """

    title: str
    model: Model
    vary: tuple[Vary, ...]
    outputs: tuple[Output, ...]
    sampling: Sampling
    correlations: tuple[Correlation, ...] = ()
    angles: int | None = None
    tolerance: float = 1e-4
    chunk: int = 0
    file: str = field(default="", compare=False, repr=False)

    def __post_init__(self) -> None:
        for name in ("vary", "outputs", "correlations"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        numbers = check_numbers(self.model, self.vary)
        vary = tuple(_as_in(one, *number) for one, number in zip(self.vary, numbers, strict=True))
        object.__setattr__(self, "vary", vary)
        for problem in _problems(self):
            raise problem
        if not self.chunk:
            fast = all(output.of == "analyze" for output in self.outputs)
            object.__setattr__(self, "chunk", CHUNK if fast else SLOW_CHUNK)

    @property
    def paths(self) -> tuple[str, ...]:
        """Paths of the numbers that vary, in the order of the columns of all values."""
        return tuple(one.path for one in self.vary)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the outputs, in the order of the columns of all figures."""
        return tuple(output.name for output in self.outputs)

    @property
    def shape(self) -> tuple[int, ...]:
        """Of a grid: values of each number; the last runs fastest."""
        return shape_of(self.vary)

    @property
    def size(self) -> int:
        """Number of designs in all."""
        if self.sampling.method == "grid":
            return prod(self.shape)
        assert self.sampling.designs is not None
        return self.sampling.designs

    @property
    def objectives(self) -> tuple[Output, ...]:
        """Outputs that are to become small or large."""
        return tuple(output for output in self.outputs if output.make)

    @property
    def texts(self) -> dict[str, str]:
        """All of it as texts by name; `equipoise.schema.studies.restore` makes it again of them."""
        return {
            "study": json.dumps(to_plain(self), ensure_ascii=False, indent=1, default=int),
            **({"file": self.file} if self.file else {}),
            **{f"model {name}": text for name, text in self.model.texts().items()},
        }


def _problems(study: Study) -> Iterator[ModelError]:
    """What is wrong with a study beside its numbers, the first things first."""
    method = study.sampling.method
    yield from wrong_text("title", study.title)
    for number, one in enumerate(study.vary, 1):
        yield from checks.wrong_spread(f"vary[{number}]", one, study.model, method)
    yield from checks.wrong_sampling(study.sampling, study.vary)
    yield from checks.wrong_correlations(study.correlations, study.vary, method)
    yield from checks.wrong_outputs(study.outputs, study.paths, study.model.kind)
    yield from checks.wrong_accuracy(study.angles, study.tolerance, study.chunk)


def _as_in(one: Vary, value: float, dimension: str | None) -> Vary:
    """The same with what the model knows of the number."""
    spread = one.spread
    if isinstance(value, int) and isinstance(spread, Range):
        spread = replace(spread, whole=True)
    return replace(one, spread=spread, dimension=dimension)


# -- as plain values -------------------------------------------------------------------------------


def to_plain(study: Study) -> dict[str, Any]:
    """All but the model and the file as plain values, such as JSON takes; numbers in SI units."""
    vary = [
        {**asdict(one), "spread": {"kind": KEYS[type(one.spread)], **asdict(one.spread)}}
        for one in study.vary
    ]
    return {
        "title": study.title,
        "vary": vary,
        "outputs": [asdict(output) for output in study.outputs],
        "sampling": asdict(study.sampling),
        "correlations": [asdict(correlation) for correlation in study.correlations],
        "angles": study.angles,
        "tolerance": study.tolerance,
        "chunk": study.chunk,
    }


def from_plain(plain: Mapping[str, Any], model: Model, file: str = "") -> Study:
    """The study of `to_plain`, exactly."""
    return Study(
        title=plain["title"],
        model=model,
        vary=tuple(
            Vary(one["path"], _spread(one["spread"]), one["dimension"]) for one in plain["vary"]
        ),
        outputs=tuple(Output(**output) for output in plain["outputs"]),
        sampling=Sampling(**plain["sampling"]),
        correlations=tuple(Correlation(**one) for one in plain["correlations"]),
        angles=plain["angles"],
        tolerance=plain["tolerance"],
        chunk=plain["chunk"],
        file=file,
    )


def _spread(plain: Mapping[str, Any]) -> Spread:
    given = dict(plain)
    return SPREADS[given.pop("kind")](**given)
