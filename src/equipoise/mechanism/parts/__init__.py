"""A machine and its parts, as frozen values with their checks: what a model file holds."""
