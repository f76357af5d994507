from .forced import Sweep as Sweep
from .forced import respond as respond
from .forced import sweep_speed as sweep_speed
from .free import FreeVibration as FreeVibration
from .free import Transient as Transient
from .free import modes as modes
from .free import simulate as simulate
from .response import Response as Response
