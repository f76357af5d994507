"""Properties of single joints: friction, bearings, stiffness.

A joint is named by the output of its force.  Whatever else a joint has of its own, such as friction
or clearance, is a further key here.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, ClassVar, Literal

from equipoise.errors import ModelError
from equipoise.i18n import Note, key_names, to_say
from equipoise.keys import Frozen, KeyConditions, KeyTable, Number, TextKind, any_of, declared, key

if TYPE_CHECKING:
    from equipoise.mechanism.parts.couplings import Coupling

EXPONENTS = {"ball": 3.0, "roller": 10 / 3}
"""By which a bearing's life falls with its load, ISO 281."""


@declared
class RollingBearing(Frozen):
    """A ball or roller bearing in a pin that is loaded radially."""

    called = to_say("{what} of the bearing")

    dynamic_rating: float = key(
        "force", "basic dynamic load rating C of the catalogue", example="25.5 kN", above=0
    )
    static_rating: float | None = key(
        "force", "basic static load rating C0", default=None, example="15 kN", above=0
    )
    kind: Literal["ball", "roller"] = key(
        TextKind((*EXPONENTS,)), "of its rolling elements: life goes by the load to 3 or 10/3",
        default="ball",
    )  # fmt: skip
    load_factor: float = key(Number(), "by which shocks make the load larger", default=1.0, above=0)
    life: float | None = key(
        "time", "that is wanted of it", default=None, example="25000 h", above=0
    )
    reliability: float = key(
        Number(), "share of such bearings that are to reach that life", default=0.9, above=0,
        below=1,
    )  # fmt: skip

    @property
    def exponent(self) -> float:
        """By which its life falls with its load."""
        return EXPONENTS[self.kind]


JOINTS = ("pin", "slider")
"""Kinds of joints that hold bodies together, which no coupling is."""
OF_PIN = ("radius", "torsional_damping", "drag_torque", "width", "bearing")
OF_SLIDER = ("guide_length", "damping", "drag_force")
LOADED = ("friction", "mesh_loss")
"""Keys of what resists in proportion to what presses in the joint."""
UNLOADED = ("damping", "torsional_damping", "drag_force", "drag_torque")
"""Keys of what resists whatever presses in the joint."""
RUBBING = (*LOADED, *UNLOADED)
"""Keys of which each alone makes a joint resist its motion."""
APART = ("radius", "width", "bearing", "stiffness")
"""Keys that have nothing to do with friction."""


def family_of(kind: str) -> str:
    """How the outputs begin that are forces of a kind of joint, or of the couplings of a list."""
    return "joints." if kind in JOINTS else f"{kind}."


@declared
class JointProperties(Frozen):
    """Properties of one joint, each of which may be left out."""

    called = to_say("{what} of joint {number}")
    file_order = (
        "joint", "radius", "width", "bearing", "stiffness", "friction", "static_friction",
        "stribeck_speed", "guide_length", "damping", "torsional_damping", "drag_force",
        "drag_torque", "mesh_loss",
    )  # fmt: skip
    conditions: ClassVar[KeyConditions] = any_of("radius", "stiffness", "bearing", *RUBBING) | {
        "dependentRequired": {
            "width": ["radius"],
            "static_friction": ["friction", "stribeck_speed"],
            "stribeck_speed": ["static_friction"],
            "guide_length": ["friction"],
        }
    }

    joint: str = key(
        TextKind(),
        "the name of its force in outputs; `joints.B` is a whole pin, of however many links",
        example="joints.B",
    )
    radius: float | None = key("length", "of a pin", default=None, example="6 mm", above=0)
    stiffness: float | None = key(
        "stiffness",
        "by which joints share forces that statics leaves open",
        default=None,
        example="20000 kN/m",
        above=0,
    )
    friction: float | None = key(
        Number(),
        "coefficient of dry friction; a pin with one needs its `radius`; of a cam, such as "
        "`cams.camshaft to tappet`, of a face or edge that slides on it, or what resists the "
        "turning of a roller over what presses there",
        default=None,
        example=0.1,
        at_least=0,
    )
    static_friction: float | None = key(
        Number(),
        "coefficient at standstill, from which it falls to `friction` (Stribeck)",
        default=None,
        at_least=0,
    )
    stribeck_speed: float | None = key(
        "speed",
        "sliding speed at which 37 % of the difference between both is left",
        default=None,
        example="5 mm/s",
        above=0,
    )
    guide_length: float | None = key(
        "length",
        "of the sliding link along its guide, in the middle of which its point is: a moment there "
        "presses both ends of it on the guide; left out, the normal force alone rubs",
        default=None,
        example="60 mm",
        above=0,
    )
    damping: float = key("damping", "of a slider, viscous", default=0.0, at_least=0)
    torsional_damping: float = key(
        "torsional damping", "of a pin, viscous", default=0.0, at_least=0
    )
    drag_force: float = key(
        "force",
        "of a slider, always against its motion, such as of a seal",
        default=0.0,
        example="20 N",
        at_least=0,
    )
    drag_torque: float = key(
        "torque",
        "of a pin, always against its motion, such as of a seal",
        default=0.0,
        example="0.05 N m",
        at_least=0,
    )
    mesh_loss: float | None = key(
        Number(),
        "of gears, a rack or a belt, such as `gears.crank to wheel`: the share of their tangential "
        "force that is lost in passing it on, so that they drive with an efficiency of 1 less this",
        default=None,
        example=0.02,
        at_least=0,
        below=1,
    )
    width: float | None = key(
        "length",
        "of a plain bearing: the force on the pin presses on `width` times its diameter",
        default=None,
        example="14 mm",
        above=0,
    )
    bearing: RollingBearing | None = key(
        KeyTable(RollingBearing), "rolling bearing in the pin, whose life is computed", default=None
    )

    @property
    def rubs(self) -> bool:
        """Whether the joint resists its motion."""
        return any(getattr(self, name) for name in (*RUBBING, "static_friction"))

    @property
    def says(self) -> bool:
        """Whether it says anything of its joint, be it not a friction of 0."""
        return self.rubs or any(getattr(self, name) is not None for name in APART)

    @property
    def rubs_by_load(self) -> bool:
        """Whether what presses in it makes it resist its motion."""
        return any(getattr(self, name) for name in (*LOADED, "static_friction"))

    def without_friction(self, drags: bool = False) -> JointProperties:
        """Properties of this joint if it moved freely.

        drags : whether it keeps what resists whatever presses in it: its damping and its drag.
        """
        own_names = (*APART, *UNLOADED) if drags else APART
        return JointProperties(self.joint, **{name: getattr(self, name) for name in own_names})


def wrong_joint(
    where: str, properties: JointProperties, families: Iterable[str]
) -> Iterator[ModelError]:
    """Report what is wrong with an entry by itself; the linkage knows which joints there are.

    families : groups of outputs that are forces of joints and couplings.
    """
    if not properties.joint.startswith((*(f"{family}." for family in families),)):
        name = f"joints.{properties.joint or 'B'}"
        note = Note("got {joint!r}; give a joint as {name}", joint=properties.joint, name=name)
        yield ModelError(f"{where}.joint", note)
    if not properties.says and properties.friction is None:
        yield ModelError(where, Note("give radius, stiffness, bearing or friction of the joint"))
    if properties.width is not None and properties.radius is None:
        yield ModelError(f"{where}.radius", Note("missing; a width goes with the pin's radius"))
    yield from _wrong_friction(where, properties)


def _wrong_friction(where: str, properties: JointProperties) -> Iterator[ModelError]:
    """Report keys of friction that do not go together."""
    if (properties.static_friction is None) != (properties.stribeck_speed is None):
        missing = "static_friction" if properties.static_friction is None else "stribeck_speed"
        note = Note(
            "missing; {static_friction} and {stribeck_speed} go together",
            **key_names("static_friction", "stribeck_speed"),
        )
        yield ModelError(f"{where}.{missing}", note)
    for name in ("static_friction", "guide_length"):
        if properties.friction is None and getattr(properties, name) is not None:
            yield ModelError(f"{where}.{name}", Note("goes with friction; give that too"))
    if (
        properties.friction is not None
        and (properties.static_friction or properties.friction) < properties.friction
    ):
        note = Note(
            "got {static}; give at least the friction of {friction}, from which it falls",
            static=f"{properties.static_friction:g}",
            friction=f"{properties.friction:g}",
        )
        yield ModelError(f"{where}.static_friction", note)


def wrong_of_kind(
    where: str,
    properties: JointProperties,
    kind: str,
    in_slot: bool,
    coupling: Coupling | None = None,
) -> Iterator[ModelError]:
    """Report properties that a joint of this kind does not have, or lacks.

    in_slot : whether it is a pin in a slot.  coupling : that the joint is.
    """
    if properties.mesh_loss is not None and not (coupling is not None and coupling.loses):
        note = Note("{joint!r} is no belt, rack or pair of gears; leave it out",
                    joint=properties.joint)  # fmt: skip
        yield ModelError(f"{where}.mesh_loss", note)
    if in_slot and (properties.bearing or properties.width) is not None:
        note = Note("a pin in a slot has no bearing whose load is computed; leave it out")
        yield ModelError(f"{where}.{'bearing' if properties.bearing else 'width'}", note)
    if properties.radius is not None and kind != "pin":
        note = Note("{joint!r} is no pin and has no radius; leave it out", joint=properties.joint)
        yield ModelError(f"{where}.radius", note)
    yield from _wrong_for_motion(where, properties, kind, in_slot)
    slides = coupling is not None and coupling.contact == "surface"
    if properties.friction is not None and not (slides or kind in JOINTS):
        what = to_say("{joint!r} is no pin, slider or cam; leave friction out")
        note = Note(what, joint=properties.joint)
        yield ModelError(f"{where}.friction", note)
    lacks_radius = kind == "pin" and not in_slot and properties.radius is None
    if properties.friction is not None and lacks_radius:
        yield ModelError(f"{where}.radius", Note("missing; friction in a pin acts at its radius"))


def _wrong_for_motion(
    where: str, properties: JointProperties, kind: str, in_slot: bool
) -> Iterator[ModelError]:
    """Report keys of what turns where it slides, and the other way round; a pin in a slot rubs as
    it slides.
    """
    turns, slides = kind == "pin" and not in_slot, kind == "slider" or in_slot
    for name in OF_PIN[1:]:
        if getattr(properties, name) and not turns:
            what = to_say("{joint!r} is no pin; this key is of pins, leave it out")
            if in_slot:
                what = to_say("{joint!r} slides in its slot; this key is of pins, leave it out")
            yield ModelError(f"{where}.{name}", Note(what, joint=properties.joint))
    for name in OF_SLIDER:
        if getattr(properties, name) and not (slides and (name != "guide_length" or not in_slot)):
            what = to_say("{joint!r} is no slider; this key is of sliders, leave it out")
            yield ModelError(f"{where}.{name}", Note(what, joint=properties.joint))
