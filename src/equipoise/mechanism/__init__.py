"""Planar linkages: the machine as frozen values, how it is assembled, its motion and its forces.

Public: `model.Machine` and its parts (also in `field`, `motor`, `spring`, `support`, `balance`),
`linkage.assemble`, `motion.move`, `dynamics.forces` and `dynamics.split`, `parameters.regressor`
and `parameters.base_parameters`, `assessment.four_bar`, and `instants` for where signals vanish or
turn.  NumPy is all that it needs.
"""
