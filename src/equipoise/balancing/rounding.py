"""What counts as rounding wherever balancing compares numbers."""

from typing import Final

NEARLY: Final = 1e-9
"""Share of a number that rounding may take from it: multiples of a step, whole orders, ends of a
range and equal masses count as such up to that far.  Double precision loses 1e-13 in sums of some
hundred terms, and no number of a file is meant to nine digits."""
TINY: Final = 1e-300
"""In the place of a divisor that may be 0: below every quantity, with a finite inverse."""
