"""Renders a scene with Blender's Cycles (path tracing, caustics on, nothing clamped) through the module bpy."""

import json
import math
import os
import sys

import budget


def main():
    options = budget.arguments(["path"])
    import bpy

    with open(os.path.join(options.scene, "scene.json")) as file:
        scene = json.load(file)
    build(bpy, scene)
    if options.calibrate:
        seconds = []
        for samples in (2, 12):
            before = budget.spent()
            render(bpy, samples, options)
            seconds.append(budget.spent() - before)
        costs = budget.linear(2, seconds[0], 12, seconds[1])
        with open(options.costs, "w") as file:
            json.dump(costs, file)
        return
    with open(options.costs) as file:
        costs = json.load(file)
    samples = budget.affordable(costs, options.budget - budget.spent())
    render(bpy, samples, options)
    budget.report(work=f"{samples} samples a pixel")


def render(bpy, samples, options):
    cycles = bpy.context.scene.cycles
    cycles.samples = samples
    cycles.seed = options.seed
    output = bpy.context.scene.render
    output.filepath = os.path.abspath(options.out)
    # Blender talks on standard output, where the driver's own line must stand alone.
    sys.stdout.flush()
    kept = os.dup(1)
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    bpy.ops.render.render(write_still=True)
    sys.stdout.flush()
    os.dup2(kept, 1)
    os.close(kept)


def build(bpy, description):
    """The scene as Blender objects, and Cycles set as the other engines are."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = 0.0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.max_bounces = 32
    for kind in ("diffuse", "glossy", "transmission", "transparent_max"):
        setattr(cycles, f"{kind}_bounces", 32)
    cycles.min_light_bounces = 8
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1.0
    cycles.use_guiding = False
    scene.render.threads_mode = "FIXED"
    scene.render.threads = 1
    camera = description["camera"]
    scene.render.resolution_x, scene.render.resolution_y = camera["width"], camera["height"]
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.color_depth = "32"
    scene.world = bpy.data.worlds.new("dark")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 0.0
    add_camera(bpy, scene, camera)
    materials = {name: surface(bpy, name, values) for name, values in description["materials"].items()}
    for mesh in description["meshes"]:
        data = bpy.data.meshes.new(mesh["name"])
        data.from_pydata(mesh["vertices"], [], mesh["triangles"])
        material = materials[mesh["material"]]
        if mesh["radiance"]:
            material = emitter(bpy, mesh["name"], mesh["radiance"])
        data.materials.append(material)
        scene.collection.objects.link(bpy.data.objects.new(mesh["name"], data))
    for sphere in description["spheres"]:
        # Seven subdivisions in Blender's counting, in which the icosahedron is the first: 81,920 triangles.
        bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=7, radius=sphere["radius"], location=sphere["center"])
        bpy.ops.object.shade_smooth()
        bpy.context.object.data.materials.append(materials[sphere["material"]])


def add_camera(bpy, scene, values):
    import mathutils

    origin, target, up = (mathutils.Vector(values[key]) for key in ("origin", "target", "up"))
    back = (origin - target).normalized()
    right = up.cross(back).normalized()
    turn = mathutils.Matrix((right, back.cross(right), back)).transposed().to_4x4()
    data = bpy.data.cameras.new("camera")
    data.sensor_fit = "AUTO"
    data.angle = math.radians(values["fov_degrees"])
    scene.camera = bpy.data.objects.new("camera", data)
    scene.camera.matrix_world = mathutils.Matrix.Translation(origin) @ turn
    scene.collection.objects.link(scene.camera)


def nodes_of(bpy, name):
    """A new material's empty node tree and its output."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    return material, tree, tree.nodes.new("ShaderNodeOutputMaterial")


def surface(bpy, name, values):
    material, tree, output = nodes_of(bpy, name)
    if values["kind"] == "diffuse":
        node = tree.nodes.new("ShaderNodeBsdfDiffuse")
        node.inputs["Color"].default_value = (*values["reflectance"], 1)
        node.inputs["Roughness"].default_value = 0
    elif values["kind"] == "glass":
        node = tree.nodes.new("ShaderNodeBsdfGlass")
        node.inputs["Color"].default_value = (1, 1, 1, 1)
        node.inputs["IOR"].default_value = values["ior"]
        node.inputs["Roughness"].default_value = 0
    else:
        node = tree.nodes.new("ShaderNodeBsdfAnisotropic")
        node.inputs["Color"].default_value = (*values["reflectance"], 1)
        node.inputs["Roughness"].default_value = 0
    tree.links.new(node.outputs["BSDF"], output.inputs["Surface"])
    return material


def emitter(bpy, name, radiance):
    """Emission from the front alone: the back is black."""
    material, tree, output = nodes_of(bpy, f"{name}-emitter")
    strongest = max(radiance)
    emission = tree.nodes.new("ShaderNodeEmission")
    emission.inputs["Color"].default_value = (*(value / strongest for value in radiance), 1)
    emission.inputs["Strength"].default_value = strongest
    black = tree.nodes.new("ShaderNodeBsdfDiffuse")
    black.inputs["Color"].default_value = (0, 0, 0, 1)
    side = tree.nodes.new("ShaderNodeNewGeometry")
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(side.outputs["Backfacing"], mix.inputs[0])
    tree.links.new(emission.outputs["Emission"], mix.inputs[1])
    tree.links.new(black.outputs["BSDF"], mix.inputs[2])
    tree.links.new(mix.outputs["Shader"], output.inputs["Surface"])
    # Its two triangles and no others are what direct light is sampled from, front sides alone.
    material.cycles.emission_sampling = "FRONT"
    return material


main()
