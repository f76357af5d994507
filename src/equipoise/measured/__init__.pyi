from .decay import Decay as Decay
from .decay import identify_decay as identify_decay
from .record import Record as Record
from .record import simulate_decay as simulate_decay
