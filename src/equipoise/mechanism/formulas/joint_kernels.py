"""Force in the joints of dyads and gears, from what their links need: kernels like those of motion.

They keep the rules of `formulas.kernels`, and take no more from it than its plain vectors.
"""

# mypy: disable-error-code="no-untyped-def, no-untyped-call"

from equipoise.mechanism.formulas.kernels import cross, dot, length


def rrr_forces(p, q, c, force_p, moment_p, force_q, moment_q):
    """Demands about the outer pins; returns force on link p at p, on link q at q, on q at c."""
    to_p, to_q = c - p, c - q
    inner = (moment_q * to_p + moment_p * to_q) * (-1 / cross(to_p, to_q))
    return force_p + inner, force_q - inner, inner


def rrp_forces(p, c, u, force_p, moment_p, force_s, moment_s, along):
    """Demands about p and, for the sliding link, about c; u and `along` as in `rrp`.

    Returns force on the pinned link at p, guide's force on the sliding link at c with its couple,
    and the pinned link's force on the sliding link at c.
    """
    n = u * along
    back = n.conjugate()
    lever = (c - p) * back
    tangential = (force_s * back).real
    normal = (lever.imag * tangential - moment_p) / lever.real
    inner = n * (tangential + 1j * normal)
    return force_p + inner, force_s - inner, moment_s, inner


def rpr_forces(p, q, u, force_p, moment_p, force_q, moment_q, back):
    """Demands about the outer pins; block at p, guide at q.

    u : rotation of the block; back : unit vector of the line in the block's axes.

    Returns force on the block at p, force on the guide at q, the guide's force on the block at p
    with its couple.
    """
    n = u * back
    inner = -1j * n * ((moment_p + moment_q) / dot(n, p - q))
    return force_p - inner, force_q + inner, inner, moment_p


def prp_forces(u, v, force_g, moment_g, force_h, moment_h, along_g, along_h):
    """Demands about the pin c; other arguments as in `prp`.

    Returns the guides' forces at c with their couples, and the force of the first sliding link
    on the second.
    """
    n, m = u * along_g, v * along_h
    inner = 1j * (dot(m, force_h) * n + dot(n, force_g) * m) * (1 / cross(n, m))
    return force_g + inner, moment_g, force_h - inner, moment_h, inner


def rpp_forces(p, s, u, force_p, moment_p, force_s, moment_s, along, inner):
    """Demands about p and about the second link's sliding point s; others as in `rpp`.

    Returns force on the first link at p, the guide's force on the second link at s with its
    couple, and the second link's force on the first at p with its couple.
    """
    n = u * along
    m = n * inner
    normal = 1j * m * (dot(n, force_s) / cross(n, m))
    couple = moment_s + moment_p + cross(p - s, normal)
    return force_p - normal, force_s + normal, couple, normal, moment_p


def flank(moment):
    """Sign of the moment that a driven gear needs: it tells which flank of the teeth is loaded."""
    return (moment / (abs(moment) + 1e-300),)


def tooth(u, sense, lever, radial):
    """Tooth force on a driven gear, complex, for a unit of tangential force; see `gear_forces`."""
    return (1j + radial * sense) * u * lever * (1 / length(lever))


def gear_forces(force, moment, u, sense, lever, radial):
    """Demand of a driven gear about its own pin.

    u : rotation of the carrier.  sense : see `flank`.  lever : from the gear's pin to the pitch
    point, in the carrier's axes.  radial : part of the tooth force along the lever, per unit of
    tangential force: the tangent of the pressure angle, negative where the teeth push the gear
    back towards its pin.
    Returns force on the gear at its pin, tooth force on the gear at the pitch point, and the
    tooth force's tangential part.
    """
    tangential = moment / length(lever)
    mesh = tooth(u, sense, lever, radial) * tangential
    return force - mesh, mesh, tangential


def belt_forces(force, moment, u, sense, radius, across, along):
    """Demand of a driven pulley about its own pin.

    u, sense : as of `gear_forces`.  radius : of the pulley.  across, along : force of both strands
    in the carrier's axes, for a unit of effective pull; what comes to it, on the side of `sense`,
    where the tight strand alone pulls.
    Returns force on the pulley at its pin, force and couple of the strands on it about the pin,
    and their effective pull, positive where it turns the pulley counterclockwise.
    """
    pull = moment / radius
    both = u * ((across + sense * along) * pull)
    return force - both, both, moment, pull


def rack_flank(force, u, along):
    """Sign of the force along the rack that it needs: it tells which flank of the teeth pushes."""
    (sense,) = flank(dot(u * along, force))
    return (sense,)


def rack_forces(force, moment, c, pitch, u, sense, along, slant):
    """Demand of a rack about its point c on the guide.

    pitch : the pitch point.  u : rotation of the carrier.  sense : see `rack_flank`.
    along : unit vector of the guide in the carrier's axes.  slant : part of the tooth force to the
    left of that, per unit of the part along it.
    Returns the guide's force on the rack at c with its couple, the tooth force on the rack, and the
    part of this along the guide.
    """
    n = u * along
    push = dot(n, force)
    tooth = n * ((1 + 1j * slant * sense) * push)
    return force - tooth, moment - cross(pitch - c, tooth), tooth, push


def pitch_place(p, u, arm):
    """Place at an arm, in the axes of a body with the rotation u, from its point p."""
    return (p + u * arm,)


def slant(sense, radial, slope):
    """Radial part of a tooth force, per unit of tangential force, where the pitch curves are turned
    from the line square to that of the centres; slope : tangent of that angle, others as of
    `gear_forces`.  The tangent of a sum of angles.
    """
    return (radial * sense - slope) / (1 + radial * sense * slope)


def rolling_forces(force, moment, u, sense, lever, slope, radial):
    """As `gear_forces`, of gears whose ratio varies; lever : along the line of centres."""
    at_pin, mesh, tangential = gear_forces(
        force, moment, u, 1.0, lever, slant(sense, radial, slope)
    )
    return at_pin, mesh, tangential
