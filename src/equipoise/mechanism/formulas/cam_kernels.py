"""Formulas of cams, of pieces of curves and of gears of varying ratio, each written once.

`d` is the way from the cam's axis to what rides on the cam (a roller's centre, a knife's edge, or
a point of a flat face), as seen from the cam's carrier, and d1, d2 its derivatives by the angle
that the cam has turned against the carrier.  The common normal points from the cam to the
follower.  Derived in ``docs/theory.md``.

x is the angle of the driver and y that of the driven gear, both seen from the carrier.  Derived in
``docs/theory.md``.
"""

from __future__ import annotations

from equipoise.mechanism.formulas.kernels import cross, dot, inverse, length, slid

# mypy: disable-error-code="no-untyped-def, no-untyped-call"


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


# -- motion ----------------------------------------------------------------------------------------
#
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


# -- forces ----------------------------------------------------------------------------------------


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


# mypy: disable-error-code="no-untyped-def"


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


# mypy: disable-error-code="no-untyped-def, no-untyped-call"


def back(turn):
    """A rotation the other way."""
    return turn.conjugate()


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
