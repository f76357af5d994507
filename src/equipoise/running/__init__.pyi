from .equation import CrankEquation as CrankEquation
