"""Draws one view that judge_scenes wrote, by Cycles. Run by Blender:

blender --background --factory-startup --python cycles_render.py -- VIEW.json OUT.pfm SAMPLES
"""
import json
import math
import os
import sys

import bpy
import mathutils
import numpy

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from judge_measures import write_pfm  # noqa: E402

RING = 32  # point lights that stand for the diodes of a ring


def set_surface(material, colour, mirror):
    """Lambert's law alone, or a mirror without Fresnel's law, whose alpha is Blender's roughness squared."""
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader = tree.nodes.new("ShaderNodeBsdfGlossy" if mirror else "ShaderNodeBsdfDiffuse")
    shader.inputs["Roughness"].default_value = 0
    shader.inputs["Color"].default_value = (*colour, 1)
    if mirror:
        shader.distribution = "GGX"
        shader.inputs["Roughness"].default_value = math.sqrt(mirror["roughness"])
        shader.inputs["Color"].default_value = (mirror["grey"],) * 3 + (1,)
    tree.links.new(shader.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])


def make_matt(material, shader, colour):
    """Lambert's law with what the importer made of image, colours of vertices and factor."""
    tree = material.node_tree
    matt = tree.nodes.new("ShaderNodeBsdfDiffuse")
    matt.inputs["Roughness"].default_value = 0
    tree.links.new(colour, matt.inputs["Color"])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(matt.outputs[0], output.inputs["Surface"])
    tree.nodes.remove(shader)


def load_pieces(path, mirror):
    """With the base colours of the file, as flat triangles."""
    bpy.ops.import_scene.gltf(filepath=path, import_shading="FLAT")
    for material in bpy.data.materials:
        shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
        colour = shader.inputs["Base Color"]
        if colour.is_linked and not mirror:
            make_matt(material, shader, colour.links[0].from_socket)
        else:
            set_surface(material, tuple(colour.default_value)[:3], mirror)
    for mesh in bpy.data.meshes:
        mesh.polygons.foreach_set("use_smooth", [False] * len(mesh.polygons))


def add_object(name, data):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def add_ground(ground, mirror):
    """Of nine squares: a small one about the pieces, where triangles of kilometres would be imprecise."""
    near = 40
    xs, ys = ((low, -near, near, high) for low, high in zip(ground["low"], ground["high"]))
    mesh = bpy.data.meshes.new("ground")
    corners = [(x, y, 0) for y in ys for x in xs]
    faces = [(j * 4 + i, j * 4 + i + 1, j * 4 + i + 5, j * 4 + i + 4) for j in range(3) for i in range(3)]
    mesh.from_pydata(corners, [], faces)
    material = bpy.data.materials.new("ground")
    set_surface(material, ground["colour"], mirror)
    mesh.materials.append(material)
    add_object("ground", mesh)


def turned(x, y, z, position=(0, 0, 0)):
    """From a frame with these axes to the world."""
    columns = zip(x, y, z, position)
    return mathutils.Matrix([list(row) for row in columns] + [[0, 0, 0, 1]])


def negative(v):
    return [-part for part in v]


def add_camera(camera):
    """Blender looks along -Z with Y up, and counts its image from corner to corner."""
    data = bpy.data.cameras.new("camera")
    width, height = camera["width"], camera["height"]
    if camera["fx"] != camera["fy"]:
        raise ValueError("a camera whose pixels are not square is not supported")
    data.sensor_fit, data.sensor_width = "HORIZONTAL", 36
    data.lens = camera["fx"] * 36 / width
    data.shift_x = (width / 2 - (camera["cx"] + 0.5)) / width
    data.shift_y = ((camera["cy"] + 0.5) - height / 2) / width
    data.clip_start, data.clip_end = 0.01, 1e4
    thing = add_object("camera", data)
    thing.matrix_world = turned(negative(camera["left"]), camera["up"], negative(camera["forward"]),
                                camera["position"])
    scene = bpy.context.scene
    scene.camera = thing
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100


def make_sky(path):
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    tree = world.node_tree
    image = tree.nodes.new("ShaderNodeTexEnvironment")
    image.image = bpy.data.images.load(path)
    image.image.colorspace_settings.name = "Linear"
    image.projection, image.interpolation = "EQUIRECTANGULAR", "Linear"
    tree.links.new(image.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    tree.nodes["Background"].inputs["Strength"].default_value = 1
    world.cycles.sampling_method, world.cycles.sample_map_resolution = "MANUAL", 1024
    world.cycles.max_bounces = 1024


def set_colour(light, colour):
    """Colour is at most 1 in Blender's panels; the strength carries the rest."""
    light.energy = max(colour)
    light.color = [part / light.energy for part in colour]


def add_sun(sun):
    light = bpy.data.lights.new("sun", "SUN")
    set_colour(light, sun["illuminance"])
    light.angle = 2 * sun["angular_radius"]
    thing = add_object("sun", light)
    thing.matrix_world = mathutils.Vector(sun["to_sun"]).to_track_quat("Z", "Y").to_matrix().to_4x4()


def add_beam(light, lamp):
    """Strength by the angle from the axis, 2^-((1 - cos) cone)^2, as PlacedLamp::illuminance()."""
    light.use_nodes = True
    tree = light.node_tree

    def math_node(operation, *values):
        node = tree.nodes.new("ShaderNodeMath")
        node.operation = operation
        for socket, value in zip(node.inputs, values):
            if isinstance(value, (int, float)):
                socket.default_value = value
            else:
                tree.links.new(value, socket)
        return node.outputs[0]

    along = tree.nodes.new("ShaderNodeVectorMath")
    along.operation = "DOT_PRODUCT"
    tree.links.new(tree.nodes.new("ShaderNodeNewGeometry").outputs["Incoming"], along.inputs[0])
    along.inputs[1].default_value = lamp["axis"]
    x = math_node("MULTIPLY", math_node("SUBTRACT", 1, along.outputs["Value"]), lamp["cone"])
    share = math_node("POWER", 2, math_node("MULTIPLY", math_node("MULTIPLY", x, x), -1))
    tree.links.new(share, tree.nodes["Emission"].inputs["Strength"])


def add_lamp(lamp):
    """A ring of points that share one light."""
    if lamp["disc"]:
        raise ValueError("a lamp with diodes all over a disc is not supported: set lamp.shape=ring or point")
    count = RING if lamp["radius"] > 0 else 1
    light = bpy.data.lights.new("lamp", "POINT")
    # A point of P watts has the radiant intensity P / (4 pi).
    set_colour(light, [4 * math.pi * part / count for part in lamp["intensity"]])
    light.shadow_soft_size = 0
    add_beam(light, lamp)
    side, up = mathutils.Vector(lamp["side"]), mathutils.Vector(lamp["up"])
    for i in range(count):
        turn = 2 * math.pi * (i + 0.5) / count
        thing = add_object("lamp", light)
        thing.location = mathutils.Vector(lamp["position"]) + lamp["radius"] * (
            side * math.cos(turn) + up * math.sin(turn))


def set_quality(samples, bounces):
    """Nothing that trades light for speed: no clamping, no filter over noise, no threshold, box pixels."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.use_persistent_data = False
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", samples, 1
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.light_sampling_threshold = cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = min(bounces, 1024)
    cycles.blur_glossy = 0
    cycles.pixel_filter_type = "BOX"
    cycles.film_exposure = 1
    scene.render.film_transparent = False
    scene.render.use_motion_blur = scene.render.use_compositing = scene.render.use_sequencer = False
    scene.render.dither_intensity = 0
    scene.view_settings.view_transform, scene.view_settings.look = "Raw", "None"
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"


def render(out):
    """Cycles' linear values, by way of an OpenEXR file."""
    path = out + ".exr"
    bpy.context.scene.render.filepath = path
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Linear"
    values = numpy.empty(len(image.pixels), "<f4")
    image.pixels.foreach_get(values)
    width, height = image.size
    write_pfm(out, values.reshape(height, width, -1)[::-1, :, :3])
    os.remove(path)


def main():
    view_path, out, samples = sys.argv[sys.argv.index("--") + 1:]
    with open(view_path) as file:
        view = json.load(file)
    folder = os.path.dirname(os.path.abspath(view_path))
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    for material in list(bpy.data.materials):
        bpy.data.materials.remove(material)
    load_pieces(os.path.join(folder, view["mesh"]), view["mirror"])
    add_ground(view["ground"], view["mirror"])
    add_camera(view["camera"])
    make_sky(os.path.join(folder, view["sky"]))
    if view["sun"]:
        add_sun(view["sun"])
    if view["lamp"]:
        add_lamp(view["lamp"])
    set_quality(int(samples), view["bounces"])
    render(os.path.abspath(out))


main()
