"""The formulas of a cam and its follower, each written once, as in `mechanism.kernels`.

`d` is the way from the cam's axis to what rides on the cam (a roller's centre, a knife's edge, or
a point of a flat face), as seen from the cam's carrier, and d1, d2 its derivatives by the angle
that the cam has turned against the carrier.  The common normal points from the cam to the
follower.  Derived in ``docs/theory.md``.
"""

# mypy: disable-error-code="no-untyped-def, no-untyped-call"

from equipoise.mechanism.kernels import cross, dot, length


def round_contact(d, d1, radius):
    """Contact of a roller, or of an edge where the radius is 0, from the cam's axis; the normal."""
    outward = d + 1j * d1
    normal = outward * (1 / length(outward))
    return d - radius * normal, normal


def flat_contact(d, d1, turning, normal):
    """Contact of a flat face, from the cam's axis; the face's normal.

    turning : derivative of the follower's angle against the carrier.
    """
    reach = dot(normal, d1 - 1j * d) / (1 - turning)
    return d - 1j * normal * reach, normal


def round_curvature(d, d1, d2):
    """Curvature of the curve that a roller's centre takes in the cam; positive where convex."""
    q1 = d1 - 1j * d
    q2 = d2 - 2j * d1 - d
    return -cross(q1, q2) / length(q1) ** 3


def flat_radius(d, d1, d2, turning, bending, normal):
    """Radius of curvature of the cam under a flat face; negative where undercut.

    bending : derivative of `turning`.
    """
    back = 1 / (1 - turning)
    q1 = d1 - 1j * d
    reach = dot(normal, q1) * back
    change = dot(1j * turning * normal, q1) + dot(normal, d2 - 1j * d1) + bending * reach
    return (dot(-1j * normal, q1) + change * back) * back
