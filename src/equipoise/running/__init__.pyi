from .run import run as run
from .run_results import DrivesRun as DrivesRun
from .run_results import Run as Run
from .run_results import RunResult as RunResult
