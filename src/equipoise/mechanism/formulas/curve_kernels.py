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
