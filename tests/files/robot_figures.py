"""What pinocchio and trimesh say of a robot in a URDF file."""
import math
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy
import pinocchio
import trimesh

from mesh_figures import load_mesh

MOVABLE = ("revolute", "continuous", "prismatic", "planar", "floating")


def find_mesh(name, urdf):
    """As a ROS workspace would: below a folder that holds the URDF file. None: it is not there."""
    name = name.split("//", 1)[1] if name.startswith("package://") else name.replace("file://", "").lstrip("/")
    below = name.split("/", 1)[1] if "/" in name else name
    for folder in Path(urdf).resolve().parents:
        for path in (folder / name, folder / below):
            if path.is_file():
                return path
    return None


def outline(urdf):
    """The parsed file and its meshes, or None: no robot, not complete, or not expanded from xacro."""
    try:
        root = ElementTree.parse(urdf).getroot()
    except (ElementTree.ParseError, UnicodeDecodeError, ValueError):
        return None
    text = Path(urdf).read_bytes()
    if root.tag != "robot" or b"<xacro:" in text:
        return None
    if not any(j.get("type") in MOVABLE for j in root.findall("joint")):
        return None
    meshes = set()
    for mesh in root.iter("mesh"):
        found = find_mesh(mesh.get("filename", ""), urdf)
        if found is None:
            return None
        meshes.add(found)
    return root, meshes


def numbers(text, count, default):
    values = [float(x) for x in (text or "").split()]
    return values if len(values) == count else default


def place_of(element):
    origin = element.find("origin")
    if origin is None:
        return numpy.eye(4)
    place = trimesh.transformations.euler_matrix(*numbers(origin.get("rpy"), 3, [0, 0, 0]), axes="sxyz")
    place[:3, 3] = numbers(origin.get("xyz"), 3, [0, 0, 0])
    return place


def shape_bounds(geometry, urdf, place):
    """Of the shape in the frame of `place`; None: no shape, as <geometry/>."""
    shape = geometry[0] if geometry is not None and len(geometry) else None
    if shape is None:
        return None
    if shape.tag == "mesh":
        points = load_mesh(find_mesh(shape.get("filename"), urdf)).bounding_points
        points = points * numbers(shape.get("scale"), 3, [1, 1, 1])
    elif shape.tag == "box":
        half = numpy.array(numbers(shape.get("size"), 3, [0, 0, 0])) / 2
        points = numpy.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * half
    elif shape.tag == "sphere":
        radius = float(shape.get("radius"))
        return numpy.array([place[:3, 3] - radius, place[:3, 3] + radius])
    else:  # cylinder: the extent of its two rims
        radius, half = float(shape.get("radius")), float(shape.get("length")) / 2
        axis = place[:3, 2]
        extent = numpy.abs(axis) * half + radius * numpy.sqrt(numpy.maximum(0, 1 - axis * axis))
        return numpy.array([place[:3, 3] - extent, place[:3, 3] + extent])
    moved = points @ place[:3, :3].T + place[:3, 3]
    return numpy.array([moved.min(axis=0), moved.max(axis=0)])


def bounds(root, kind, urdf, link_places):
    boxes = []
    for link in root.findall("link"):
        for element in link.findall(kind):
            box = shape_bounds(element.find("geometry"), urdf, link_places[link.get("name")] @ place_of(element))
            if box is not None:
                boxes.append(box)
    if not boxes:
        return None
    return [rounded(min(b[0][i] for b in boxes) for i in range(3)),
            rounded(max(b[1][i] for b in boxes) for i in range(3))]


def rounded(values):
    return [float(f"{v:.6g}") for v in values]


def is_possible(inertia):
    """Whether a body can have it: its principal moments are above 0, none above the sum of the others."""
    low, middle, high = numpy.linalg.eigvalsh(inertia)
    return low > 0 and high <= (low + middle) * (1 + 1e-9)


def robot_figures(urdf):
    """At the zeros of all joints, in the frame of the root link. Raises where pinocchio does."""
    root, _ = outline(urdf)
    model = pinocchio.buildModelFromUrdf(str(urdf), pinocchio.JointModelFreeFlyer())
    data = model.createData()
    pose = pinocchio.neutral(model)
    pinocchio.ccrba(model, data, pose, numpy.zeros(model.nv))
    pinocchio.framesForwardKinematics(model, data, pose)
    links = {f.name: data.oMf[i].homogeneous for i, f in enumerate(model.frames)
             if f.type == pinocchio.FrameType.BODY}
    base = numpy.linalg.inv(links[next(f.name for f in model.frames if f.type == pinocchio.FrameType.BODY)])
    links = {name: base @ place for name, place in links.items()}
    mass = sum(inertia.mass for inertia in model.inertias)
    figures = {"joints": model.njoints - 2, "mass_kg": float(f"{mass:.9g}")}
    if mass > 0:
        inertia = data.Ig.inertia
        figures["centre_of_mass_m"] = rounded(data.com[0])
        figures["inertia_kg_m2"] = rounded(inertia[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)))
    bodies = list(model.inertias)[1:]  # the root first
    figures["massless"] = sum(not body.mass > 0 for body in bodies[1:])
    figures["impossible"] = sum(body.mass > 0 and not is_possible(numpy.array(body.inertia)) for body in bodies)
    for kind in ("collision", "visual"):
        box = bounds(root, kind, urdf, links)
        if box:
            figures[kind + "_bounds_m"] = box
    if not all(math.isfinite(x) for x in [mass, *figures.get("centre_of_mass_m", []), *figures.get("inertia_kg_m2", [])]):
        raise ValueError("figures that are not finite")
    return figures
