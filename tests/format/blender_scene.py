# A still life for tests/format/test_blender.sh: glass, metal and plastic under lamps, exported as
# glTF, and the picture that Cycles makes of it without caustics.
#
#   blender --background --python blender_scene.py -- FOLDER
import math
import sys

import bpy

folder = sys.argv[sys.argv.index("--") + 1]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene


def material(name, color, **inputs):
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    node = m.node_tree.nodes["Principled BSDF"]
    node.inputs["Base Color"].default_value = (*color, 1)
    for key, value in inputs.items():
        node.inputs[key.replace("_", " ")].default_value = value
    return m


def finish(thing_material, smooth):
    thing = bpy.context.object
    thing.data.materials.append(thing_material)
    if smooth:
        bpy.ops.object.shade_smooth()


def ball(place, radius, thing_material):
    bpy.ops.mesh.primitive_uv_sphere_add(
        radius=radius, location=place, segments=64, ring_count=32
    )
    finish(thing_material, True)


def lamp(kind, energy, place, turn=(0, 0, 0)):
    data = bpy.data.lights.new(kind, kind)
    data.energy = energy
    if kind == "SUN":
        data.angle = 0
    else:
        data.shadow_soft_size = 0
    thing = bpy.data.objects.new(kind, data)
    thing.location = place
    thing.rotation_euler = turn
    scene.collection.objects.link(thing)


# Cycles' diffuse part is Burley's, glTF's Lambert's: at this roughness they are close.
bpy.ops.mesh.primitive_plane_add(size=12)
finish(material("floor", (0.6, 0.5, 0.4), Roughness=0.4, Specular=0), False)
bpy.ops.mesh.primitive_cube_add(size=1, location=(-1.6, 1.2, 0.5), rotation=(0, 0, 0.5))
finish(material("matt", (0.2, 0.4, 0.7), Roughness=0.4, Specular=0), False)
ball((0, 0.2, 0.6), 0.6, material("metal", (0.9, 0.7, 0.4), Metallic=1, Roughness=0))
ball((1.5, -0.2, 0.5), 0.5, material("glass", (1, 1, 1), Transmission=1, Roughness=0))
ball((-1.3, -0.6, 0.4), 0.4, material("plastic", (0.7, 0.1, 0.1), Roughness=0.4))
lamp("POINT", 300, (2, -2, 4))
lamp("SUN", 0.8, (0, 0, 5), (0.5, -0.3, 0))

view = bpy.data.objects.new("view", bpy.data.cameras.new("view"))
view.location = (0, -6.5, 3)
view.rotation_euler = (math.radians(68), 0, 0)
scene.collection.objects.link(view)
scene.camera = view

scene.world = bpy.data.worlds.new("black")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0
scene.render.engine = "CYCLES"
scene.cycles.samples = 256
scene.cycles.use_denoising = False
scene.cycles.caustics_reflective = False
scene.cycles.caustics_refractive = False
scene.cycles.sample_clamp_indirect = 0
scene.render.resolution_x, scene.render.resolution_y = 160, 120
scene.render.image_settings.file_format = "OPEN_EXR"
scene.render.image_settings.color_depth = "32"
scene.render.image_settings.exr_codec = "ZIP"
scene.render.filepath = folder + "/cycles.exr"
bpy.ops.export_scene.gltf(
    filepath=folder + "/scene.glb", export_lights=True, export_cameras=True
)
bpy.ops.render.render(write_still=True)
