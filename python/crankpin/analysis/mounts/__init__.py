"""An engine on its mounts: at rest, its modes and axes, and its response to the engine's orders."""
