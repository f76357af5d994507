"""Machines as files of other programs."""
