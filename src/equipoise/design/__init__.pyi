from .lifts import Lift as Lift
from .lifts import lifts_of as lifts_of
from .requirements import Requirement as Requirement
from .spreads import Choices as Choices
from .spreads import Normal as Normal
from .spreads import Range as Range
from .spreads import Uniform as Uniform
from .variables import Variable as Variable
