"""Charts, drawings and animations."""
