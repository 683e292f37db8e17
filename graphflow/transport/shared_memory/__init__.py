"""Large messages between processes of one user on one machine. Begin with `ring`."""
