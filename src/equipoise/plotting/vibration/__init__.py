"""The pictures of modes."""
