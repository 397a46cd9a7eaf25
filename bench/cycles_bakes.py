"""Compares the Blender add-on with Blender's own bake of ambient occlusion (Cycles) to vertex colours.

    tools/addon.sh
    blender --background --factory-startup --python bench/cycles_bakes.py -- \\
        build/alcove_blender.zip build/alcove [--module build/python] [--quality good] | grep "RMSE 0"

Both bake the same scenes with the same radius. Errors are RMSE against exact rays of the program, 4,096 per vertex.
The samples of Cycles are increased in steps of a quarter until its error is at most that of the add-on. Times are
wall-clock seconds of the whole operators (for the add-on, the shortest of three runs), and CPU seconds including those
of the program.
"""
import argparse
import os
import subprocess
import sys
import tempfile
import time

import bpy
import numpy as np

parser = argparse.ArgumentParser()
parser.add_argument("addon", type=os.path.abspath)
parser.add_argument("program", type=os.path.abspath)
parser.add_argument("--module", type=os.path.abspath, help="without it, the add-on runs the program")
parser.add_argument("--quality", default="good")
options = parser.parse_args(sys.argv[sys.argv.index("--") + 1:])
if options.module:
    sys.path.insert(0, options.module)

bpy.ops.preferences.addon_install(filepath=options.addon, overwrite=True)
bpy.ops.preferences.addon_enable(module="alcove_ao")
from alcove_ao import backend, operator

bpy.context.preferences.addons["alcove_ao"].preferences.program = options.program
RADIUS = 1.0


def clear():
    bpy.ops.object.select_all(action="SELECT")
    bpy.ops.object.delete()


def subdivide(levels):
    thing = bpy.context.object
    modifier = thing.modifiers.new("subdivide", "SUBSURF")
    modifier.levels = levels
    bpy.ops.object.modifier_apply(modifier=modifier.name)


def suzanne():
    bpy.ops.mesh.primitive_monkey_add()
    subdivide(3)


def five_objects():
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=100, y_subdivisions=100, size=12)
    for add, options in (("primitive_cube_add", {"location": (0, 0, 1)}),
                         ("primitive_uv_sphere_add", {"location": (2.2, 0, 1)}),
                         ("primitive_torus_add", {"location": (-2.5, 0, 0.3)}),
                         ("primitive_cone_add", {"location": (0, 2.5, 1)})):
        getattr(bpy.ops.mesh, add)(**options)
        subdivide(3)


def select_all():
    bpy.ops.object.select_all(action="SELECT")
    things = [thing for thing in bpy.context.selected_objects if thing.type == "MESH"]
    bpy.context.view_layer.objects.active = things[0]
    return things


def seconds_of(bake):
    """Wall-clock and CPU seconds."""
    before = time.perf_counter(), sum(os.times()[:4])
    assert bake() == {"FINISHED"}
    return time.perf_counter() - before[0], sum(os.times()[:4]) - before[1]


def values_of(things, name):
    values = []
    for thing in things:
        data = thing.data.color_attributes[name].data
        colors = np.empty(4 * len(data), np.float32)
        data.foreach_get("color", colors)
        values.append(colors[::4])
    return np.concatenate(values)


def reference(things):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    surface = backend.Surface.joined([operator.surface_of(thing, depsgraph) for thing in things])
    with tempfile.TemporaryDirectory() as folder:
        source, target = os.path.join(folder, "in.ply"), os.path.join(folder, "out.ply")
        backend.write_ply(source, surface.vertices, surface.corners, surface.offsets)
        subprocess.run([options.program, "bake", source, "-o", target, "--quiet", "--color", "none", "--radius",
                        str(RADIUS), "--method", "exact", "--rays", "4096", "--seed", "1"], check=True)
        return backend.read_ao(target, len(surface.vertices))


def prepare_cycles(things):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_adaptive_sampling = False
    scene.world.light_settings.distance = RADIUS
    scene.render.bake.target = "VERTEX_COLORS"
    for thing in things:
        thing.data.color_attributes.active_color = thing.data.color_attributes.new("cycles", "FLOAT_COLOR", "POINT")


def compare(name, make):
    clear()
    make()
    things = select_all()
    truth = reference(things)

    def error_of(attribute):
        return float(np.sqrt(np.mean((values_of(things, attribute) - truth) ** 2)))

    settings = bpy.context.scene.alcove_ao
    settings.radius, settings.quality, settings.target, settings.attribute = RADIUS, options.quality, "VERTEX", "alcove"
    ours = min(seconds_of(bpy.ops.object.bake_alcove_ao) for _ in range(3))
    error = error_of("alcove")
    print("%s, %d vertices: the add-on takes %.2f s (CPU %.2f s), RMSE %.4f" % (name, len(truth), *ours, error),
          flush=True)
    prepare_cycles(things)
    samples, theirs, their_error = 8, None, 1.0
    while their_error > error:
        samples = samples * 5 // 4
        bpy.context.scene.cycles.samples = samples
        theirs = seconds_of(lambda: bpy.ops.object.bake(type="AO"))
        their_error = error_of("cycles")
    print("%s: Cycles with %d samples takes %.2f s (CPU %.2f s), RMSE %.4f: %.0f times as long (CPU %.0f)" % (
        name, samples, *theirs, their_error, theirs[0] / ours[0], theirs[1] / ours[1]), flush=True)


compare("Suzanne", suzanne)
compare("Five objects", five_objects)
