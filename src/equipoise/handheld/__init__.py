"""Hand-held tools: a shaft in bending, what sits on it, and the hands that hold it.

Public: the values of `model` (`Tool` and its parts), `modes.vibrate_tool`, `response.respond_tool`
and `sweep.sweep_tool`, `transmission.transmit`, `exposed.expose_tool` and
`exposed.tool_sensitivities`, `studies.vary_tool` and `design.design_tool`.
"""
