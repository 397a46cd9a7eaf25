#!/usr/bin/env python3
"""Writes the binary seeds into corpus/. The text seeds are written by hand.

    make_corpus.py PROGRAM

PROGRAM is build/alcove; it makes one of the level sets. gltfpack and draco_encoder (Debian: draco) make two of the scenes.
"""
import base64
import json
import os
import struct
import subprocess
import sys
import tempfile

CORPUS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "corpus")
POINTS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]


def write(name, data):
    with open(os.path.join(CORPUS, name), "wb") as seed:
        seed.write(data)


def ply(order, word):
    header = ("ply\nformat binary_%s_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
              "property ushort red\nproperty ushort green\nproperty ushort blue\n"
              "element face 2\nproperty list uchar int vertex_indices\nproperty list int float texcoord\n"
              "element extra 1\nproperty double weight\nend_header\n" % word).encode()
    rows = b"".join(struct.pack(order + "3f3H", *p, 0, 65535, 257) for p in POINTS)
    rows += struct.pack(order + "B3ii", 3, 0, 1, 2, 0) + struct.pack(order + "B4ii8f", 4, 0, 1, 2, 3, 8, *range(8))
    return header + rows + struct.pack(order + "d", 0.5)


def off():
    data = b"CNOFF BINARY\n" + struct.pack(">3i", 4, 2, 0)
    data += b"".join(struct.pack(">10f", *p, 0, 0, 1, 1, 0.5, 0, 1) for p in POINTS)
    return data + struct.pack(">5i3f", 3, 0, 1, 2, 3, 1, 0, 0) + struct.pack(">6i", 4, 0, 1, 2, 3, 0)


def stl(title):
    data = title.ljust(80).encode() + struct.pack("<I", 2)
    for corners in ((0, 1, 2), (0, 2, 3)):
        data += struct.pack("<3f", 0, 0, 1) + b"".join(struct.pack("<3f", *POINTS[c]) for c in corners) + \
            struct.pack("<H", 0x7c00)
    return data


def glb(meshes, nodes, views, accessors, binary, **more):
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
             "meshes": meshes, "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}
    scene.update(more)
    words = json.dumps(scene).encode()
    words += b" " * (-len(words) % 4)
    binary += bytes(-len(binary) % 4)
    return (b"glTF" + struct.pack("<2I", 2, 28 + len(words) + len(binary)) + struct.pack("<I", len(words)) + b"JSON" + words +
            struct.pack("<I", len(binary)) + b"BIN\0" + binary)


def accessor(view, component, count, kind, **more):
    return dict({"bufferView": view, "componentType": component, "count": count, "type": kind}, **more)


def gltf_rich():
    """A strip and a triangle list with colours, UVs, sparse values, a skin, instances and materials."""
    parts = [struct.pack("<12f", *sum(map(list, POINTS), [])), struct.pack("<6H", 0, 1, 2, 0, 2, 3), struct.pack("<4B", 0, 1, 3, 2),
             struct.pack("<8f", 0, 0, 1, 0, 1, 1, 0, 1), struct.pack("<16B", *range(0, 256, 16)), struct.pack("<B", 2) + bytes(3),
             struct.pack("<3f", 1, 1, 0.5), struct.pack("<6f", 0, 0, 0, 0, 0, 2), struct.pack("<16f", *([1, 0, 0, 0, 0] * 3 + [1]))]
    views, binary = [], b""
    for part in parts:
        binary += bytes(-len(binary) % 4)
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(part)})
        binary += part
    accessors = [accessor(0, 5126, 4, "VEC3"), accessor(1, 5123, 6, "SCALAR"), accessor(2, 5121, 4, "SCALAR"),
                 accessor(3, 5126, 4, "VEC2"), accessor(4, 5121, 4, "VEC4", normalized=True),
                 accessor(0, 5126, 4, "VEC3", sparse={"count": 1, "indices": {"bufferView": 5, "componentType": 5121},
                                                      "values": {"bufferView": 6}}),
                 accessor(7, 5126, 2, "VEC3"), accessor(8, 5126, 1, "MAT4")]
    attributes = {"POSITION": 0, "TEXCOORD_0": 3, "COLOR_0": 4}
    meshes = [{"name": "list", "primitives": [{"attributes": attributes, "indices": 1, "material": 0}]},
              {"primitives": [{"attributes": {"POSITION": 5}, "indices": 2, "mode": 5, "targets": [{"POSITION": 0}]}]}]
    nodes = [{"name": "a", "mesh": 0, "scale": [-1, 2, 1], "rotation": [0, 0, 0.7071, 0.7071]}, {"mesh": 1, "skin": 0},
             {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 6}}}}]
    return glb(meshes, nodes, views, accessors, binary, skins=[{"joints": [0], "inverseBindMatrices": 7}],
               materials=[{"name": "glass", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0, 0.5]}}])


def gltf_with_data_uri():
    binary = struct.pack("<12f", *sum(map(list, POINTS), [])) + struct.pack("<6I", 0, 1, 2, 0, 2, 3)
    scene = {"asset": {"version": "2.0"}, "nodes": [{"mesh": 0, "children": [1]}, {"mesh": 0, "translation": [0, 0, 1]}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
             "accessors": [accessor(0, 5126, 4, "VEC3"), accessor(1, 5125, 6, "SCALAR")],
             "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
             "buffers": [{"byteLength": len(binary),
                          "uri": "data:application/octet-stream;base64," + base64.b64encode(binary).decode()}]}
    return json.dumps(scene, indent=1).encode()


def gltf_meshopt():
    with tempfile.TemporaryDirectory() as folder:
        source, target = os.path.join(folder, "in.gltf"), os.path.join(folder, "out.glb")
        with open(source, "wb") as out:
            out.write(gltf_with_data_uri())
        subprocess.run(["gltfpack", "-i", source, "-o", target, "-cc"], check=True, stdout=subprocess.DEVNULL)
        with open(target, "rb") as data:
            return data.read()


def gltf_draco():
    with tempfile.TemporaryDirectory() as folder:
        mesh, packed = os.path.join(folder, "mesh.obj"), os.path.join(folder, "mesh.drc")
        with open(mesh, "w") as out:
            out.write("".join("v %g %g %g\n" % p for p in POINTS) + "f 1 2 3\nf 1 3 4\n")
        subprocess.run(["draco_encoder", "-i", mesh, "-o", packed], check=True, stdout=subprocess.DEVNULL)
        with open(packed, "rb") as data:
            binary = data.read()
    primitive = {"attributes": {"POSITION": 0}, "indices": 1,
                 "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}}
    return glb([{"primitives": [primitive]}], [{"mesh": 0}], [{"buffer": 0, "byteLength": len(binary)}],
               [{"componentType": 5126, "count": 4, "type": "VEC3"}, {"componentType": 5123, "count": 6, "type": "SCALAR"}],
               binary, extensionsUsed=["KHR_draco_mesh_compression"], extensionsRequired=["KHR_draco_mesh_compression"])


def text(words):
    return struct.pack("<I", len(words)) + words.encode()


def vdb(offsets, meta):
    """A ball in one leaf; stores active values only, uncompressed."""
    def metadata(entries):
        return struct.pack("<I", len(entries)) + b"".join(
            text(name) + text(kind) + struct.pack("<I", len(value)) + value for name, kind, value in entries)

    def node(mask_bytes):
        """A node with one child, at its origin, and the background everywhere else."""
        return b"\1" + bytes(mask_bytes - 1) + bytes(mask_bytes) + b"\0"

    voxel, active_only = 0.125, 2
    distances = [((x - 3.5) ** 2 + (y - 3.5) ** 2 + (z - 3.5) ** 2) ** 0.5 - 2 for x in range(8) for y in range(8)
                 for z in range(8)]
    values = struct.pack("<512f", *(voxel * d for d in distances))

    grid = struct.pack("<I", active_only) + metadata(meta)
    grid += text("UniformScaleMap") + struct.pack("<15d", *[voxel] * 6, *[1 / voxel] * 3, *[1 / voxel ** 2] * 3,
                                                  *[0.5 / voxel] * 3)
    grid += struct.pack("<ifII", 1, 3 * voxel, 0, 1) + struct.pack("<3i", 0, 0, 0)
    grid += node(4096) + node(512) + b"\xff" * 64
    topology = len(grid)
    grid += b"\xff" * 64 + b"\0" + values
    head = struct.pack("<qIIIB", 0x56444220, 224, 10, 0, offsets) + b"01234567-89ab-4def-8123-456789abcdef"
    head += metadata([]) + struct.pack("<i", 1) + text("ball") + text("Tree_float_5_4_3") + text("")
    begin = len(head) + 24
    return head + struct.pack("<3q", begin, begin + topology, begin + len(grid)) + grid


def box_of_program(program):
    with tempfile.TemporaryDirectory() as folder:
        mesh, grid = os.path.join(folder, "box.off"), os.path.join(folder, "box.vdb")
        with open(mesh, "w") as out:
            out.write("OFF 8 6 0\n" + "\n".join("%d %d %d" % (i & 1, i >> 1 & 1, i >> 2) for i in range(8)) +
                      "\n4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n")
        subprocess.run([program, "voxelize", mesh, "-o", grid, "--voxel", "20%", "--radius", "50%", "--quiet"], check=True)
        with open(grid, "rb") as data:
            return data.read()


def main():
    write("ply/little_endian.ply", ply("<", "little"))
    write("ply/big_endian.ply", ply(">", "big"))
    write("off/binary.off", off())
    write("stl/binary.stl", stl("binary"))
    write("stl/binary_named_solid.stl", stl("solid in name"))
    write("glb/rich.glb", gltf_rich())
    write("glb/data_uri.gltf", gltf_with_data_uri())
    write("glb/meshopt.glb", gltf_meshopt())
    write("glb/draco.glb", gltf_draco())
    write("vdb/masked.vdb", vdb(1, [("class", "string", b"level set"),
                                    ("file_voxel_count", "int64", struct.pack("<q", 512))]))
    write("vdb/masked_without_offsets.vdb", vdb(0, []))
    write("vdb/of_alcove.vdb", box_of_program(sys.argv[1]))
    # Options, number of vertices minus one, their coordinates, three vertices per face.
    tetrahedron = bytes([4 - 1]) + bytes([8, 8, 8, 12, 8, 8, 8, 12, 8, 8, 8, 12])
    faces = bytes([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3])
    write("voxelize/tetrahedron", b"\0" + tetrahedron + faces)
    write("voxelize/thinned_sheet", b"\x0b" + tetrahedron + faces[:6])
    write("voxelize/degenerate", b"\1" + tetrahedron + bytes([0, 0, 1, 1, 2, 2, 3, 3, 3, 0, 1, 2]))
    write("voxelize/outliers", b"\5" + bytes([3 + 12 - 1]) + bytes(range(240, 256)) + bytes(range(12)) +
          bytes([0, 1, 2, 3, 4, 5, 6, 7, 8]))


if __name__ == "__main__":
    main()
