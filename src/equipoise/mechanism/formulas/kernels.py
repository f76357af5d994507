"""The formulas of planar mechanics at one crank angle, each written once.

Dyads, joints and their forces; cams, gears of varying ratio, pieces of curves.

Planar vectors are complex numbers, x + i y.  A kernel does arithmetic only: ``+ - * /``, ``** 0.5``
and ``** 3``, ``abs`` and the parts of a complex number.  It calls no library and takes no branch on
a value, so that the same function runs on Python numbers, NumPy arrays, mpmath numbers and under
Numba.  It divides by real numbers only, and a vector is multiplied by ``1 / x``, not divided by x:
compiled, a complex division is a branch, which keeps a loop from handling several crank angles at
once and makes it ten times as slow.  For the same reason lengths are roots, not ``abs``.

Every position, and the rotation of every link, is followed by its first and second derivative
with respect to the crank angle (kinematic coefficients): ``p, p1, p2`` for a point and
``u, w, a`` for a link, where ``u = exp(i angle)``, ``w = angle'`` and ``a = angle''``.  At crank
speed W and crank acceleration E a point has velocity ``p1 W`` and acceleration
``p2 W**2 + p1 E``.

The last value that a dyad returns is its assembly margin: the squared sine of its transmission
angle, negative where the dyad cannot be closed.  It decides nothing here: the root is taken of its
positive part, and the caller looks at the margin.

Sources: circle intersection and its implicit derivatives, derived in ``docs/theory.md``; for the
four-bar they are equations (10) to (13) of Yamashita, Ichikawa and Mori.
"""

from __future__ import annotations

# Kernels run on numbers of any library, which no annotation can name.
# mypy: disable-error-code="no-untyped-def, no-untyped-call"


def cross(a, b):
    """Moment of the vector b applied at a: a_x b_y - a_y b_x."""
    return (a.conjugate() * b).imag


def dot(a, b):
    """Scalar product a_x b_x + a_y b_y."""
    return (a.conjugate() * b).real


def positive(x):
    """x where it is positive, else 0, without a branch."""
    return (x + abs(x)) * 0.5


def length(a):
    """Length of a vector."""
    return (a.real * a.real + a.imag * a.imag) ** 0.5


def inverse(a):
    """1 / a of a vector."""
    return a.conjugate() * (1 / (a.real * a.real + a.imag * a.imag))


def inverse_or_zero(a):
    """1 / a of a vector; 0 of 0."""
    return a.conjugate() * (1 / (a.real * a.real + a.imag * a.imag + 1e-300))


def turning(d, d1, d2):
    """First and second derivative of the angle of a vector d of constant length."""
    over = 1 / (d.real * d.real + d.imag * d.imag)
    return cross(d, d1) * over, cross(d, d2) * over


# -- motion ----------------------------------------------------------------------------------------


def point(p, p1, p2, u, w, a, arm):
    """Point of a link at `arm` (in the link's axes) from the point p of the same link."""
    r = u * arm
    return p + r, p1 + 1j * w * r, p2 + (1j * a - w * w) * r


def in_ratio(angle_r, w_r, a_r, angle_c, w_c, a_c, ratio, offset):
    """Angle of a driven body: relative to the carrier c it turns `ratio` times the driver r."""
    return (
        angle_c + ratio * (angle_r - angle_c) + offset,
        w_c + ratio * (w_r - w_c),
        a_c + ratio * (a_r - a_c),
    )


def pitch_slope(ratio, bend):
    """Tangent of the angle, counterclockwise, by which two pitch curves at the pitch point are
    turned from the line square to that of the centres.

    bend : derivative of the ratio by the driver's angle relative to the carrier.
    """
    return bend / (ratio * (1 - ratio))


def along_line(d, d1, d2, n, w, a):
    """Vector d and its derivatives in axes along the unit vector n, which turns by w, a."""
    back = n.conjugate()
    return (d * back, (d1 - 1j * w * d) * back, (d2 - 2j * w * d1 - (1j * a + w * w) * d) * back)


def slid(g, g1, g2, n, w, a, t, t1, t2):
    """Point at the way t from the point g along the unit vector n, which turns by w, a."""
    slip = 2j * w * t1 + t2
    return g + n * t, g1 + (1j * w * t + t1) * n, g2 + ((1j * a - w * w) * t + slip) * n


def rolled(angle_r, w_r, a_r, angle_c, w_c, a_c, way, offset):
    """Travel of a rack on the carrier c, of which the pinion r rolls `way` for a radian."""
    return way * (angle_r - angle_c) + offset, way * (w_r - w_c), way * (a_r - a_c)


def wound(t, t1, t2, angle_c, w_c, a_c, rate, offset):
    """Angle of a pinion that a rack, at the travel t on the carrier c, turns by `rate` for a m."""
    return angle_c + rate * t + offset, w_c + rate * t1, a_c + rate * t2


def travelled(p, p1, p2, g, g1, g2, u, w, a, along):
    """Way from the point g to p along a line, of the direction `along` in axes that u turns."""
    t, t1, t2 = along_line(p - g, p1 - g1, p2 - g2, u * along, w, a)
    return t.real, t1.real, t2.real


def apart(d, d1, d2):
    """Length of a vector d, and its derivatives."""
    size = length(d)
    first = dot(d, d1) / size
    return size, first, (dot(d1, d1) + dot(d, d2) - first * first) / size


def railed(t, t1, t2, g, g1, g2, u, w, a, along, turn):
    """Point and rotation of a link at the way t along a guide through g; others as in `rrp`."""
    n = u * along
    s, s1, s2 = slid(g, g1, g2, n, w, a, t, t1, t2)
    return s, s1, s2, n * turn, w, a


def rrr(p, p1, p2, q, q1, q2, arm_p, arm_q, side):
    """Two links pinned at p and q meet in the pin c.

    arm_p, arm_q : vectors from the outer pin to c, each in its own link's axes.
    side : +1 where c lies left of the line from p to q, -1 right.
    Returns rotation of link p, rotation of link q, the pin c, sin^2 of the transmission angle.
    """
    length_p, length_q = length(arm_p), length(arm_q)
    d = q - p
    distance2 = d.real * d.real + d.imag * d.imag
    cosine = (length_p * length_p + length_q * length_q - distance2) / (2 * length_p * length_q)
    number = 1 - cosine * cosine
    area = side * length_p * length_q * positive(number) ** 0.5
    along = (distance2 + length_p * length_p - length_q * length_q) * 0.5
    to_p = d * (along + 1j * area) * (1 / distance2)
    to_q = to_p - d
    e = q1 - p1
    w_p = dot(to_q, e) / area
    w_q = dot(to_p, e) / area
    e = q2 - p2 + w_p * w_p * to_p - w_q * w_q * to_q
    a_p = dot(to_q, e) / area
    a_q = dot(to_p, e) / area
    c1 = p1 + 1j * w_p * to_p
    c2 = p2 + (1j * a_p - w_p * w_p) * to_p
    u_p, u_q = to_p * inverse(arm_p), to_q * inverse(arm_q)
    return u_p, w_p, a_p, u_q, w_q, a_q, p + to_p, c1, c2, number


def parallelogram(p, p1, p2, q, q1, q2, a, a1, a2, w_a, a_a, w_b, a_b, arm_p, arm_q, side):
    """Two links pinned at p and q whose inner pin c closes a four-bar of equal opposite sides.

    a : the pin of the bodies that carry p and q, which turn by w_a, a_a and w_b, a_b; other
    arguments as in `rrr`.
    side : +1 where opposite links stay parallel, -1 where the four-bar is crossed.  Both go on
    through the change points, where all four pins lie in line.
    Returns the same as `rrr`.
    """
    z, z1, z2 = (q - p).conjugate(), (q1 - p1).conjugate(), (q2 - p2).conjugate()
    over = inverse_or_zero(z)
    span = dot(arm_p, arm_p) - dot(arm_q, arm_q)
    share, crossed = 0.5 + 0.5 * side, 0.5 - 0.5 * side
    rest = crossed * span
    bent = 2 * z1 * z1 * over - z2
    c = a + share * (p + q - 2 * a) + rest * over
    c1 = a1 + share * (p1 + q1 - 2 * a1) - rest * z1 * over * over
    c2 = a2 + share * (p2 + q2 - 2 * a2) + rest * bent * over * over
    to_p, to_q = c - p, c - q
    w_p, a_p = turning(to_p, c1 - p1, c2 - p2)
    w_q, a_q = turning(to_q, c1 - q1, c2 - q2)
    w_p, a_p = share * w_b + crossed * w_p, share * a_b + crossed * a_p
    w_q, a_q = share * w_a + crossed * w_q, share * a_a + crossed * a_q
    sine = cross(to_p, to_q) / (length(arm_p) * length(arm_q))
    u_p, u_q = to_p * inverse(arm_p), to_q * inverse(arm_q)
    return u_p, w_p, a_p, u_q, w_q, a_q, c, c1, c2, sine * sine


def pointed(p, p1, p2, q, q1, q2, arm):
    """A link pinned at p whose point at `arm` from there is pinned at q, both known.

    Returns its rotation; the distance of p and q is taken to be that of its points.
    """
    to_q = q - p
    w, a = turning(to_q, q1 - p1, q2 - p2)
    return to_q * inverse(arm) * (length(arm) / length(to_q)), w, a


def rrp(p, p1, p2, g, g1, g2, u, w, a, arm, along, shift, turn, side):
    """A link pinned at p meets, in the pin c, a link that slides along a guide.

    g : a point of the guide, on the line; u : rotation of the link that carries the guide.
    arm : from p to c in the pinned link's axes.  along : unit vector of the line in the guide's
    axes.  shift : from the sliding point to c, in axes along the line.  turn : unit vector of the
    sliding link's x axis in axes along the line.
    side : +1 where c lies ahead of p along the line, -1 behind.
    Returns rotations of pinned and sliding link, c, the dyad's number.
    """
    reach_most = length(arm)
    n = u * along
    back = n.conjugate()
    start = (p - g) * back - shift
    sine = start.imag / reach_most
    number = 1 - sine * sine
    reach = side * reach_most * positive(number) ** 0.5
    from_g = n * (start.real + reach + shift)
    to_p = g + from_g - p
    e = (g1 + 1j * w * from_g - p1) * back
    w_p = e.imag / reach
    slip = w_p * start.imag - e.real
    e = (g2 + (1j * a - w * w) * from_g + 2j * w * slip * n - p2 + w_p * w_p * to_p) * back
    a_p = e.imag / reach
    c1 = p1 + 1j * w_p * to_p
    c2 = p2 + (1j * a_p - w_p * w_p) * to_p
    return to_p * inverse(arm), w_p, a_p, n * turn, w, a, p + to_p, c1, c2, number


def rpr(p, p1, p2, q, q1, q2, offset, turn, back, small, side):
    """A block pinned at p slides on a guide pinned at q.

    offset : distance of p from the line through q along the guide, positive to the left.
    turn : unit vector of the block's x axis, back : of the guide link's x axis, both in axes
    along the line.  small : a length squared beside which p lies at q, where the guide's angle is
    undecided.  side : +1 where p lies ahead of q along the line, -1 behind.
    Returns rotation of block, rotation of guide, the dyad's number.
    """
    d = p - q
    distance2 = d.real * d.real + d.imag * d.imag
    reach2 = distance2 - offset * offset
    number = reach2 / (distance2 + small)
    reach = side * positive(reach2) ** 0.5
    n = d * inverse(reach + 1j * offset)
    along = n.conjugate()
    e = (p1 - q1) * along
    w = e.imag / reach
    slip = e.real + w * offset
    e = (p2 - q2) * along
    a = (e.imag + w * w * offset - 2 * w * slip) / reach
    return n * turn, w, a, n * back, w, a, number


def prp(g, g1, g2, u, w, a, h, h1, h2, v, x, b, along_g, shift_g, turn_g, along_h, shift_h, turn_h):
    """Two sliding links, one on a guide through g, one on a guide through h, meet in the pin c.

    u, w, a and v, x, b : rotations of the links that carry the guides; other arguments as in
    `rrp`.  Returns rotations of both sliding links, c, the dyad's number.
    """
    n, m = u * along_g, v * along_h
    sine = cross(n, m)
    d = h + m * shift_h - g - n * shift_g
    from_g = n * (cross(d, m) / sine + shift_g)
    from_h = m * (cross(d, n) / sine + shift_h)
    e = h1 + 1j * x * from_h - g1 - 1j * w * from_g
    slip_g = cross(e, m) / sine
    slip_h = cross(e, n) / sine
    e = (
        h2
        + (1j * b - x * x) * from_h
        + 2j * x * slip_h * m
        - g2
        - (1j * a - w * w) * from_g
        - 2j * w * slip_g * n
    )
    slip2_g = cross(e, m) / sine
    c1 = g1 + 1j * w * from_g + n * slip_g
    c2 = g2 + (1j * a - w * w) * from_g + (2j * w * slip_g + slip2_g) * n
    return n * turn_g, w, a, m * turn_h, x, b, g + from_g, c1, c2, sine * sine


def rpp(p, p1, p2, g, g1, g2, u, w, a, along, turn, inner, inner_turn, shift):
    """A link pinned at p slides on a second link (or carries it), which slides along a guide.

    along : unit vector of the outer line in the guide's axes; turn, inner_turn : unit vectors of
    the x axes of second and first link, inner : of the inner line, all in axes along the outer
    line.  shift : vector that, added to p - g, splits it into a way along each line, in the same.
    Returns rotations of first and second link, the second link's sliding point, the number.
    """
    n = u * along
    z, z1, z2 = along_line(p - g, p1 - g1, p2 - g2, n, w, a)
    z = z + shift
    slope = inner.real / inner.imag
    t, t1, t2 = z.real - slope * z.imag, z1.real - slope * z1.imag, z2.real - slope * z2.imag
    s, s1, s2 = slid(g, g1, g2, n, w, a, t, t1, t2)
    return n * inner_turn, w, a, n * turn, w, a, s, s1, s2, inner.imag * inner.imag


# -- forces ----------------------------------------------------------------------------------------
#
# The demand of a link is what its joints together must supply: force F and moment M about the
# link's anchor (named with each kernel).  A reaction is what the earlier body exerts on the link.


def about(mass, moment, inertia, shift):
    """Mass, first moment and moment of inertia about another point, which lies at `shift`."""
    return mass, moment - mass * shift, inertia - 2 * dot(shift, moment) + mass * dot(shift, shift)


def inertia_demand(p1, p2, u, w, a, speed2, acceleration, mass, moment, inertia):
    """Force and moment that move a link, about its point p.

    p1, p2 : derivatives of p; speed2, acceleration : crank speed squared, crank acceleration.
    mass, moment, inertia : of the link about p; moment is mass times the complex arm to the
    centre of mass in the link's axes.  Linear in these three.
    """
    turning = a * speed2 + w * acceleration
    at_p = p2 * speed2 + p1 * acceleration
    first = u * moment
    force = mass * at_p + (1j * turning - w * w * speed2) * first
    return force, inertia * turning + cross(first, at_p)


def weight_demand(u, mass, moment, gravity):
    """Force and moment that carry a link's weight, about the point that `moment` starts from."""
    return -mass * gravity, -cross(u * moment, gravity)


def load_demand(anchor, at, force, torque):
    """Force and moment, about the anchor, that hold a load against a link."""
    return -force, -cross(at - anchor, force) - torque


def spring(p, to, stiffness, free_length):
    """Force of a linear spring on its end p; `to` is the other end, which must lie elsewhere."""
    along = to - p
    return along * (stiffness * (1 - free_length / (length(along) + 1e-300)))


def pulled(p, to, pull):
    """Force on p that pulls it towards `to`, which must lie elsewhere."""
    along = to - p
    return along * (pull / (length(along) + 1e-300))


def drive_torque(p1, w, force, moment):
    """Torque at the drive that a link's demand about its point p asks for.

    p1, w : derivatives of p and of the link's angle.  By virtual work: joints between rigid links
    do none.
    """
    return dot(p1, force) + w * moment


def transfer(force, moment, anchor, at, reaction):
    """Add to a body's demand a reaction that it exerts on another body at the point `at`."""
    return force + reaction, moment + cross(at - anchor, reaction)


def transfer_couple(force, moment, anchor, at, reaction, couple):
    """Like `transfer`, for a reaction with a couple about `at`."""
    return force + reaction, moment + cross(at - anchor, reaction) + couple


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
    """Sign of the moment that a driven body needs: it selects the loaded flank of the teeth."""
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
    """Sign of the force along its guide that a body needs: it selects the flank that pushes."""
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


# -- cams ------------------------------------------------------------------------------------------
#
# `d` is the way from the cam's axis to what rides on the cam (a roller's centre, a knife's edge, or
# a point of a flat face), as seen from the cam's carrier, and d1, d2 its derivatives by the angle
# that the cam has turned against the carrier.  The common normal points from the cam to the
# follower.


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


# y, y1, y2 : displacement and its derivatives by the angle that the cam has turned against the
# carrier.  w_r, a_r : of the cam; w, a : of the carrier; u : the carrier's rotation.


def lifted(y, y1, y2, w_r, a_r, g, g1, g2, u, w, a, along, turn, rest):
    """A follower that slides on the carrier, on a guide through g.

    along : unit vector of the guide in the carrier's axes; turn : of the follower's x axis in axes
    along it.  rest : way of its point where y is 0.
    Returns its point on the guide and its rotation.
    """
    n, slip = u * along, w_r - w
    way1, way2 = y1 * slip, y1 * (a_r - a) + y2 * slip * slip
    return *slid(g, g1, g2, n, w, a, rest + y, way1, way2), n * turn, w, a


def swung(y, y1, y2, w_r, a_r, angle, w, a, rest, sense):
    """Angle of a follower that is pinned to the carrier, whose own is `angle`.

    rest : angle in the carrier where y is 0; sense : +1 where it grows with y, else -1.
    """
    slip = w_r - w
    bend = y1 * (a_r - a) + y2 * slip * slip
    return angle + rest + sense * y, w + sense * y1 * slip, a + sense * bend


def rate_lifted(u, y1, along):
    """Derivative of a place on a sliding follower by the cam's turn, seen from the carrier."""
    return (u * along * y1,)


def rate_swung(p, pivot, y1, sense):
    """Derivative of a place on a pinned follower by the cam's turn, seen from the carrier."""
    return (1j * sense * y1 * (p - pivot),)


def forth_lifted(u, along):
    """Unit vector along which a sliding follower's material moves as it rises."""
    return (u * along,)


def forth_swung(p, pivot, sense):
    """Unit vector along which a pinned follower's material moves at p as it rises."""
    arm = p - pivot
    return (1j * sense * arm * (1 / length(arm)),)


def touch_round(p, axis, rate, radius):
    """Where a roller at p touches the cam, whose axis is at `axis`; the common normal."""
    at, normal = round_contact(p - axis, rate, radius)
    return axis + at, normal


def touch_flat(p, axis, rate, u, y1, face, sense):
    """Where a flat face through p touches the cam; the common normal.

    u : rotation of the follower; face : normal in its axes; sense : as of `swung`, 0 of one that
    slides.
    """
    at, normal = flat_contact(p - axis, rate, sense * y1, u * face)
    return axis + at, normal


def lifted_forces(force, moment, p, at, normal, u, along):
    """Demand of a sliding follower about its point p on the guide; contact at `at`.

    Returns the guide's force with its couple, the cam's force, and that along the normal.
    """
    n = u * along
    push = dot(n, force) / dot(n, normal)
    cam = push * normal
    return force - cam, moment - cross(at - p, cam), cam, push


def swung_forces(force, moment, pivot, at, normal):
    """Demand of a pinned follower about its pin; contact at `at`.

    Returns the pin's force, the cam's force, and that along the normal.
    """
    push = moment / cross(at - pivot, normal)
    cam = push * normal
    return force - cam, cam, push


# -- curves ----------------------------------------------------------------------------------------


def piece_value(t, c0, c1, c2, c3, c4, c5, c6, c7, amplitude, rate, cosine, sine):
    """Value of a piece at the way t into it, and its two derivatives by t.

    c0 to c7 : coefficients of t**0 to t**7.  cosine, sine : of the wave's angle at t.
    """
    value = ((((((c7 * t + c6) * t + c5) * t + c4) * t + c3) * t + c2) * t + c1) * t + c0
    first = (((((7 * c7 * t + 6 * c6) * t + 5 * c5) * t + 4 * c4) * t + 3 * c3) * t + 2 * c2) * t
    second = ((((42 * c7 * t + 30 * c6) * t + 20 * c5) * t + 12 * c4) * t + 6 * c3) * t + 2 * c2
    wave = amplitude * rate
    return (
        value + amplitude * sine,
        first + c1 + wave * cosine,
        second - wave * rate * sine,
    )


def plane_piece(t, c0, c1, c2, c3, c4, c5):
    """Place on a piece of a plane curve at the way t into it, and three derivatives by t.

    c0 to c5 : vectors, coefficients of t**0 to t**5.
    """
    value = ((((c5 * t + c4) * t + c3) * t + c2) * t + c1) * t + c0
    first = (((5 * c5 * t + 4 * c4) * t + 3 * c3) * t + 2 * c2) * t + c1
    second = ((20 * c5 * t + 12 * c4) * t + 6 * c3) * t + 2 * c2
    return value, first, second, (60 * c5 * t + 24 * c4) * t + 6 * c3


def on_track(g, g1, g2, n, w, a, c, c1, c2, c3, s1, s2):
    """A body whose anchor is on a curve and whose x axis goes along this.

    g : the curve's origin.  n : rotation of its axes, which turn by w, a.
    c to c3 : place in these axes and three derivatives by the parameter.  s1, s2 : of that.
    Returns place, rotation, and speed along the curve.
    """
    steep = c1.real * c1.real + c1.imag * c1.imag
    pace, over = steep**0.5, 1 / steep
    bend = (c1.conjugate() * c2).imag * over  # of the tangent's angle by the parameter
    bend_rate = ((c1.conjugate() * c3).imag - 2 * (c1.conjugate() * c2).real * bend) * over
    slip = n * c1 * s1
    place = n * c
    return (
        g + place,
        g1 + 1j * w * place + slip,
        g2 + (1j * a - w * w) * place + 2j * w * slip + n * (c2 * (s1 * s1) + c1 * s2),
        n * c1 * (1 / pace),
        w + bend * s1,
        a + bend * s2 + bend_rate * (s1 * s1),
        pace * s1,
    )


# -- gears of varying ratio ------------------------------------------------------------------------
#
# x is the angle of the driver and y that of the driven gear, both seen from the carrier.


def half_angle(turned, mean, share, depth, lobes):
    """A law by half angles, at ``turned`` = exp(i lobes x).

    Returns 1 + depth turned, whose angle adds 2 share / lobes of itself to mean x; the rotation by
    twice that angle; the derivatives of y by x.
    """
    swung = depth * turned
    whole = 1 + swung
    over = inverse(whole)
    part = swung * over
    twice = whole * over.conjugate()
    return whole, twice, mean + 2 * share * part.real, -2 * lobes * share * (part * over).imag


def unit(whole):
    """The vector of length 1 along another."""
    return (whole * (1 / length(whole)),)


def series_term(y, first, second, wave, cosine, sine, order):
    """A sum, what it is the integral of and the derivative of that, with one more term.

    wave : exp(i order x); the term is cosine times its real part and sine times its imaginary part.
    """
    share = (cosine - 1j * sine) * wave
    return y + share.imag / order, first + share.real, second - order * share.imag


def followed(first, second, w_r, a_r, w_c, a_c):
    """Derivatives by crank angle of a body's angle that is a function of that of the driver r, both
    seen from the carrier c; first, second : derivatives of the function.
    """
    slip = w_r - w_c
    return w_c + first * slip, a_c + first * (a_r - a_c) + second * slip * slip
