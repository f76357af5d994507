"""What the options of `balance` ask for, as a plan: they take the place of what the file says."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any

from equipoise.cli.blame import told_of_options
from equipoise.cli.options import quantity
from equipoise.errors import EquipoiseError, UsageError

if TYPE_CHECKING:
    from equipoise.mechanism.balance import Balance, Limit, Objective, Weight
    from equipoise.mechanism.model import Machine

MEASURES = ("rms", "ripple", "peak", "peak_to_peak", "area")
"""As in `mechanism.balance`, which would bring NumPy into every start of the command line."""
SHORT = {"shaking_energy": "area shaking_moment"}
SPELT = {
    "peak to peak": "peak_to_peak",
    "area under": "area",
    "rms": "rms",
    "ripple": "ripple",
    "peak(?! to)": "peak",
}
"""Measures as they are printed."""
WORDS = r"orders?|about|weight|speeds?"
EXAMPLE = '"peak shaking_moment about D", "rms shaking_force.y orders 1,2" or "drive_torque"'


@dataclass(frozen=True)
class Freed:
    """Options that say what may be changed."""

    move_cm: Sequence[str] | None = None
    crank_counterweight: bool = False
    counterweight: Sequence[str] | None = None
    geared_counterweight: str | None = None
    phases: bool = False
    shape: str | None = None
    radius: str | None = None
    mass: str | None = None
    at_most: str | None = None
    thickness: str | None = None
    material: str | None = None
    ratio: str | None = None
    pitch_radius: str | None = None

    @property
    def given(self) -> list[str]:
        """Names of the options that were given."""
        names = [one.name for one in fields(self) if getattr(self, one.name) not in (None, False)]
        return [f"--{name.replace('_', '-')}" for name in names]

    @property
    def any(self) -> bool:
        weights = self.crank_counterweight or self.counterweight or self.geared_counterweight
        return bool(self.move_cm or weights or self.phases)

    def check(self) -> None:
        """Options of a counterweight need one, and those of gears a geared one."""
        weight = self.crank_counterweight or self.counterweight or self.geared_counterweight
        of_weights = ("shape", "radius", "mass", "at_most", "thickness", "material")
        for names, owner, given in (
            (of_weights, "a counterweight", weight),
            (("ratio", "pitch_radius"), "--geared-counterweight", self.geared_counterweight),
        ):
            for name in names:
                if getattr(self, name) is not None and not given:
                    option = name.replace("_", "-")
                    raise UsageError(f"--{option} belongs to {owner}; give both")


def plan_of(
    machine: Machine,
    freed: Freed,
    objectives: Sequence[str] | None,
    limits: Sequence[str] | None,
) -> Balance:
    """The file's plan with what the options say: freedoms and objectives in the place of the
    file's, limits beside them.
    """
    from equipoise.mechanism.balance import Balance

    freed.check()
    plan = machine.balance or Balance()
    if freed.any:
        plan = _freed(machine, plan, freed)
    if objectives:
        read = tuple(read_objective("--objective", text) for text in objectives)
        plan = replace(plan, objectives=read)
    for text in limits or ():
        plan = _limited(machine, plan, text)
    with told_of_options():
        machine.with_balance(plan)
    return plan


def _freed(machine: Machine, plan: Balance, freed: Freed) -> Balance:
    from equipoise.balancing.optimisation import pin_of
    from equipoise.mechanism.balance import AddedMass, CenterMove, Phases

    masses = []
    if freed.crank_counterweight:
        drive = machine.drive.link
        masses.append(AddedMass(drive, pin_of(machine, drive), _weight(machine, drive, freed)))
    for link in freed.counterweight or ():
        _check_link("--counterweight", machine, link)
        masses.append(AddedMass(link, pin_of(machine, link), _weight(machine, link, freed)))
    for link in freed.move_cm or ():
        _check_link("--move-cm", machine, link)
    return replace(
        plan,
        moves=tuple(CenterMove(link) for link in freed.move_cm or ()),
        masses=tuple(masses),
        geared=_geared(machine, freed),
        shafts=(),
        springs=(),
        phases=Phases() if freed.phases else None,
    )


def _check_link(option: str, machine: Machine, link: str) -> None:
    from equipoise.mechanism.checks import unknown

    if link not in machine.links:
        raise UsageError(f"{option}: {unknown(link, machine.links, 'link')}")


def _weight(machine: Machine, link: str, freed: Freed) -> Weight:
    """A weight of the given shape; in a room as large as the link where nothing else holds it."""
    from equipoise.balancing.optimisation import reach_of
    from equipoise.mechanism.balance import MATERIALS, Weight
    from equipoise.mechanism.checks import unknown

    given: dict[str, Any] = {} if freed.shape is None else {"shape": freed.shape}
    for name, dimension in (
        ("radius", "length"),
        ("mass", "mass"),
        ("at_most", "mass"),
        ("thickness", "length"),
    ):
        text = getattr(freed, name)
        if text is not None:
            given[name] = quantity(f"--{name.replace('_', '-')}", text, dimension)
    if freed.material is not None:
        if freed.material not in MATERIALS:
            raise UsageError(f"--material: {unknown(freed.material, MATERIALS, 'material')}")
        given["density"] = MATERIALS[freed.material]
    if "radius" not in given and "mass" not in given:
        given["radius"] = reach_of(machine, link)
    return Weight(**given)


def _geared(machine: Machine, freed: Freed) -> tuple[Any, ...]:
    from equipoise.mechanism.balance import GearedWeight

    driver = freed.geared_counterweight
    if driver is None:
        return ()
    _check_link("--geared-counterweight", machine, driver)
    if freed.pitch_radius is None:
        raise UsageError(
            "--geared-counterweight needs the pitch radius of the gear on its driver; give "
            '--pitch-radius "50 mm"'
        )
    pitch_radius = quantity("--pitch-radius", freed.pitch_radius, "length")
    weight = _weight(machine, driver, freed)
    ratio, name = _ratio(freed.ratio), _new_name(machine)
    return (GearedWeight(driver, weight, ratio, pitch_radius=pitch_radius, name=name),)


def _new_name(machine: Machine) -> str:
    """For a counterweight beside those that there are already."""
    names = ("counterweight", *(f"counterweight-{k}" for k in range(2, len(machine.links) + 3)))
    taken = {*machine.links, *machine.frame}
    return next(name for name in names if taken.isdisjoint({name, f"{name}-axis"}))


def _ratio(text: str | None) -> tuple[float, float]:
    if text is None:
        return (0.2, 3.0)
    wrong = f'--ratio: got {text!r}; give a number, or the least and the largest: "0.3, 2"'
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        raise UsageError(wrong) from None
    if len(numbers) > 2:
        raise UsageError(wrong)
    return numbers[0], numbers[-1]


def read_objective(option: str, text: str) -> Objective:
    """Read an objective such as ``peak shaking_moment about D``."""
    from equipoise.mechanism.balance import Objective

    for short, long in SHORT.items():
        text = re.sub(rf"\b{short}\b", long, text)
    for spelt, measure in SPELT.items():
        text = re.sub(rf"^\s*{spelt}\s+(of\s+)?", f"{measure} ", text)
    head, *rest = re.split(rf"\s+({WORDS})\s+", text.strip())
    words = head.split()
    measure = words.pop(0) if words and words[0] in MEASURES else "rms"
    if words and words[0].startswith("joints."):  # of sliders, such as joints.piston on frame
        words = [" ".join(words)]
    if len(words) != 1:
        raise UsageError(f"{option}: got {text!r}; give such as {EXAMPLE}")
    values: dict[str, Any] = {}
    for word, value in zip(rest[::2], rest[1::2], strict=True):
        read = _read_word(option, word, value)
        if values.keys() & read.keys():
            raise UsageError(f"{option}: got {text!r}, with {word} twice; give it once")
        values |= read
    try:
        return Objective(words[0], measure, **values)  # type: ignore[arg-type]
    except EquipoiseError as error:
        raise UsageError(f"{option}: {error}") from error


def _read_word(option: str, word: str, value: str) -> dict[str, Any]:
    if word == "about":
        return {"about": value}
    if word.startswith("speed"):
        parts = (part.strip() for part in value.split(","))
        return {"speeds": tuple(quantity(option, part, "angular speed") for part in parts)}
    try:
        numbers = tuple(float(part) for part in value.split(","))
    except ValueError:
        raise UsageError(f"{option}: got {word} {value!r}; give numbers: {word} 1,2") from None
    if word != "weight":
        return {"orders": numbers}
    if len(numbers) > 1:
        raise UsageError(f"{option}: got weight {value!r}; give one number: weight 2")
    return {"weight": numbers[0]}


def _limited(machine: Machine, plan: Balance, text: str) -> Balance:
    head, sign, tail = (part.strip() for part in text.partition("<="))
    if not (head and sign and tail):
        raise UsageError(
            f'--limit: got {text!r}; give such as "peak joints.B <= 120 N", "rms drive_torque <= '
            '90 %" or "added_mass <= 500 g"'
        )
    if head == "added_mass":
        return replace(plan, added_mass=quantity("--limit", tail, "mass"))
    return replace(plan, limits=(*plan.limits, _limit(machine, head, tail)))


def _limit(machine: Machine, head: str, tail: str) -> Limit:
    from equipoise.mechanism.balance import Limit
    from equipoise.mechanism.balance_outputs import quantity_of
    from equipoise.schema.numbers import parse_share

    asked = read_objective("--limit", head)
    try:
        share = parse_share(tail)
        if share is not None:
            return Limit(asked, ratio=share)
        dimension = quantity_of(asked, machine)
    except EquipoiseError as error:
        raise UsageError(f"--limit: {error}") from error
    if dimension is None:
        raise UsageError(
            f"--limit: there is no unit for the area under {asked.output}; give a share of the "
            'value before, such as "80 %"'
        )
    return Limit(asked, at_most=quantity("--limit", tail, dimension))
