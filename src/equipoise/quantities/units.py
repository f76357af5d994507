"""Dimensions: the units that are accepted, what each is in SI units, and how they are written.

Factors are decimal text, exact, or 28 digits where pi or a third comes in.  A test holds them to
pint's standard registry; they stand here because importing pint takes as long as importing NumPy,
and a command should start at once.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

from equipoise.dataclass import dataclass
from equipoise.i18n import to_say

Dimension = Literal[
    "length",
    "angle",
    "mass",
    "inertia",
    "angular speed",
    "angular acceleration",
    "acceleration",
    "force",
    "torque",
    "speed",
    "frequency",
    "time",
    "stiffness",
    "damping",
    "damping per length",
    "torsional stiffness",
    "torsional damping",
    "power",
    "density",
    "volume",
    "energy",
    "bending stiffness",
    "mass per length",
    "modulus",
    "pressure times speed",
    "unbalance",
    "per length",
    "voltage",
    "current",
    "resistance",
    "inductance",
    "torque constant",
]


@dataclass(frozen=True)
class QuantityKind:
    """What is known of a dimension.

    Attributes
    ----------
    noun : with its article.
    units : all that are accepted, and SI units in each; the SI unit first.
    example : a quantity for error messages and the JSON Schema.
    usual : those that `format_exact` tries, the most usual first; the SI unit if there are none.
    """

    noun: str
    units: Mapping[str, str]
    example: str
    usual: tuple[str, ...] = ()

    @property
    def si(self) -> str:
        """The SI unit."""
        return next(iter(self.units))

    @property
    def printed(self) -> tuple[str, ...]:
        """The units that `format_exact` tries."""
        return self.usual or (self.si,)


KINDS: dict[Dimension, QuantityKind] = {
    "length": QuantityKind(
        to_say("a length"),
        {
            "m": "1",
            "mm": "0.001",
            "cm": "0.01",
            "km": "1000",
            "um": "0.000001",
            "in": "0.0254",
            "ft": "0.3048",
        },
        example="33.5 mm",
        usual=("mm", "m"),
    ),
    "angle": QuantityKind(
        to_say("an angle"),
        {
            "rad": "1",
            "deg": "0.01745329251994329576923690768",
            "turn": "6.283185307179586476925286767",
        },
        example="-83 deg",
        usual=("deg", "rad"),
    ),
    "mass": QuantityKind(
        to_say("a mass"),
        {
            "kg": "1",
            "g": "0.001",
            "mg": "0.000001",
            "t": "1000",
            "lb": "0.45359237",
            "oz": "0.028349523125",
        },
        example="199 g",
        usual=("g", "kg"),
    ),
    "inertia": QuantityKind(
        to_say("a moment of inertia"),
        {
            "kg m^2": "1",
            "kg cm^2": "0.0001",
            "kg mm^2": "0.000001",
            "g m^2": "0.001",
            "g cm^2": "0.0000001",
            "g mm^2": "0.000000001",
            "lb in^2": "0.0002926396534292",
            "lb ft^2": "0.0421401100938048",
            "kgf m s^2": "9.80665",
            "kgf cm s^2": "0.0980665",
            "gf cm s^2": "0.0000980665",
        },
        example="30 kg mm^2",
        usual=("kg mm^2", "kg m^2"),
    ),
    "angular speed": QuantityKind(
        to_say("an angular speed"),
        {
            "rad/s": "1",
            "deg/s": "0.01745329251994329576923690768",
            "turn/s": "6.283185307179586476925286767",
            "rpm": "0.1047197551196597746154214461",
        },
        example="193 rpm",
        usual=("rpm", "rad/s"),
    ),
    "angular acceleration": QuantityKind(
        to_say("an angular acceleration"),
        {
            "rad/s^2": "1",
            "deg/s^2": "0.01745329251994329576923690768",
            "rpm/s": "0.1047197551196597746154214461",
        },
        example="0 rad/s^2",
        usual=("rad/s^2", "rpm/s"),
    ),
    "acceleration": QuantityKind(
        to_say("an acceleration"),
        {
            "m/s^2": "1",
            "mm/s^2": "0.001",
            "in/s^2": "0.0254",
            "ft/s^2": "0.3048",
            "gn": "9.80665",
        },
        example="-9.80665 m/s^2",
    ),
    "force": QuantityKind(
        to_say("a force"),
        {
            "N": "1",
            "kN": "1000",
            "MN": "1000000",
            "mN": "0.001",
            "kgf": "9.80665",
            "gf": "0.00980665",
            "lbf": "4.4482216152605",
        },
        example="12 N",
    ),
    "torque": QuantityKind(
        to_say("a torque"),
        {
            "N m": "1",
            "N mm": "0.001",
            "N cm": "0.01",
            "kN m": "1000",
            "MN m": "1000000",
            "mN m": "0.001",
            "kgf m": "9.80665",
            "kgf cm": "0.0980665",
            "gf cm": "0.0000980665",
            "lbf ft": "1.3558179483314004",
            "lbf in": "0.1129848290276167",
        },
        example="1.5 N m",
    ),
    "speed": QuantityKind(
        to_say("a speed"),
        {
            "m/s": "1",
            "mm/s": "0.001",
            "cm/s": "0.01",
            "km/h": "0.2777777777777777777777777778",
            "in/s": "0.0254",
            "ft/s": "0.3048",
        },
        example="0.3 m/s",
        usual=("m/s", "km/h"),
    ),
    "frequency": QuantityKind(to_say("a frequency"), {"Hz": "1", "kHz": "1000"}, example="50 Hz"),
    "time": QuantityKind(
        to_say("a time"),
        {"s": "1", "ms": "0.001", "min": "60", "h": "3600"},
        example="2 s",
        usual=("s", "h", "min"),
    ),
    "stiffness": QuantityKind(
        to_say("a stiffness"),
        {
            "N/m": "1",
            "N/mm": "1000",
            "kN/m": "1000",
            "kN/mm": "1000000",
            "MN/m": "1000000",
            "kgf/m": "9.80665",
            "kgf/cm": "980.665",
            "kgf/mm": "9806.65",
            "lbf/in": "175.1268352464763779527559055",
        },
        example="20 kN/m",
    ),
    "damping": QuantityKind(
        to_say("a damping coefficient"),
        {
            "N s/m": "1",
            "N s/mm": "1000",
            "kN s/m": "1000",
            "kgf s/m": "9.80665",
            "lbf s/in": "175.1268352464763779527559055",
        },
        example="300 N s/m",
    ),
    "damping per length": QuantityKind(
        to_say("a damping coefficient per length"),
        {"N s/m^2": "1", "kN s/m^2": "1000"},
        example="300 N s/m^2",
    ),
    "torsional stiffness": QuantityKind(
        to_say("a torsional stiffness"),
        {
            "N m/rad": "1",
            "kN m/rad": "1000",
            "N m/deg": "57.29577951308232087679815481",
            "kgf m/rad": "9.80665",
            "lbf in/rad": "0.1129848290276167",
        },
        example="500 N m/rad",
    ),
    "torsional damping": QuantityKind(
        to_say("a torsional damping coefficient"),
        {"N m s/rad": "1", "N m s/deg": "57.29577951308232087679815481", "kgf m s/rad": "9.80665"},
        example="3 N m s/rad",
    ),
    "power": QuantityKind(
        to_say("a power"), {"W": "1", "mW": "0.001", "kW": "1000", "MW": "1000000"}, example="40 W"
    ),
    "density": QuantityKind(
        to_say("a density"),
        {
            "kg/m^3": "1",
            "g/cm^3": "1000",
            "kg/dm^3": "1000",
            "lb/in^3": "27679.90471020312119364396209",
        },
        example="7850 kg/m^3",
    ),
    "volume": QuantityKind(
        to_say("a volume"),
        {
            "m^3": "1",
            "mm^3": "0.000000001",
            "cm^3": "0.000001",
            "dm^3": "0.001",
            "l": "0.001",
            "ml": "0.000001",
            "in^3": "0.000016387064",
        },
        example="196 cm^3",
        usual=("cm^3", "mm^3", "m^3"),
    ),
    "energy": QuantityKind(
        to_say("an energy"),
        {"J": "1", "mJ": "0.001", "kJ": "1000", "MJ": "1000000"},
        example="12 J",
    ),
    "bending stiffness": QuantityKind(
        to_say("a bending stiffness"),
        {
            "N m^2": "1",
            "N mm^2": "0.000001",
            "kN m^2": "1000",
            "kgf m^2": "9.80665",
            "kgf cm^2": "0.000980665",
            "kgf mm^2": "0.00000980665",
            "lbf in^2": "0.00286981465730146418",
        },
        example="980 N m^2",
    ),
    "mass per length": QuantityKind(
        to_say("a mass per length"),
        {"kg/m": "1", "g/m": "0.001", "kg/mm": "1000", "lb/ft": "1.488163943569553805774278215"},
        example="2.3 kg/m",
        usual=("g/m", "kg/m"),
    ),
    "modulus": QuantityKind(
        to_say("a pressure, stress or modulus of elasticity"),
        {
            "Pa": "1",
            "kPa": "1000",
            "MPa": "1000000",
            "GPa": "1000000000",
            "bar": "100000",
            "N/mm^2": "1000000",
            "kgf/mm^2": "9806650",
            "psi": "6894.757293168361336722673445",
        },
        example="70 GPa",
        usual=("GPa", "MPa"),
    ),
    "pressure times speed": QuantityKind(
        to_say("a pressure times speed"),
        {"Pa m/s": "1", "MPa m/s": "1000000", "W/mm^2": "1000000"},
        example="1.7 MPa m/s",
        usual=("MPa m/s", "Pa m/s"),
    ),
    "unbalance": QuantityKind(
        to_say("an unbalance"),
        {
            "kg m": "1",
            "kg mm": "0.001",
            "g m": "0.001",
            "g cm": "0.00001",
            "g mm": "0.000001",
            "oz in": "0.000720077887375",
            "lb in": "0.011521246198",
        },
        example="300 g mm",
        usual=("g mm", "kg m"),
    ),
    "per length": QuantityKind(
        to_say("a number per length"), {"1/m": "1", "1/mm": "1000"}, example="20 1/m"
    ),
    "voltage": QuantityKind(
        to_say("a voltage"), {"V": "1", "mV": "0.001", "kV": "1000"}, example="24 V"
    ),
    "current": QuantityKind(
        to_say("a current"), {"A": "1", "mA": "0.001", "kA": "1000"}, example="5 A"
    ),
    "resistance": QuantityKind(
        to_say("a resistance"), {"ohm": "1", "mohm": "0.001", "kohm": "1000"}, example="0.4 ohm"
    ),
    "inductance": QuantityKind(
        to_say("an inductance"),
        {"H": "1", "mH": "0.001", "uH": "0.000001"},
        example="0.6 mH",
        usual=("mH", "H"),
    ),
    "torque constant": QuantityKind(
        to_say("a torque constant"), {"N m/A": "1", "V s/rad": "1"}, example="0.08 N m/A"
    ),
}

FACTORS: dict[str, str] = {
    unit: factor for kind in KINDS.values() for unit, factor in kind.units.items()
}
"""SI units in one unit, as decimal text."""
OF_UNIT: dict[str, Dimension] = {
    unit: dimension for dimension, kind in KINDS.items() for unit in kind.units
}
"""Dimension of each unit: none belongs to two, which a test looks after."""
SI: dict[Dimension, str] = {dimension: kind.si for dimension, kind in KINDS.items()}
"""SI unit of each dimension."""

HUGE, TINY = 1e30, 1e-30
"""Limits of what is taken for a quantity in SI units."""
