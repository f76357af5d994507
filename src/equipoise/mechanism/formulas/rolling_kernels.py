"""The formulas of gears whose ratio varies, each written once, as in `mechanism.formulas.kernels`.

x is the angle of the driver and y that of the driven gear, both seen from the carrier.  Derived in
``docs/theory.md``.
"""

# mypy: disable-error-code="no-untyped-def, no-untyped-call"

from equipoise.mechanism.formulas.kernels import inverse, length


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
