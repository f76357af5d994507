"""Pictures, drawn with Matplotlib: the only rooms that know it."""
