"""Linkages that move: as a picture for pages, and as films."""
