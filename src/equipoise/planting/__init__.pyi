from .search import Fit as Fit
from .search import fit_planting as fit_planting
from .summary import PlantingFigures as PlantingFigures
from .summary import plant as plant
