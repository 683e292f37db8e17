"""What can end a wait that asyncio knows nothing about, as the node's source shows.

Begin with `wakers`. Assumes that nobody outside the node's own code sets what it polls: hence the name.
"""
