"""Hand-held tools: a shaft in bending, what sits on it, and the hands that hold it."""
