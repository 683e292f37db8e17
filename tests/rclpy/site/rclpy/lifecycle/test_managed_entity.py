"""What follows a life cycle."""

from typing import Any

from rclpy.lifecycle import ManagedEntity, SimpleManagedEntity, TransitionCallbackReturn


class Lamp(SimpleManagedEntity):
    """Shines while it is active."""

    @SimpleManagedEntity.when_enabled
    def shine(self) -> str:
        return "light"

    @SimpleManagedEntity.when_enabled(when_not_enabled=lambda self: "dark")
    def look(self) -> str:
        return "light"


def test_it_works_while_it_is_active() -> None:
    """And otherwise does nothing, or something else."""
    lamp: Any = Lamp()
    assert (lamp.shine(), lamp.look(), lamp.is_activated) == (None, "dark", False)
    assert lamp.on_activate(None) is TransitionCallbackReturn.SUCCESS
    assert (lamp.shine(), lamp.look(), lamp.is_activated) == ("light", "light", True)
    lamp.on_deactivate(None)
    assert lamp.shine() is None


def test_by_default_every_transition_succeeds() -> None:
    """A subclass says otherwise."""
    entity = ManagedEntity()
    for hook in ("configure", "cleanup", "shutdown", "activate", "deactivate", "error"):
        assert getattr(entity, f"on_{hook}")(None) is TransitionCallbackReturn.SUCCESS
