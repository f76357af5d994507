"""TODO: say what is public here."""
