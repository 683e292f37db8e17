"""What a node lives in: its endpoints, its clock, its parameters, and the scheduler that runs its handlers."""
