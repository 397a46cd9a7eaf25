"""Blender add-on: Object > Bake Alcove AO."""
bl_info = {
    "name": "Alcove ambient occlusion",
    "author": "The Alcove authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "View3D > Object > Bake Alcove AO",
    "description": "Bakes ambient occlusion into colour attributes, float attributes or images",
    "category": "Object",
}

import bpy

from . import operator, preview


class AlcovePreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: bpy.props.StringProperty(
        name="Program",
        description="The alcove program, used where the Python module cannot be imported",
        default="alcove",
        subtype="FILE_PATH",
    )

    def draw(self, context):
        from . import backend

        self.layout.prop(self, "program")
        self.layout.label(text=backend.description(self.program))


CLASSES = (AlcovePreferences, operator.OBJECT_OT_bake_alcove_ao, operator.VIEW3D_PT_alcove_ao, preview.AlcoveSettings)


def register():
    for item in CLASSES:
        bpy.utils.register_class(item)
    bpy.types.Scene.alcove_ao = bpy.props.PointerProperty(type=preview.AlcoveSettings)
    bpy.types.VIEW3D_MT_object.append(operator.draw_menu)
    preview.register()


def unregister():
    preview.unregister()
    bpy.types.VIEW3D_MT_object.remove(operator.draw_menu)
    del bpy.types.Scene.alcove_ao
    for item in reversed(CLASSES):
        bpy.utils.unregister_class(item)
