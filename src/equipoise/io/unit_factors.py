"""SI units in one unit, as decimal text: exact, or 28 digits where pi or a third comes in.

A test holds them to pint's standard registry.  They stand here because importing pint takes as long
as importing NumPy, and a command should start at once.
"""

FACTORS = {
    # length
    "m": "1",
    "mm": "0.001",
    "cm": "0.01",
    "km": "1000",
    "um": "0.000001",
    "in": "0.0254",
    "ft": "0.3048",
    # angle
    "rad": "1",
    "deg": "0.01745329251994329576923690768",
    "turn": "6.283185307179586476925286767",
    # mass
    "kg": "1",
    "g": "0.001",
    "mg": "0.000001",
    "t": "1000",
    "lb": "0.45359237",
    "oz": "0.028349523125",
    # inertia
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
    # angular speed
    "rad/s": "1",
    "deg/s": "0.01745329251994329576923690768",
    "turn/s": "6.283185307179586476925286767",
    "rpm": "0.1047197551196597746154214461",
    # angular acceleration
    "rad/s^2": "1",
    "deg/s^2": "0.01745329251994329576923690768",
    "rpm/s": "0.1047197551196597746154214461",
    # acceleration
    "m/s^2": "1",
    "mm/s^2": "0.001",
    "ft/s^2": "0.3048",
    "gn": "9.80665",
    # force
    "N": "1",
    "kN": "1000",
    "mN": "0.001",
    "kgf": "9.80665",
    "gf": "0.00980665",
    "lbf": "4.4482216152605",
    # torque
    "N m": "1",
    "N mm": "0.001",
    "N cm": "0.01",
    "kN m": "1000",
    "kgf m": "9.80665",
    "kgf cm": "0.0980665",
    "gf cm": "0.0000980665",
    "lbf ft": "1.3558179483314004",
    "lbf in": "0.1129848290276167",
    # speed
    "m/s": "1",
    "mm/s": "0.001",
    "cm/s": "0.01",
    "km/h": "0.2777777777777777777777777778",
    "ft/s": "0.3048",
    # frequency
    "Hz": "1",
    "kHz": "1000",
    # time
    "s": "1",
    "ms": "0.001",
    "min": "60",
    "h": "3600",
    # stiffness
    "N/m": "1",
    "N/mm": "1000",
    "kN/m": "1000",
    "kgf/m": "9.80665",
    "kgf/cm": "980.665",
    "kgf/mm": "9806.65",
    "lbf/in": "175.1268352464763779527559055",
    # damping
    "N s/m": "1",
    "N s/mm": "1000",
    "kN s/m": "1000",
    "kgf s/m": "9.80665",
    # damping per length
    "N s/m^2": "1",
    "kN s/m^2": "1000",
    # torsional stiffness
    "N m/rad": "1",
    "kN m/rad": "1000",
    "N m/deg": "57.29577951308232087679815481",
    "kgf m/rad": "9.80665",
    # torsional damping
    "N m s/rad": "1",
    "N m s/deg": "57.29577951308232087679815481",
    "kgf m s/rad": "9.80665",
    # power
    "W": "1",
    "mW": "0.001",
    "kW": "1000",
    # density
    "kg/m^3": "1",
    "g/cm^3": "1000",
    "kg/dm^3": "1000",
    "lb/in^3": "27679.90471020312119364396209",
    # energy
    "J": "1",
    "mJ": "0.001",
    "kJ": "1000",
}
