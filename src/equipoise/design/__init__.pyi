from .lifts import Lift as Lift
from .lifts import lifts_of as lifts_of
from .requirements import Requirement as Requirement
from .variables import Choices as Choices
from .variables import Normal as Normal
from .variables import Range as Range
from .variables import Uniform as Uniform
from .variables import Variable as Variable
