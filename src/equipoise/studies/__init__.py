"""Many designs of one model: ranges, tolerances, searches.  Zarr, Dask and pymoo are known here.

Public are, each in the module that its name is followed by:

- `Study` (`study`) with `Vary`, `Range`, `Choices`, `Normal`, `Uniform`, `Output`, `Sampling` and
  `Correlation` (`design_space`): what varies of a model, and what is computed.
- `run_study`, `resume` (`run`): all designs into a `Store`; `open_store` (`store`) opens one.
- `best` (`selection`), `export` (`table_files`): what is chosen from a store, and tables of it.
- `tolerance` (`tolerances`): what manufacturing tolerances do, and which to tighten first.
- `search_designs` (`search`): global search for one objective or several.
- `landscape` (`objective_map`): an objective of balancing over two numbers.
"""
