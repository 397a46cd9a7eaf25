"""Makes glTF scenes with Blender's exporter.

    blender --background --python make_scenes.py -- FOLDER
"""
import math
import os
import sys

import bpy

FOLDER = sys.argv[sys.argv.index("--") + 1]
SCENES = {}


def scene(**export):
    def register(build):
        SCENES[build.__name__] = (build, export)
        return build
    return register


def material(name, color, blend=None, image=None):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = color
    if blend:
        shader.inputs["Alpha"].default_value = color[3]
        made.blend_method = blend
    if image:
        node = made.node_tree.nodes.new("ShaderNodeTexImage")
        node.image = image
        made.node_tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    return made


def monkey(levels=1):
    bpy.ops.mesh.primitive_monkey_add()
    made = bpy.context.object
    if levels == 0:
        return made
    modifier = made.modifiers.new("subdivide", "SUBSURF")
    modifier.levels = levels
    bpy.ops.object.modifier_apply(modifier=modifier.name)
    return made


def unwrap(thing):
    bpy.context.view_layer.objects.active = thing
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.uv.smart_project(island_margin=0.02)
    bpy.ops.object.mode_set(mode="OBJECT")


@scene()
def cube():
    bpy.ops.mesh.primitive_cube_add()


@scene()
def smooth_monkey():
    made = monkey()
    bpy.ops.object.shade_smooth()
    made.data.materials.append(material("skin", (0.8, 0.4, 0.2, 1)))


@scene(export_normals=False)
def without_normals():
    monkey()


@scene(export_format="GLTF_SEPARATE")
def separate():
    monkey()


@scene(export_format="GLTF_EMBEDDED")
def embedded():
    monkey()


@scene()
def instances():
    bpy.ops.mesh.primitive_plane_add(size=40)
    first = monkey(0)
    first.location = (-15, -15, 1)
    for i in range(1, 200):
        copy = bpy.data.objects.new("monkey", first.data)
        copy.location = (-15 + 2 * (i % 16), -15 + 2 * (i // 16), 1 + 0.02 * i)
        copy.rotation_euler = (0.1 * i, 0.2 * i, 0.3 * i)
        bpy.context.collection.objects.link(copy)


@scene()
def mirrored():
    for i, scale in enumerate([(-1, 1, 1), (1, -2, 1), (-1, -1, -0.5), (2, 1, 0.5)]):
        made = monkey(0)
        made.location.x = 4 * i
        made.scale = scale


@scene()
def hierarchy():
    bpy.ops.object.empty_add(location=(1, 2, 3), rotation=(0.3, 0.2, 0.1))
    parent = bpy.context.object
    parent.name = "furniture"
    parent.scale = (2, 2, 2)
    for i, name in enumerate(["chair", "table", "lamp"]):
        bpy.ops.mesh.primitive_cylinder_add(location=(2 * i, 0, 0))
        bpy.context.object.name = name
        bpy.context.object.parent = parent


@scene()
def vertex_colors():
    made = monkey()
    layer = made.data.color_attributes.new("paint", "BYTE_COLOR", "CORNER")
    for i, value in enumerate(layer.data):
        value.color = (i % 7 / 7, i % 5 / 5, i % 3 / 3, 1)


@scene()
def textured():
    made = monkey()
    unwrap(made)
    image = bpy.data.images.new("checks", 64, 64)
    image.generated_type = "UV_GRID"
    made.data.materials.append(material("checked", (1, 1, 1, 1), image=image))


@scene()
def packed():
    made = monkey()
    unwrap(made)
    image = bpy.data.images.new("metal", 256, 256, is_data=True)
    image.generated_type = "UV_GRID"
    made.data.materials.append(material("metal", (1, 1, 1, 1)))
    nodes, links = made.data.materials[0].node_tree.nodes, made.data.materials[0].node_tree.links
    texture, channels = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeSeparateColor")
    texture.image = image
    links.new(texture.outputs["Color"], channels.inputs["Color"])
    links.new(channels.outputs["Green"], nodes["Principled BSDF"].inputs["Roughness"])
    links.new(channels.outputs["Blue"], nodes["Principled BSDF"].inputs["Metallic"])


@scene()
def two_uv_sets():
    made = monkey()
    made.data.uv_layers[0].name = "tiled"
    for value in made.data.uv_layers[0].data:
        value.uv = (0.25, 0.25)
    made.data.uv_layers.new(name="unique")
    made.data.uv_layers.active_index = 1
    unwrap(made)


@scene(export_skins=True)
def skinned():
    made = monkey(0)
    bpy.ops.object.armature_add(location=(0, 0, -1))
    rig = bpy.context.object
    rig.scale = (2, 2, 2)
    made.select_set(True)
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")


@scene()
def shape_keys():
    made = monkey(0)
    made.shape_key_add(name="basis")
    key = made.shape_key_add(name="wide")
    for point in key.data:
        point.co.x *= 2


@scene()
def animated():
    made = monkey(0)
    for frame, angle in [(1, 0), (20, math.pi)]:
        made.rotation_euler.z = angle
        made.keyframe_insert("rotation_euler", frame=frame)


@scene(export_cameras=True, export_lights=True)
def camera_and_light():
    monkey(0)
    bpy.ops.object.camera_add(location=(5, 5, 5))
    bpy.ops.object.light_add(type="POINT", location=(0, 0, 4))


@scene()
def many_materials():
    made = monkey()
    for i in range(5):
        made.data.materials.append(material("paint %d" % i, (i / 5, 1 - i / 5, 0.5, 1)))
    for i, face in enumerate(made.data.polygons):
        face.material_index = i % 5


@scene()
def see_through():
    bpy.ops.mesh.primitive_plane_add(size=4)
    bpy.context.object.name = "floor"
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1.5, location=(0, 0, 1))
    bpy.context.object.name = "bubble"
    bpy.context.object.data.materials.append(material("glass", (1, 1, 1, 0.2), blend="BLEND"))


@scene(export_extras=True)
def custom_properties():
    made = monkey(0)
    made["weight"] = 12.5
    made.data["maker"] = "someone"
    bpy.context.scene["plan"] = "é ü 漢"


@scene()
def several_scenes():
    monkey(0)
    other = bpy.data.scenes.new("other")
    other.collection.objects.link(bpy.data.objects.new("copy", bpy.context.object.data))


@scene()
def five_objects():
    bpy.ops.mesh.primitive_plane_add(size=12)
    bpy.ops.mesh.primitive_cube_add(location=(0, 0, 1))
    bpy.ops.mesh.primitive_uv_sphere_add(location=(2.2, 0, 1))
    bpy.ops.object.shade_smooth()
    bpy.ops.mesh.primitive_torus_add(location=(-2.5, 0, 0.3))
    bpy.ops.mesh.primitive_cone_add(location=(0, 2.5, 1))


def main():
    os.makedirs(FOLDER, exist_ok=True)
    for name, (build, export) in SCENES.items():
        bpy.ops.wm.read_factory_settings(use_empty=True)
        build()
        bpy.ops.export_scene.gltf(filepath=os.path.join(FOLDER, name), **{"export_format": "GLB", **export})


main()
