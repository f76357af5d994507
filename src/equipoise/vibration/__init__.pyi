from .forced import respond as respond
from .free import FreeVibration as FreeVibration
from .free import modes as modes
from .response import Response as Response
from .sweep import Sweep as Sweep
from .sweep import sweep_speed as sweep_speed
from .transient import Transient as Transient
from .transient import simulate as simulate
