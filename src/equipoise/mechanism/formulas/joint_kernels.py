"""Force in joints of dyads and at flanks, from what their links need: kernels like those of motion.

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
    """Sign of the moment that a driven body needs: it tells which flank of the teeth is loaded."""
    return (moment / (abs(moment) + 1e-300),)


def flank_forces(force, moment, u, sense, lever, slope):
    """Demand of a body about its pin that a flank at the end of a lever turns.

    u : rotation of the carrier.  sense : see `flank`.  lever : from the pin to where the flank
    pushes, in the carrier's axes.  slope : of the push against the way square to the lever, to the
    left, where the sense is 1.
    Returns force on the body at its pin, force of the flank on it, and the part of that square to
    the lever, positive where it turns the body counterclockwise.
    """
    push = moment / length(lever)
    exerted = (1j - slope * sense) * (u * lever) * (1 / length(lever)) * push
    return force - exerted, exerted, push


def strand_forces(force, moment, u, sense, radius, across, along):
    """Demand of a body about its pin that two strands turn by a radius.

    u, sense : as of `flank_forces`.  across, along : force in the carrier's axes for an effective
    pull of 1, and what comes to it on the side of `sense` where the tight strand alone pulls.
    Returns force on the body at its pin, force and couple of the strands on it about the pin, and
    their effective pull, positive where it turns the body counterclockwise.
    """
    pull = moment / radius
    both = u * ((across + sense * along) * pull)
    return force - both, both, moment, pull


def flank_ahead(force, u, guide):
    """Sign of the force along its guide that a body needs: it tells which flank pushes."""
    (sense,) = flank(dot(u * guide, force))
    return (sense,)


def sliding_forces(force, moment, c, pitch, u, sense, guide, slope):
    """Demand of a body about its point c on a guide, along which a flank pushes it.

    pitch : where that acts.  guide : unit vector of the guide in the carrier's axes.
    u, sense, slope : as of `flank_forces`, of the way along the guide.
    Returns the guide's force on the body at c with its couple, the flank's force on it, and the
    part of this along the guide.
    """
    n = u * guide
    push = dot(n, force)
    exerted = n * ((1 + 1j * slope * sense) * push)
    return force - exerted, moment - cross(pitch - c, exerted), exerted, push


def pitch_place(p, u, arm):
    """Place at an arm, in the axes of a body with the rotation u, from its point p."""
    return (p + u * arm,)


def slant(sense, radial, slope):
    """Radial part of a tooth force, per unit of tangential force, where the pitch curves are turned
    from the line square to that of the centres; slope : tangent of that angle.  radial : that part
    without a slope.  The tangent of a sum of angles.
    """
    return (radial * sense - slope) / (1 + radial * sense * slope)


def rolling_forces(force, moment, u, sense, lever, slope, radial):
    """As `flank_forces`, of what rolls with a varying ratio; lever : along the line of centres."""
    turned = -slant(sense, radial, slope)
    at_pin, mesh, tangential = flank_forces(force, moment, u, 1.0, lever, turned)
    return at_pin, mesh, tangential
