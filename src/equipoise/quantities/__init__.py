"""Quantities: what can be measured, in which units, how it is read and how it is written.

`units` has the dimensions and their units, `reading` turns strict text into SI floats and back,
`numbers` is the one formatter of numbers, in the units in which they are shown, and `measured`
keeps quantities in sentences until it is known how they were written.
"""

from equipoise.quantities.expressions import Amount as Amount
from equipoise.quantities.expressions import parse_amount as parse_amount
from equipoise.quantities.expressions import parse_expression as parse_expression
from equipoise.quantities.expressions import parse_number as parse_number
from equipoise.quantities.numbers import DEGREE as DEGREE
from equipoise.quantities.numbers import PER_RPM as PER_RPM
from equipoise.quantities.numbers import Display as Display
from equipoise.quantities.numbers import Units as Units
from equipoise.quantities.numbers import angle as angle
from equipoise.quantities.numbers import brief as brief
from equipoise.quantities.numbers import change as change
from equipoise.quantities.numbers import chosen_unit as chosen_unit
from equipoise.quantities.numbers import chosen_units as chosen_units
from equipoise.quantities.numbers import column_heading as column_heading
from equipoise.quantities.numbers import display as display
from equipoise.quantities.numbers import display_rules as display_rules
from equipoise.quantities.numbers import fixed as fixed
from equipoise.quantities.numbers import format_quantity as format_quantity
from equipoise.quantities.numbers import in_unit as in_unit
from equipoise.quantities.numbers import number as number
from equipoise.quantities.numbers import percent as percent
from equipoise.quantities.numbers import showing as showing
from equipoise.quantities.numbers import showing_by_default as showing_by_default
from equipoise.quantities.numbers import span as span
from equipoise.quantities.numbers import typeset as typeset
from equipoise.quantities.reading import DIGITS as DIGITS
from equipoise.quantities.reading import NUMBER as NUMBER
from equipoise.quantities.reading import Measured as Measured
from equipoise.quantities.reading import as_written as as_written
from equipoise.quantities.reading import clean as clean
from equipoise.quantities.reading import clean_place as clean_place
from equipoise.quantities.reading import described as described
from equipoise.quantities.reading import format_exact as format_exact
from equipoise.quantities.reading import in_si as in_si
from equipoise.quantities.reading import parse as parse
from equipoise.quantities.reading import pattern as pattern
from equipoise.quantities.reading import plain_unit as plain_unit
from equipoise.quantities.reading import rounded as rounded
from equipoise.quantities.reading import with_measured as with_measured
from equipoise.quantities.units import FACTORS as FACTORS
from equipoise.quantities.units import HUGE as HUGE
from equipoise.quantities.units import KINDS as KINDS
from equipoise.quantities.units import SI as SI
from equipoise.quantities.units import TINY as TINY
from equipoise.quantities.units import Dimension as Dimension
from equipoise.quantities.units import QuantityKind as QuantityKind
