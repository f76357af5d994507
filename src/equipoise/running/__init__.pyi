from .drives_run import DrivesRun as DrivesRun
from .run import Run as Run
from .run import run as run
