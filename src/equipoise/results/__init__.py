"""What was found of a machine, as plain data that shows itself.

`blocks` and `charts` are what a result shows, `result` is the base that all results share,
`analysis` is the result of `equipoise.analyze`.
"""
