"""How a machine moves: motion, strokes, dwells, how far a crank reaches."""
