"""Machines as signs: what there is to draw, and the shapes that whatever draws it only places."""
