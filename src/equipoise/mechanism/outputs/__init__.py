"""The outputs of a machine, each declared once, and the names they go by."""
