"""The formula of a piece of a curve, written once, as in `mechanism.formulas.kernels`."""

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
