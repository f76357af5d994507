from .daily import Exposure as Exposure
from .daily import Task as Task
from .daily import daily_exposure as daily_exposure
from .spectra import weigh_orders as weigh_orders
from .spectra import weigh_signal as weigh_signal
from .spectra import weigh_spectrum as weigh_spectrum
from .weighting import Weighted as Weighted
