"""Keys of files, declared once: a frozen dataclass says of each field what it is in its file.

::

    @declared
    class Spring(Frozen):
        stiffness: float = key("stiffness", "more than 0", example="2 kN/m", above=0)
        free_length: float = key("length", "at which it exerts nothing", default=0.0)

From this follow the checks of values made in Python (here), and reading, writing, the JSON Schema,
the tables of the documentation and access by path (`equipoise.schema`).  Rules between keys are
plain functions beside the class.
"""

from equipoise.keys.declaring import REQUIRED as REQUIRED
from equipoise.keys.declaring import ROW as ROW
from equipoise.keys.declaring import SCHEMA_VERSION as SCHEMA_VERSION
from equipoise.keys.declaring import VERSION as VERSION
from equipoise.keys.declaring import Frozen as Frozen
from equipoise.keys.declaring import Key as Key
from equipoise.keys.declaring import KeyConditions as KeyConditions
from equipoise.keys.declaring import Keys as Keys
from equipoise.keys.declaring import MenuItem as MenuItem
from equipoise.keys.declaring import MenuSource as MenuSource
from equipoise.keys.declaring import all_keys as all_keys
from equipoise.keys.declaring import any_of as any_of
from equipoise.keys.declaring import cached_names as cached_names
from equipoise.keys.declaring import changed as changed
from equipoise.keys.declaring import declared as declared
from equipoise.keys.declaring import inside as inside
from equipoise.keys.declaring import key as key
from equipoise.keys.declaring import keys_of as keys_of
from equipoise.keys.declaring import lacks as lacks
from equipoise.keys.declaring import needs as needs
from equipoise.keys.declaring import not_both as not_both
from equipoise.keys.declaring import numbers_of as numbers_of
from equipoise.keys.declaring import quantities_of as quantities_of
from equipoise.keys.declaring import schema_by_dimension as schema_by_dimension
from equipoise.keys.declaring import with_fields as with_fields
from equipoise.keys.declaring import wrong_values as wrong_values
from equipoise.keys.kinds import MOST_WHOLE as MOST_WHOLE
from equipoise.keys.kinds import NO_INERTIA as NO_INERTIA
from equipoise.keys.kinds import PLANES as PLANES
from equipoise.keys.kinds import Anything as Anything
from equipoise.keys.kinds import DependentQuantity as DependentQuantity
from equipoise.keys.kinds import DirectionKind as DirectionKind
from equipoise.keys.kinds import File as File
from equipoise.keys.kinds import Flag as Flag
from equipoise.keys.kinds import KeyTable as KeyTable
from equipoise.keys.kinds import Kind as Kind
from equipoise.keys.kinds import Listing as Listing
from equipoise.keys.kinds import Named as Named
from equipoise.keys.kinds import Number as Number
from equipoise.keys.kinds import OneOr as OneOr
from equipoise.keys.kinds import ParameterValue as ParameterValue
from equipoise.keys.kinds import Planes as Planes
from equipoise.keys.kinds import Point as Point
from equipoise.keys.kinds import Quantity as Quantity
from equipoise.keys.kinds import TableRecord as TableRecord
from equipoise.keys.kinds import Tables as Tables
from equipoise.keys.kinds import TextKind as TextKind
from equipoise.keys.kinds import Whole as Whole
from equipoise.keys.kinds import Wording as Wording
from equipoise.keys.kinds import choice as choice
from equipoise.keys.kinds import innermost as innermost
from equipoise.keys.kinds import items_of as items_of
