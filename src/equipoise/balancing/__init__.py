"""What to change so that a machine shakes less, with proof that nothing better exists."""
