"""What the motion does: forces, moments, torque, and what they are linear in."""
