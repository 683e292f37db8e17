"""The views of a robot: where it is and what it sees, its frames, scans, images and joints."""
