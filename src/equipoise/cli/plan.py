"""What the options of `balance` ask for, as a plan: they take the place of what the file says."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from equipoise.cli.options import (
    TextList,
    blaming_by_place,
    check_belonging,
    error_in_option,
    quantity,
    read_by,
    size,
    wants,
)
from equipoise.dataclass import dataclass
from equipoise.errors import UsageError, at_place
from equipoise.i18n import Note

if TYPE_CHECKING:
    from equipoise.mechanism.parts.balance import Balance, GearedWeight, Objective, Weight
    from equipoise.mechanism.parts.machine import Machine

MEASURES = ("rms", "ripple", "peak", "peak_to_peak", "area")
"""As in `mechanism.parts.balance`, which would bring NumPy into every start of the command line."""
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

TABLES = {
    "moves": "--move-cm",
    "masses": "a counterweight",
    "geared": "--geared-counterweight",
    "phases": "--phases",
    "objectives": "--objective",
    "limits": "--limit",
    "added_mass": "--limit",
}
KEYS = {
    "shape": "--shape",
    "radius": "--radius",
    "mass": "--mass",
    "at_most": "--at-most",
    "thickness": "--thickness",
    "density": "--material",
    "material": "--material",
    "ratio": "--ratio",
    "pitch_radius": "--pitch-radius",
}
"""Keys of weights that are options of their own."""
PLAIN = ("link", "driver", "output", "measure", "at_most")
"""Keys that go without saying."""
PLACES: dict[tuple[str, ...], str] = {
    **{("balance", table): option for table, option in TABLES.items()},
    **{("balance", table, key): option for table, option in TABLES.items() for key in PLAIN},
    **{("balance", table, key): KEYS[key] for table in ("masses", "geared") for key in KEYS},
}
"""Place in a plan -> the option that asked for it."""
LinkList = Annotated[TextList, wants("LINK")]
ShapeOption = Literal["any", "point", "disc", "ring", "sector"]


def _ratio(option: str, text: str) -> tuple[float, float]:
    wrong = at_place(
        option,
        Note('got {text!r}; give a number, or the least and the largest: "0.3, 2"', text=text),
    )
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        raise UsageError(wrong) from None
    if len(numbers) > 2:
        raise UsageError(wrong)
    return numbers[0], numbers[-1]


@Parameter(name="*", group="What may change")
@dataclass(frozen=True)
class Freed:
    """What may be changed, in the place of what the table [balance] says."""

    move_cm: LinkList = None
    """Permit a new position of the centre of mass of this link.  May be repeated."""
    crank_counterweight: bool = False
    """Permit a counterweight on the crank's axis."""
    counterweight: LinkList = None
    """Permit a counterweight on this link, about its pin in the frame, or its first point if it has
    none.  May be repeated."""
    geared_counterweight: Annotated[str | None, wants("LINK")] = None
    """Permit a counterweight on a shaft geared to this link."""
    ratio: Annotated[Any, read_by(_ratio)] = None
    """With --geared-counterweight: speed of the shaft over the link's, or a range "0.3, 2"."""
    pitch_radius: Annotated[float | None, size("length")] = None
    """With --geared-counterweight: pitch radius of the gear on the link."""
    shape: ShapeOption | None = None
    """Shape of counterweights: any distribution of mass, point, disc, ring or sector."""
    radius: Annotated[float | None, size("length")] = None
    """Largest radius of a counterweight. Default, without a mass: the length of its link."""
    mass: Annotated[float | None, size("mass")] = None
    """Fixed mass of a counterweight."""
    at_most: Annotated[float | None, size("mass")] = None
    """Largest mass of a counterweight."""
    thickness: Annotated[float | None, size("length"), wants('"8 mm"')] = None
    """Thickness of the plate for discs, rings and sectors."""
    material: Annotated[str | None, wants("MATERIAL")] = None
    """Material of that plate, such as steel."""
    phases: bool = False
    """Permit new phases of [[rows]]."""

    def __post_init__(self) -> None:
        of_weights = ("shape", "radius", "mass", "at_most", "thickness", "material")
        weights = {name: getattr(self, name) for name in of_weights}
        check_belonging(Note("a counterweight"), self.weights, **weights)
        gears = {"ratio": self.ratio, "pitch_radius": self.pitch_radius}
        check_belonging("--geared-counterweight", self.geared_counterweight is not None, **gears)

    @property
    def weights(self) -> bool:
        """Whether there is a counterweight."""
        return bool(self.crank_counterweight or self.counterweight or self.geared_counterweight)

    @property
    def any(self) -> bool:
        """Whether anything is free."""
        return bool(self.move_cm or self.weights or self.phases)

    def plan(self, machine: Machine) -> Balance:
        """The file's plan, with what is free in the place of what the file says."""
        from equipoise.balancing.room import pin_of
        from equipoise.mechanism.checks import unknown
        from equipoise.mechanism.parts.balance import AddedMass, Balance, CenterMove, Phases

        plan = machine.balance or Balance()
        if not self.any:
            return plan
        for option, links in (
            ("--counterweight", self.counterweight),
            ("--move-cm", self.move_cm),
            ("--geared-counterweight", [self.geared_counterweight]),
        ):
            for link in links or ():
                if link is not None and link not in machine.links:
                    raise UsageError(at_place(option, unknown(link, machine.links, "link")))
        weighted = [machine.drive.link] if self.crank_counterweight else []
        weighted += self.counterweight or []
        return replace(
            plan,
            moves=tuple(CenterMove(link) for link in self.move_cm or ()),
            masses=tuple(
                AddedMass(link, pin_of(machine, link), self.weight(machine, link))
                for link in weighted
            ),
            geared=self.geared(machine),
            shafts=(),
            springs=(),
            phases=Phases() if self.phases else None,
        )

    def weight(self, machine: Machine, link: str) -> Weight:
        """A weight of the given shape; in a room as large as the link where nothing else holds."""
        from equipoise.balancing.room import reach_of
        from equipoise.mechanism.checks import unknown
        from equipoise.mechanism.parts.balance import MATERIALS, Weight

        names = ("shape", "radius", "mass", "at_most", "thickness")
        given: dict[str, Any] = {name: getattr(self, name) for name in names}
        given = {name: value for name, value in given.items() if value is not None}
        if self.material is not None:
            if self.material not in MATERIALS:
                raise UsageError(
                    at_place("--material", unknown(self.material, MATERIALS, "material"))
                )
            given["density"] = MATERIALS[self.material]
        if "radius" not in given and "mass" not in given:
            given["radius"] = reach_of(machine, link)
        return Weight(**given)

    def geared(self, machine: Machine) -> tuple[GearedWeight, ...]:
        """The counterweight on a shaft of its own, if there is one."""
        from equipoise.mechanism.parts.balance import GearedWeight

        driver = self.geared_counterweight
        if driver is None:
            return ()
        if self.pitch_radius is None:
            raise UsageError(
                Note(
                    "--geared-counterweight needs the pitch radius of the gear on its "
                    'driver; give --pitch-radius "50 mm"'
                )
            )
        weight, ratio = self.weight(machine, driver), self.ratio or (0.2, 3.0)
        names = ("counterweight", *(f"counterweight-{k}" for k in range(2, len(machine.links) + 3)))
        taken = {*machine.links, *machine.frame}
        name = next(name for name in names if taken.isdisjoint({name, f"{name}-axis"}))
        return (GearedWeight(driver, weight, ratio, pitch_radius=self.pitch_radius, name=name),)


def plan_of(
    machine: Machine, freed: Freed, objectives: Sequence[str] | None, limits: Sequence[str] | None
) -> Balance:
    """The file's plan with what the options say: freedoms and objectives in the place of the
    file's, limits beside them.
    """
    plan = freed.plan(machine)
    if objectives:
        read = tuple(read_objective("--objective", text) for text in objectives)
        plan = replace(plan, objectives=read)
    for text in limits or ():
        plan = _limited(machine, plan, text)
    with blaming_by_place(PLACES):
        machine.with_balance(plan)
    return plan


def read_objective(option: str, text: str) -> Objective:
    """Read an objective such as ``peak shaking_moment about D``."""
    from equipoise.mechanism.parts.balance import Objective

    for short, long in SHORT.items():
        text = re.sub(rf"\b{short}\b", long, text)
    for spelt, measure in SPELT.items():
        text = re.sub(rf"^\s*{spelt}\s+(of\s+)?", f"{measure} ", text)
    head, *rest = re.split(rf"\s+({WORDS})\s+", text.strip())
    words = head.split()
    measure = words.pop(0) if words and words[0] in MEASURES else "rms"
    if words and "." in words[0]:  # such as joints.piston on frame, drives.left crank.torque
        words = [" ".join(words)]
    if len(words) != 1:
        raise UsageError(
            at_place(
                option, Note("got {text!r}; give such as {example}", text=text, example=EXAMPLE)
            )
        )
    values: dict[str, Any] = {}
    for word, value in zip(rest[::2], rest[1::2], strict=True):
        read = _read_word(option, word, value)
        if values.keys() & read.keys():
            raise UsageError(
                at_place(
                    option,
                    Note("got {text!r}, with {word} twice; give it once", text=text, word=word),
                )
            )
        values |= read
    with error_in_option(option):
        return Objective(words[0], measure, **values).of_all_rows  # type: ignore[arg-type]


def _read_word(option: str, word: str, value: str) -> dict[str, Any]:
    if word == "about":
        return {"about": value}
    if word.startswith("speed"):
        parts = (part.strip() for part in value.split(","))
        return {"speeds": tuple(quantity(option, part, "angular speed") for part in parts)}
    try:
        numbers = tuple(float(part) for part in value.split(","))
    except ValueError:
        raise UsageError(
            at_place(
                option,
                Note("got {word} {value!r}; give numbers: {word} 1,2", word=word, value=value),
            )
        ) from None
    if word != "weight":
        return {"orders": numbers}
    if len(numbers) > 1:
        raise UsageError(
            at_place(option, Note("got weight {value!r}; give one number: weight 2", value=value))
        )
    return {"weight": numbers[0]}


def _limited(machine: Machine, plan: Balance, text: str) -> Balance:
    """A plan with one more limit, such as ``peak joints.B <= 120 N``."""
    from equipoise.mechanism.parts.balance import Limit, quantity_of
    from equipoise.schema.numbers import parse_share

    head, sign, tail = (part.strip() for part in text.partition("<="))
    if not (head and sign and tail):
        raise UsageError(
            at_place(
                "--limit",
                Note(
                    'got {text!r}; give such as "peak joints.B <= 120 N", "rms drive_torque '
                    '<= 90 %" or "added_mass <= 500 g"',
                    text=text,
                ),
            )
        )
    if head == "added_mass":
        return replace(plan, added_mass=quantity("--limit", tail, "mass"))
    objective = read_objective("--limit", head)
    with error_in_option("--limit"):
        share = parse_share(tail)
        dimension = None if share is not None else quantity_of(objective, machine)
    if share is not None:
        limit = Limit(objective, ratio=share)
    elif dimension is not None:
        limit = Limit(objective, at_most=quantity("--limit", tail, dimension))
    else:
        raise UsageError(
            at_place(
                "--limit",
                Note(
                    "there is no unit for the area under {output}; give a share of the value "
                    'before, such as "80 %"',
                    output=objective.output,
                ),
            )
        )
    return replace(plan, limits=(*plan.limits, limit))
