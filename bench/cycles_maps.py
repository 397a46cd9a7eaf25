"""Compares texture maps with those that Cycles, Blender's renderer, bakes of the same mesh at equal error.

    blender --background --factory-startup --python bench/cycles_maps.py -- [--size 2048] MESH.obj | grep ':'

The samples of Cycles are increased in steps of an eighth until the RMSE of its map of 512 x 512 is at most that of
Alcove's map of 1,024 x 1,024 against 512 exact rays. The RMSE of Cycles is against its own map of 1,024 samples, so
that different normals and borders do not count as errors. Times are CPU seconds on one thread: of the bake operator
alone for Cycles, of the whole program for Alcove. Meshes need UVs, such as those that bench/unwrap.py writes.
"""
import argparse
import os
import resource
import subprocess
import sys
import tempfile

import bpy
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from map_errors import ALCOVE, bake  # noqa: E402

parser = argparse.ArgumentParser()
parser.add_argument('--size', type=int, default=2048)
parser.add_argument('mesh', type=os.path.abspath)
options = parser.parse_args(sys.argv[sys.argv.index('--') + 1:])


def cpu_seconds(who):
    usage = resource.getrusage(who)
    return usage.ru_utime + usage.ru_stime


def prepare(mesh):
    """Imports the mesh and gives it a material with an active image node; returns the node."""
    bpy.data.objects.remove(bpy.data.objects['Cube'])
    bpy.ops.wm.obj_import(filepath=mesh)
    thing = bpy.context.selected_objects[0]
    bpy.context.view_layer.objects.active = thing
    for face in thing.data.polygons:
        face.use_smooth = True
    corners = np.array([corner for corner in thing.bound_box])
    scene = bpy.context.scene
    scene.render.engine = 'CYCLES'
    scene.cycles.device = 'CPU'
    scene.render.threads_mode, scene.render.threads = 'FIXED', 1
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.world.light_settings.distance = 0.1 * float(np.linalg.norm(corners.max(0) - corners.min(0)))
    material = bpy.data.materials.new('map')
    material.use_nodes = True
    node = material.node_tree.nodes.new('ShaderNodeTexImage')
    material.node_tree.nodes.active = node
    thing.data.materials.clear()
    thing.data.materials.append(material)
    return node


def cycles(node, size, samples):
    """The values of all texels, 0 outside all faces, and the CPU seconds."""
    node.image = bpy.data.images.new('map', size, size, alpha=True, float_buffer=True)
    bpy.context.scene.cycles.samples = samples
    before = cpu_seconds(resource.RUSAGE_SELF)
    bpy.ops.object.bake(type='AO', margin=0, use_clear=True)
    seconds = cpu_seconds(resource.RUSAGE_SELF) - before
    pixels = np.empty(4 * size * size, np.float32)
    node.image.pixels.foreach_get(pixels)
    bpy.data.images.remove(node.image)
    return pixels[::4].astype(float), seconds


def samples_of(node, truth, error):
    samples, covered = 1, truth > 0
    while np.sqrt(np.mean((cycles(node, 512, samples)[0] - truth)[covered] ** 2)) > error:
        samples = samples + max(samples // 8, 1)
    return samples


def error_of(quality, truth):
    made, values = bake(options.mesh, 1024, '--quality', quality)
    return np.sqrt(np.sum((np.array(values) - np.array(truth)) ** 2) / made['texels'])


node = prepare(options.mesh)
truth, _ = cycles(node, 512, 1024)
_, exact = bake(options.mesh, 1024, '--method', 'exact', '--rays', '512', '--no-pilot')
for quality in ('draft', 'good'):
    error = error_of(quality, exact)
    samples = samples_of(node, truth, error)
    _, theirs = cycles(node, options.size, samples)
    with tempfile.TemporaryDirectory() as folder:
        before = cpu_seconds(resource.RUSAGE_CHILDREN)
        subprocess.run([ALCOVE, 'bake', options.mesh, '-o', os.path.join(folder, 'map.png'), '--quality', quality,
                        '--size', str(options.size), '--threads', '1', '--quiet'], check=True)
        ours = cpu_seconds(resource.RUSAGE_CHILDREN) - before
    print(f'{os.path.basename(options.mesh)}, {options.size} x {options.size}, {quality}, RMSE {error:.4f}: Cycles '
          f'{theirs:.1f} s with {samples} samples, Alcove {ours:.2f} s: {theirs / ours:.0f} x')
