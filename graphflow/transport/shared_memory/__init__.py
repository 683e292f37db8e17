"""Large messages between processes of one user on one machine. Start with `ring`."""
