"""Tests the Blender add-on headless: installs the zip, bakes, and compares with the program and with exact rays.

    blender --background --python test_addon.py -- ADDON.zip PROGRAM FOLDER [--module FOLDER_OF_MODULE]
"""
import json
import os
import subprocess
import sys
import time
import types

arguments = sys.argv[sys.argv.index("--") + 1:]
ADDON, PROGRAM, FOLDER = map(os.path.abspath, arguments[:3])
if "--module" in arguments:
    sys.path.insert(0, os.path.abspath(arguments[arguments.index("--module") + 1]))
os.makedirs(FOLDER, exist_ok=True)

import bpy
import numpy as np

bpy.ops.preferences.addon_install(filepath=ADDON, overwrite=True)
bpy.ops.preferences.addon_enable(module="alcove_ao")
from alcove_ao import backend, operator

bpy.context.preferences.addons["alcove_ao"].preferences.program = PROGRAM
failures = []


def check(condition, text):
    print(("ok      " if condition else "FAILED  ") + text)
    if not condition:
        failures.append(text)


def reset():
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()


def monkey(levels):
    bpy.ops.mesh.primitive_monkey_add()
    thing = bpy.context.object
    if levels:
        modifier = thing.modifiers.new("subdivide", "SUBSURF")
        modifier.levels = levels
    return thing


def settings(**values):
    for name, value in {"radius": 0.0, "quality": "good", "ground": False, "target": "VERTEX", "attribute": "ao",
                        **values}.items():
        setattr(bpy.context.scene.alcove_ao, name, value)


def bake(**values):
    settings(**values)
    start = time.time()
    result = bpy.ops.object.bake_alcove_ao()
    return result == {"FINISHED"}, time.time() - start


def values_of(thing, name="ao", key="color"):
    data = thing.data.color_attributes[name].data if key == "color" else thing.data.attributes[name].data
    width = 4 if key == "color" else 1
    values = np.empty(width * len(data), np.float32)
    data.foreach_get(key, values)
    return values.reshape(-1, width)[:, 0]


def program(surface, *options):
    source, target = os.path.join(FOLDER, "in.ply"), os.path.join(FOLDER, "out.ply")
    backend.write_ply(source, surface.vertices, surface.corners, surface.offsets)
    subprocess.run([PROGRAM, "bake", source, "-o", target, "--quiet", "--color", "none", *options], check=True)
    return backend.read_ao(target, len(surface.vertices))


def evaluated(thing):
    return operator.surface_of(thing, bpy.context.evaluated_depsgraph_get())


def render(things, attribute, name):
    """A picture of the colours, to look at."""
    material = bpy.data.materials.new(attribute)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    color, emission, output = map(nodes.new, ("ShaderNodeVertexColor", "ShaderNodeEmission", "ShaderNodeOutputMaterial"))
    color.layer_name = attribute
    links.new(color.outputs["Color"], emission.inputs["Color"])
    links.new(emission.outputs["Emission"], output.inputs["Surface"])
    for thing in things:
        thing.data.materials.clear()
        thing.data.materials.append(material)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.collection.objects.link(camera)
    camera.location, camera.rotation_euler = (8, -8, 7), (0.95, 0, 0.785)
    scene = bpy.context.scene
    scene.camera, scene.render.engine, scene.cycles.samples = camera, "CYCLES", 4
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y, scene.render.filepath = 320, 240, os.path.join(FOLDER, name)
    bpy.ops.render.render(write_still=True)


# Suzanne, subdivided by a modifier that is applied.
reset()
thing = monkey(2)
bpy.ops.object.modifier_apply(modifier=thing.modifiers[0].name)
ok, seconds = bake(quality="good")
check(ok, "Suzanne, vertex colours (%.2f s for %d vertices)" % (seconds, len(thing.data.vertices)))
expected = program(evaluated(thing))
check(np.array_equal(values_of(thing), expected), "vertex values equal those of the program")
ok, _ = bake(target="FLOAT", attribute="occlusion")
check(ok and np.array_equal(values_of(thing, "occlusion", "value"), expected), "a float attribute has the same values")
ok, _ = bake(target="CORNER", attribute="corners")
check(ok and len(values_of(thing, "corners")) == len(thing.data.loops), "corner colours")

# The same with the modifier in place.
reset()
thing = monkey(2)
ok, _ = bake()
check(ok and len(values_of(thing)) == len(thing.data.vertices), "with a modifier, the own vertices get values")

# Five objects, which occlude each other; one is mirrored.
reset()
bpy.ops.mesh.primitive_plane_add(size=12)
for add, options in (("primitive_cube_add", {"location": (0, 0, 1)}), ("primitive_uv_sphere_add", {"location": (2.2, 0, 1)}),
                     ("primitive_torus_add", {"location": (-2.5, 0, 0.3)}), ("primitive_cone_add", {"location": (0, 2.5, 1)})):
    getattr(bpy.ops.mesh, add)(**options)
bpy.context.object.scale.x = -1
bpy.ops.object.select_all(action="SELECT")
things = [t for t in bpy.context.selected_objects]
ok, _ = bake(radius=2.0, attribute="vertices")
expected = program(backend.Surface.joined([evaluated(t) for t in things]), "--radius", "2.0")
check(ok and np.array_equal(np.concatenate([values_of(t, "vertices") for t in things]), expected),
      "vertex values of five objects equal those of the program")
ok, seconds = bake(quality="fine", target="CORNER", radius=2.0)
check(ok, "five objects, corners (%.2f s)" % seconds)
joined = backend.Surface.joined([evaluated(t) for t in things])
exact = backend.Bake(2.0, "fine", False, PROGRAM)
if backend.alcove is not None:
    points = (joined.corner_points(), joined.normals, joined.faces_of_corners())
    truth = backend.alcove.bake((joined.vertices, (joined.corners, joined.offsets)), points=points, radius=2.0, method="exact",
                                parameters={"rays": 1024}).ao
    first, squares = 0, 0.0
    for t in things:
        surface = evaluated(t)
        own = truth[first:first + len(surface.corners)]
        first += len(surface.corners)
        if surface.order is not None:
            own = own[np.argsort(surface.order)]
        squares += ((values_of(t) - own) ** 2).sum()
    rmse = (squares / first) ** 0.5
    check(rmse < 0.0075, "corners are within the quality of exact rays: RMSE %.4f" % rmse)

# An image.
for t in things:
    t.select_set(t.name.startswith("Torus") or t.name.startswith("Plane"))
torus = next(t for t in things if t.name.startswith("Torus"))
bpy.context.view_layer.objects.active = torus
material = bpy.data.materials.new("ao")
material.use_nodes = True
node = material.node_tree.nodes.new("ShaderNodeTexImage")
node.image = bpy.data.images.new("ao", 256, 128, float_buffer=True)
material.node_tree.nodes.active = node
torus.data.materials.append(material)
ok, seconds = bake(target="IMAGE", radius=2.0)
pixels = np.array(node.image.pixels[:]).reshape(128, 256, 4)[..., 0]
check(ok and 0.0 <= pixels.min() < 0.6 and pixels.max() == 1.0, "an image (%.2f s): values %.2f to %.2f" % (seconds, pixels.min(), pixels.max()))
if backend.alcove is not None:
    surfaces = [operator.surface_of(t, bpy.context.evaluated_depsgraph_get(), needs_uvs=t == torus)
                for t in bpy.context.selected_objects]
    surfaces.sort(key=lambda surface: surface.uvs is None)
    mesh, others = surfaces[0], [(s.vertices, (s.corners, s.offsets)) for s in surfaces[1:]]
    truth = backend.alcove.bake_maps(
        backend.alcove.Mesh(mesh.vertices, (mesh.corners, mesh.offsets), corner_normals=mesh.normals, corner_uvs=mesh.uvs),
        size=(256, 128), occluders=others, radius=2.0, method="exact", parameters={"rays": 1024})
    covered = truth.coverage == 1
    rmse = np.sqrt(np.mean((pixels[::-1] - truth.ao)[covered] ** 2))
    check(covered.sum() > 10000 and rmse < 0.02, "texels are within the quality of exact rays: RMSE %.4f" % rmse)
node.image.filepath_raw = os.path.join(FOLDER, "torus.png")
node.image.file_format = "PNG"
node.image.save()
render(things, "ao", "five_objects.png")

# What goes wrong.
def error_of(**values):
    settings(**values)
    try:
        bpy.ops.object.bake_alcove_ao()
    except RuntimeError as error:
        return str(error)
    return ""


reset()
thing = monkey(0)
check("active image texture node" in error_of(target="IMAGE"), "an image without a node is refused")
before = len(thing.data.color_attributes)
empty = bpy.data.objects.new("empty", bpy.data.meshes.new("empty"))
bpy.context.collection.objects.link(empty)
empty.select_set(True)
check("'empty' has no faces" in error_of(), "a mesh without faces is refused")
check(len(thing.data.color_attributes) == before, "nothing is written after an error")
empty.select_set(False)
module, backend.alcove = backend.alcove, None
ok, _ = bake(attribute="by_program")
check(ok, "without the module, the program is used")
ok, _ = bake(attribute="corners_by_program", target="CORNER")
check(ok, "corners by the program")
bpy.context.preferences.addons["alcove_ao"].preferences.program = "/nowhere/alcove"
check("Alcove was not found" in error_of(attribute="never"), "without both, the message says so")
check("never" not in thing.data.attributes, "nothing is written then")
backend.alcove = module


# Blender without windows sends no events to a modal operator, so that the test sends them to its methods.
class Modal:
    def __init__(self):
        self.reports = []

    def report(self, kind, text):
        self.reports.append((*kind, text))


for name, value in vars(operator.OBJECT_OT_bake_alcove_ao).items():
    if callable(value) and not name.startswith("__"):
        setattr(Modal, name, value)


def run_modal(event):
    """Invokes the operator with an event first, and then with those of the timer."""
    manager = types.SimpleNamespace(event_timer_add=lambda *_, **__: None, event_timer_remove=lambda _: None,
                                    modal_handler_add=lambda _: None, progress_begin=lambda *_: None,
                                    progress_update=lambda _: None, progress_end=lambda: None)
    context = types.SimpleNamespace(scene=bpy.context.scene, preferences=bpy.context.preferences,
                                    active_object=bpy.context.active_object,
                                    selected_objects=bpy.context.selected_objects, window=None, window_manager=manager,
                                    evaluated_depsgraph_get=bpy.context.evaluated_depsgraph_get)
    modal = Modal()
    result = modal.invoke(context, None)
    while result == {"RUNNING_MODAL"}:
        result = modal.modal(context, types.SimpleNamespace(type=event))
        event = "TIMER"
        time.sleep(0.01)
    return result, modal.reports


bpy.context.preferences.addons["alcove_ao"].preferences.program = PROGRAM
bake(attribute="kept")
before = values_of(thing, "kept")
for with_module in (True, False) if module else (False,):
    backend.alcove = module if with_module else None
    name = "module" if with_module else "program"
    settings(attribute="kept", quality="fine", radius=0.1)
    result, reports = run_modal("ESC")
    check(result == {"CANCELLED"} and reports == [("WARNING", "The bake was cancelled, and nothing was changed")],
          "a cancelled bake says so (%s)" % name)
    check(np.array_equal(values_of(thing, "kept"), before), "a cancelled bake changes no values (%s)" % name)
    settings(attribute="never")
    run_modal("ESC")
    check("never" not in thing.data.attributes, "a cancelled bake adds no attribute (%s)" % name)
    settings(attribute="modal_" + name)
    result, reports = run_modal("TIMER")
    check(result == {"FINISHED"} and reports[-1][0] == "INFO" and len(values_of(thing, "modal_" + name)) == len(before),
          "a modal bake ends (%s)" % name)
backend.alcove = None
bpy.context.preferences.addons["alcove_ao"].preferences.program = "/nowhere/alcove"
settings(attribute="never")
result, reports = run_modal("TIMER")
check(result == {"CANCELLED"} and reports[0][0] == "ERROR" and "Alcove was not found" in reports[0][1],
      "a modal bake without the program says so")
check("never" not in thing.data.attributes, "and writes nothing")

print("%d failures" % len(failures))
sys.exit(1 if failures else 0)
