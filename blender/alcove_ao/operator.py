"""The operator, its menu entry and its panel."""
import threading

import bpy
import numpy as np

from . import backend


def corner_normals(mesh, to_world):
    """The unit normals of all corners, in world coordinates."""
    normals = np.empty(3 * len(mesh.loops), np.float32)
    if hasattr(mesh, "calc_normals_split"):  # before Blender 4.1
        mesh.calc_normals_split()
        mesh.loops.foreach_get("normal", normals)
    else:
        mesh.corner_normals.foreach_get("vector", normals)
    turned = normals.reshape(-1, 3) @ np.linalg.pinv(to_world[:3, :3])
    return turned / np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), 1e-30)


def surface_of(thing, depsgraph, needs_normals=True, needs_uvs=False):
    """The mesh of an object with its modifiers applied, in world coordinates. Normals take as long as the rest."""
    evaluated = thing.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        if len(mesh.polygons) == 0:
            raise backend.Failed("'%s' has no faces: there is nothing to bake" % thing.name)
        vertices = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.vertices.foreach_get("co", vertices)
        corners = np.empty(len(mesh.loops), np.int32)
        mesh.loops.foreach_get("vertex_index", corners)
        starts = np.empty(len(mesh.polygons), np.int32)
        mesh.polygons.foreach_get("loop_start", starts)
        to_world = np.array(thing.matrix_world)
        places = vertices.reshape(-1, 3) @ to_world[:3, :3].T + to_world[:3, 3]
        mirrored = np.linalg.det(to_world[:3, :3]) < 0.0
        normals = corner_normals(mesh, to_world) if needs_normals else None
        uvs = None
        if needs_uvs:
            layer = mesh.uv_layers.active
            if layer is None:
                raise backend.Failed("'%s' has no UVs, which an image needs: unwrap it first" % thing.name)
            uvs = np.empty(2 * len(mesh.loops), np.float32)
            layer.data.foreach_get("uv", uvs)
            uvs = uvs.reshape(-1, 2)
        offsets = np.append(starts, len(corners))
        surface = backend.Surface(places, corners, offsets, normals, uvs)
        surface.order = None
        if mirrored:  # mirroring turns faces inside out
            order = np.concatenate([np.arange(a, b)[::-1] for a, b in zip(offsets[:-1], offsets[1:])])
            surface.order = order
            surface.corners = surface.corners[order]
            surface.normals = None if normals is None else normals[order]
            surface.uvs = None if uvs is None else uvs[order]
        return surface
    finally:
        evaluated.to_mesh_clear()


def nearest_vertices(thing, depsgraph):
    """For each vertex of the object's own mesh, the nearest vertex of the mesh with modifiers; None if both match."""
    from mathutils.kdtree import KDTree

    evaluated = thing.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        if len(mesh.vertices) == len(thing.data.vertices) and len(mesh.loops) == len(thing.data.loops):
            return None
        tree = KDTree(len(mesh.vertices))
        for i, vertex in enumerate(mesh.vertices):
            tree.insert(vertex.co, i)
        tree.balance()
        return np.array([tree.find(vertex.co)[1] for vertex in thing.data.vertices], np.int64)
    finally:
        evaluated.to_mesh_clear()


def active_image(thing):
    material = thing.active_material
    node = material.node_tree.nodes.active if material and material.use_nodes else None
    if node is None or node.type != "TEX_IMAGE" or node.image is None:
        raise backend.Failed(
            "'%s' has no active image texture node with an image: add one to its material and select it" % thing.name
        )
    return node.image


def write_values(mesh, name, domain, values, as_color):
    """Writes values to an attribute; replaces an attribute with the same name but another type or domain."""
    if as_color:
        layer = mesh.color_attributes.get(name)
        if layer is None or layer.domain != domain or layer.data_type != "FLOAT_COLOR":
            if name in mesh.attributes:
                mesh.attributes.remove(mesh.attributes[name])
            layer = mesh.color_attributes.new(name, "FLOAT_COLOR", domain)
        colors = np.ones((len(values), 4), np.float32)
        colors[:, :3] = values[:, None]
        layer.data.foreach_set("color", colors.ravel())
        mesh.color_attributes.active_color = layer
    else:
        layer = mesh.attributes.get(name)
        if layer is None or layer.domain != domain or layer.data_type != "FLOAT":
            if layer is not None:
                mesh.attributes.remove(layer)
            layer = mesh.attributes.new(name, "FLOAT", domain)
        layer.data.foreach_set("value", np.ascontiguousarray(values, np.float32))
    mesh.update()


class OBJECT_OT_bake_alcove_ao(bpy.types.Operator):
    """Bake ambient occlusion of the selected objects, which occlude each other"""

    bl_idname = "object.bake_alcove_ao"
    bl_label = "Bake Alcove AO"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.mode == "OBJECT" and any(thing.type == "MESH" for thing in context.selected_objects)

    def prepare(self, context):
        """Collects everything that the bake needs from Blender's data."""
        settings = context.scene.alcove_ao
        preferences = context.preferences.addons.get(__package__)
        depsgraph = context.evaluated_depsgraph_get()
        self.things = [thing for thing in context.selected_objects if thing.type == "MESH"]
        self.target, self.attribute_name = settings.target, settings.attribute.strip() or "ao"
        self.is_cancelled, self.done = False, 0.0
        self.bake = backend.Bake(
            settings.radius, settings.quality, settings.ground, preferences.preferences.program if preferences else "alcove",
            progress=self.set_progress, cancelled=lambda: self.is_cancelled,
        )
        if self.target == "IMAGE":
            active = context.active_object
            if active not in self.things:
                raise backend.Failed("the active object must be a selected mesh, as it has the image")
            self.image = active_image(active)
            self.size = tuple(self.image.size)
            self.surfaces = [surface_of(active, depsgraph, needs_uvs=True)]
            self.others = [surface_of(thing, depsgraph, needs_normals=False) for thing in self.things if thing != active]
        else:
            if len({thing.data for thing in self.things}) < len(self.things):
                raise backend.Failed("selected objects share a mesh: make it single-user first (Object > Relations)")
            for thing in self.things:
                layer = thing.data.attributes.get(self.attribute_name)
                if layer is not None and layer.data_type not in {"FLOAT_COLOR", "BYTE_COLOR", "FLOAT"}:
                    raise backend.Failed("'%s' has an attribute '%s' of another kind: choose another name"
                                         % (thing.name, self.attribute_name))
            self.surfaces = [surface_of(thing, depsgraph, self.target == "CORNER") for thing in self.things]
            self.nearest = [nearest_vertices(thing, depsgraph) for thing in self.things]

    def set_progress(self, done):
        self.done = done

    def compute(self):
        """The slow part. It does not access Blender's data."""
        if self.target == "IMAGE":
            return self.bake.image(self.surfaces[0], self.others, *self.size)
        joined = backend.Surface.joined(self.surfaces)
        # Values at the corners of a mesh with modifiers fit the object's own mesh only if both match.
        if self.target == "CORNER" and all(nearest is None for nearest in self.nearest):
            return self.bake.corners(joined)
        return self.bake.vertices(joined)

    def finish(self, values):
        if self.target == "IMAGE":
            width, height = self.size
            pixels = np.ones((height, width, 4), np.float32)
            pixels[..., :3] = self.bake.pixels(values, width, height)[..., None]
            self.image.colorspace_settings.name = "Non-Color"
            self.image.pixels.foreach_set(pixels.ravel())
            self.image.update()
        else:
            self.finish_attributes(np.asarray(values))
        for warning in self.bake.warnings:
            self.report({"WARNING"}, warning)
        self.report({"INFO"}, "AO %s" % self.bake.summary)

    def finish_attributes(self, values):
        of_corners = self.target == "CORNER" and all(nearest is None for nearest in self.nearest)
        first = 0
        for thing, surface, nearest in zip(self.things, self.surfaces, self.nearest):
            count = len(surface.corners) if of_corners else len(surface.vertices)
            own = values[first : first + count]
            first += count
            if of_corners and surface.order is not None:
                own = own[np.argsort(surface.order)]
            if nearest is not None:
                own = own[nearest]
            if self.target == "CORNER" and not of_corners:
                corners = np.empty(len(thing.data.loops), np.int32)
                thing.data.loops.foreach_get("vertex_index", corners)
                own = own[corners]
            write_values(thing.data, self.attribute_name, "CORNER" if self.target == "CORNER" else "POINT", own,
                         as_color=self.target != "FLOAT")

    def execute(self, context):
        try:
            self.prepare(context)
            self.finish(self.compute())
        except backend.Failed as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context, event):
        try:
            self.prepare(context)
        except backend.Failed as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.result, self.error = None, None

        def work():
            try:
                self.result = self.compute()
            except Exception as error:  # shown by the main thread
                self.error = error

        self.thread = threading.Thread(target=work)
        self.thread.start()
        self.timer = context.window_manager.event_timer_add(0.1, window=context.window)
        context.window_manager.progress_begin(0, 100)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self.is_cancelled = True
        context.window_manager.progress_update(int(100 * self.done))
        if event.type != "TIMER" or self.thread.is_alive():
            return {"RUNNING_MODAL"}
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        if isinstance(self.error, backend.Cancelled):
            self.report({"WARNING"}, "The bake was cancelled, and nothing was changed")
            return {"CANCELLED"}
        if self.error is not None:
            self.report({"ERROR"}, str(self.error))
            return {"CANCELLED"}
        self.finish(self.result)
        return {"FINISHED"}


class VIEW3D_PT_alcove_ao(bpy.types.Panel):
    bl_label = "Alcove AO"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Alcove"

    def draw(self, context):
        settings = context.scene.alcove_ao
        self.layout.use_property_split = True
        for name in ("radius", "show_radius", "quality", "ground", "target"):
            self.layout.prop(settings, name)
        if settings.target != "IMAGE":
            self.layout.prop(settings, "attribute")
        self.layout.operator(OBJECT_OT_bake_alcove_ao.bl_idname)


def draw_menu(menu, context):
    menu.layout.operator(OBJECT_OT_bake_alcove_ao.bl_idname)
