"""One rigid body in space under up to three components of the ground's motion."""
