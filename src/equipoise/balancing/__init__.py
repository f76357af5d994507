"""What to change so that a machine shakes least: convex programs, phases of rows, conditions.

Public are, each in the module that its name is followed by:

- `balance`, `default_plan` (`optimisation`): the best changes that a plan allows, as `Balanced`
  (`balanced`) with a proved bound; what is asked where a machine has no plan.
- `trade_off` (`pareto`): how small one objective can become for every value of another.
- `choose_phases` (`phase_search`), `arranged`, `halving`, `patterns_for` (`patterns`): phases of
  rows side by side, found and printed ones.
- `conditions` (`linear_conditions`), `feasibility` (`physical_consistency`), `least_moments`
  (`least_norm`): when force and moment vanish, whether masses can do it, and the least that do.
- `sensitivities` (`sensitivity`): what each mass does to an output at every crank angle.
"""
