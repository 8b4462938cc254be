#!/usr/bin/env python3
"""Reads an exported scene without simulating it: readers.py READER EXPORT_FOLDER

Prints one line of JSON: what was compared, and every difference. Readers: pinocchio (URDF), trimesh (OBJ, and the meshes of all
scenes), gltf (pile.glb, by trimesh), bullet_sdf (the SDF world by PyBullet). Each wants the Python package of its name.
"""
import json
import math
import re
import sys
import time
from pathlib import Path

from results import Result


FIRST_FINE = 10_000_000  # the smallest number in `instance` of what is no piece
CONVEX = 1e-3  # of the volume of a convex part: faces of several corners, which are nearly flat, are cut into triangles


def read_scene(folder):
    return json.loads((folder / "scene.json").read_text())


def turn_between(a, b):
    """Degrees between two quaternions, in any order of their numbers that both share."""
    return math.degrees(2 * math.acos(min(1.0, abs(sum(x * y for x, y in zip(a, b))))))


def read_pinocchio(folder, errors):
    """Every model and robot on a free base: masses and places of its links, convex parts."""
    import numpy
    import pinocchio
    scene, bodies, shapes = read_scene(folder / "urdf"), 0, 0
    files = {model["file"]: model for model in scene["models"]}
    for file, described in sorted(files.items()):
        path = str(folder / "urdf" / file)
        model = pinocchio.buildModelFromUrdf(path, pinocchio.JointModelFreeFlyer())
        model.gravity.linear = numpy.array([0, 0, -scene["gravity_m_s2"]])
        data = model.createData()
        parts = pinocchio.buildGeomFromUrdf(model, path, pinocchio.GeometryType.COLLISION, package_dirs=[str(Path(path).parent)])
        shapes += len(parts.geometryObjects)
        if file == "fixed.urdf":
            continue
        w, x, y, z = described["links"][0]["quaternion_wxyz"]
        place = pinocchio.neutral(model)
        place[:7] = [*described["links"][0]["position_m"], x, y, z, w]
        for joint in described.get("joints", []):
            if not model.existJointName(joint["name"]):
                continue  # a ball, which is three hinges at 0 with two links of 1 g
            at = model.joints[model.getJointId(joint["name"])]
            if at.nq == 1:
                place[at.idx_q] = joint["position"]
            elif at.nq == 2:  # turns without end are stored by their cosine and sine
                place[at.idx_q:at.idx_q + 2] = math.cos(joint["position"]), math.sin(joint["position"])
        pinocchio.framesForwardKinematics(model, data, place)
        mass = sum(link["mass_kg"] for link in described["links"])
        balls = sum(not model.existJointName(joint["name"]) for joint in described.get("joints", []))
        if abs(pinocchio.computeTotalMass(model) - mass - 0.002 * balls) > 1e-9 * mass:
            errors.append(f"{file}: {pinocchio.computeTotalMass(model)} kg, not {mass}")
        for link in described["links"] if described["robot"] else described["links"][:1]:
            bodies += 1  # of debris with joints, the others have their frames at their joints
            found = data.oMf[model.getFrameId(link["name"])]
            turn = pinocchio.Quaternion(found.rotation)
            if math.dist(found.translation, link["position_m"]) > 1e-6 or \
                    turn_between((turn.w, turn.x, turn.y, turn.z), link["quaternion_wxyz"]) > 1e-4:
                errors.append(f"{file}: {link['name']} is at {list(found.translation)}, not at {link['position_m']}")
        if not (numpy.linalg.eigvalsh(pinocchio.crba(model, data, place)) > 0).all():
            errors.append(f"{file}: the mass matrix is not positive")
    return {"engine": "pinocchio " + pinocchio.__version__, "compared": f"{len(files)} files, {bodies} links, {shapes} convex parts"}


def open_edges(mesh):
    import numpy
    edges = numpy.sort(mesh.edges, axis=1)
    return int((numpy.unique(edges, axis=0, return_counts=True)[1] != 2).sum())


def read_trimesh(folder, errors):
    """pile.obj piece by piece and convex parts are closed as they are read, looks with pictures where corners are merged."""
    import trimesh
    whole = trimesh.load_scene(str(folder / "pile.obj"), process=False, skip_materials=True, split_objects=True, group_material=False)
    # Of the pieces; trees and fronts of a street are open surfaces.
    links = [link for model in read_scene(folder / "sdf")["models"] if not model["robot"] for link in model["links"]
             if 0 <= link["instance"] < FIRST_FINE]
    names, kinds = [link["name"] for link in links], {link["label"] for link in links}
    pieces = {name: mesh for name, mesh in whole.geometry.items() if name in set(names)}
    missing = set(names) - set(pieces)
    if missing:
        errors.append(f"pile.obj lacks {len(missing)} of {len(names)} pieces, such as {min(missing)}")
    looks = parts = 0
    seamed = set()
    for path in sorted(folder.glob("*/meshes/*.obj")) + sorted(folder.glob("urdf/robots/*_meshes/*.*")):
        convex = re.search(r"_part_\d+$", path.stem)
        if not convex and path.parts[-3] == "mjcf":
            continue  # MuJoCo has one look for a mesh: a file for each surface of a piece
        if not convex and path.parts[-2] == "meshes" and path.stem not in kinds:
            continue
        mesh = pieces[str(path.relative_to(folder))] = trimesh.load_mesh(str(path), process=False, skip_materials=True)
        looks, parts = looks + (not convex), parts + bool(convex)
        if not convex:
            seamed.add(str(path.relative_to(folder)))
        if convex and mesh.convex_hull.volume - mesh.volume > CONVEX * mesh.volume:
            errors.append(f"{path.relative_to(folder)} is not convex: {mesh.volume:.6g} m3, its hull {mesh.convex_hull.volume:.6g}")
    for name, mesh in sorted(pieces.items()):
        if name in seamed:  # normals and places in a picture differ at a seam: trimesh splits corners that are one in the file
            mesh.merge_vertices(merge_tex=True, merge_norm=True)
        if not mesh.is_watertight or mesh.volume <= 0:
            errors.append(f"{name}: {open_edges(mesh)} open edges, volume {mesh.volume:.3g} m3")
    return {"engine": "trimesh " + trimesh.__version__, "compared": f"{len(names)} pieces of pile.obj, {looks} looks, {parts} convex parts"}


def read_gltf(folder, errors):
    """pile.glb: every mesh is used, painted surfaces have places in pictures, pictures open, pieces lie where they lie."""
    import numpy
    import struct
    import trimesh
    content = (folder / "pile.glb").read_bytes()
    length = struct.unpack_from("<I", content, 12)[0]
    document = json.loads(content[20:20 + length])
    used = {node["mesh"] for node in document["nodes"]}
    if used != set(range(len(document["meshes"]))):
        errors.append(f"{len(document['meshes']) - len(used)} of {len(document['meshes'])} meshes are not used")
    pictured = 0
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            material = document["materials"][primitive["material"]]
            if "baseColorTexture" in material["pbrMetallicRoughness"]:
                pictured += 1
                if "TEXCOORD_0" not in primitive["attributes"]:
                    errors.append(f"{mesh['name']}: pictures without places in them")
    if not pictured:
        errors.append("no surface has a picture")
    scene = trimesh.load_scene(str(folder / "pile.glb"), process=False)
    pictures = {id(g.visual.material.baseColorTexture): g.visual.material.baseColorTexture.size for g in scene.geometry.values()
                if getattr(g.visual, "uv", None) is not None and g.visual.material.baseColorTexture is not None}
    if not pictures or min(min(size) for size in pictures.values()) < 2:
        errors.append(f"pictures: {list(pictures.values())}")
    links = [link for model in read_scene(folder / "sdf")["models"] if not model["robot"] for link in model["links"]]
    from_y_up = numpy.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])
    for link in links:
        if link["name"] not in scene.graph.nodes:
            errors.append(f"no node {link['name']}")
            continue
        found = from_y_up @ scene.graph.get(link["name"])[0]
        if math.dist(found[:3, 3], link["position_m"]) > 1e-5:
            errors.append(f"{link['name']} is at {list(found[:3, 3])}, not at {link['position_m']}")
    return {"engine": "trimesh " + trimesh.__version__ + ", glTF",
            "compared": f"{len(links)} pieces, {len(used)} meshes, {pictured} surfaces with {len(document.get('images', []))} pictures"}


def read_bullet_sdf(folder, errors):
    """The world of SDF in PyBullet: masses, places and turns of bodies of one link."""
    import pybullet
    from importlib.metadata import version
    pybullet.connect(pybullet.DIRECT)
    if 'type="ball"' in (folder / "sdf/pile.sdf").read_text():
        return {"engine": "pybullet " + version("pybullet") + ", SDF", "compared": "nothing, since it knows no balls"}
    loaded = {pybullet.getBodyInfo(body)[1].decode(): body for body in pybullet.loadSDF(str(folder / "sdf/pile.sdf"))}
    compared = 0
    for model in read_scene(folder / "sdf")["models"]:
        if model["robot"] or len(model["links"]) > 1:
            continue
        link = model["links"][0]
        if model["name"] not in loaded:
            errors.append(f"no model {model['name']}")
            continue
        body = loaded[model["name"]]
        compared += 1
        at, (x, y, z, w) = pybullet.getBasePositionAndOrientation(body)
        inertial = pybullet.getDynamicsInfo(body, -1)
        # Bullet's frame is that of the centre of mass: back to that of the link.
        back = pybullet.invertTransform(inertial[3], inertial[4])
        at, (x, y, z, w) = pybullet.multiplyTransforms(at, (x, y, z, w), *back)
        if math.dist(at, link["position_m"]) > 1e-4 or turn_between((w, x, y, z), link["quaternion_wxyz"]) > 0.1:
            errors.append(f"{model['name']} is at {at}, turned by {turn_between((w, x, y, z), link['quaternion_wxyz']):.1f} degrees")
        if not model["fixed"] and abs(inertial[0] - link["mass_kg"]) > 1e-5 * link["mass_kg"]:
            errors.append(f"{model['name']}: {inertial[0]} kg, not {link['mass_kg']}")
    return {"engine": "pybullet " + version("pybullet") + ", SDF", "compared": f"{compared} models"}


if __name__ == "__main__":
    reader, place, began, wrong, result = sys.argv[1], Path(sys.argv[2]), time.time(), [], Result()
    said = globals()["read_" + reader](place, wrong)
    result.write({**said, "errors": wrong, "loaded_s": round(time.time() - began, 1)})
