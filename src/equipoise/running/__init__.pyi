from .run import Run as Run
from .run import run as run
