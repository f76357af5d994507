"""What a design problem is made of: what may change, what is wanted, who computes and who solves.

A `Variable` is a number of the model file by its path, or a `Lift`, a number that designers think
in; a `Requirement` is what a figure has to be.  A `PooledEvaluator` computes designs, and a
`DesignSolver` looks for the best of a `DesignProblem`: a search of a study, gears or phases of
balancing, geometry, a tool.
"""

from __future__ import annotations

from equipoise.guarding import attach

__getattr__, __dir__, __all__ = attach(__name__, __file__)
