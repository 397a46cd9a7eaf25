"""The settings of a scene, and circles in the viewport that show the radius."""
import math

import bpy

_handle = None


class AlcoveSettings(bpy.types.PropertyGroup):
    radius: bpy.props.FloatProperty(
        name="Radius",
        description="Maximum distance of occluders, in scene units. 0: 10 % of the diagonal of the selected objects",
        default=0.0,
        min=0.0,
        unit="LENGTH",
    )
    quality: bpy.props.EnumProperty(
        name="Quality",
        items=[
            ("draft", "Draft", "An error (RMSE) of at most 0.05"),
            ("good", "Good", "An error of at most 0.02"),
            ("fine", "Fine", "An error of at most 0.005"),
        ],
        default="good",
    )
    ground: bpy.props.BoolProperty(
        name="Ground", description="A plane through the lowest vertex also occludes", default=False
    )
    target: bpy.props.EnumProperty(
        name="Target",
        items=[
            ("VERTEX", "Vertex Colour", "A colour attribute with a value per vertex"),
            ("CORNER", "Corner Colour", "A colour attribute with a value per face corner, which keeps sharp edges"),
            ("FLOAT", "Float Attribute", "A float attribute with a value per vertex"),
            ("IMAGE", "Active Image", "The image of the active image texture node of the active object"),
        ],
        default="VERTEX",
    )
    attribute: bpy.props.StringProperty(name="Attribute", description="Name of the attribute", default="ao")
    show_radius: bpy.props.BoolProperty(name="Show Radius", description="Show the radius around the active object")


def _draw():
    import gpu
    from gpu_extras.batch import batch_for_shader
    from mathutils import Matrix, Vector

    context = bpy.context
    settings = context.scene.alcove_ao
    thing = context.active_object
    if not settings.show_radius or settings.radius <= 0.0 or thing is None:
        return
    center = thing.matrix_world.translation
    steps = 64
    lines = []
    for turn in (Matrix(), Matrix.Rotation(math.pi / 2, 4, "X"), Matrix.Rotation(math.pi / 2, 4, "Y")):
        circle = [
            center + turn @ Vector((math.cos(a), math.sin(a), 0.0)) * settings.radius
            for a in (2 * math.pi * i / steps for i in range(steps + 1))
        ]
        for a, b in zip(circle, circle[1:]):
            lines += [a, b]
    shader = gpu.shader.from_builtin("UNIFORM_COLOR" if bpy.app.version >= (4, 0, 0) else "3D_UNIFORM_COLOR")
    shader.bind()
    shader.uniform_float("color", (1.0, 0.6, 0.1, 0.8))
    batch_for_shader(shader, "LINES", {"pos": lines}).draw(shader)


def register():
    global _handle
    if not bpy.app.background:
        _handle = bpy.types.SpaceView3D.draw_handler_add(_draw, (), "WINDOW", "POST_VIEW")


def unregister():
    global _handle
    if _handle is not None:
        bpy.types.SpaceView3D.draw_handler_remove(_handle, "WINDOW")
        _handle = None
