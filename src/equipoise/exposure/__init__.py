"""Hand-arm vibration: how it is weighted, what a day of it amounts to, and what a hand may bear."""
