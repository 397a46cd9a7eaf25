"""Ambient occlusion on sparse signed-distance grids.

    import alcove

    mesh = alcove.read("dragon.ply")
    baked = alcove.bake(mesh, radius="10%", quality="good")
    alcove.add(mesh, baked)
    alcove.write(mesh, "dragon_ao.ply")
"""
from ._alcove import (  # noqa: F401
    Baked,
    BakedMaps,
    Field,
    InputError,
    IoError,
    LimitError,
    MemoryError,
    Mesh,
    TimeLimitError,
    __version__,
    add,
    bake,
    bake_maps,
    limit_memory,
    limit_reading,
    read,
    write,
)

__all__ = ["Baked", "BakedMaps", "Field", "InputError", "IoError", "LimitError", "MemoryError", "Mesh", "TimeLimitError",
           "add", "bake", "bake_maps", "limit_memory", "limit_reading", "read", "write"]
