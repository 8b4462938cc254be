#!/usr/bin/env python3
"""Writes the meshes of a USD or MJCF file as a pack of assets: python -m rubble.import_pack scene.usd -o my_pack

USD needs the package usd-core, MJCF mujoco; both come by pip. Each mesh becomes an OBJ file and an asset with its name; the
pack is checked by `rubble assets check my_pack`. What is left out is printed. Exit code 1: a file or a mesh that cannot be
taken, named.
"""
import argparse
import math
import sys
from pathlib import Path

USD = (".usd", ".usda", ".usdc", ".usdz")
MOST_VERTICES = 2_000_000
FARTHEST = 1e5  # of a corner from the origin; unit: m


class PackError(Exception):
    """What is wrong, with the file and the mesh."""


class Asset:
    def __init__(self, name, vertices, faces, colour=None, mass=None):
        self.name, self.vertices, self.faces, self.colour, self.mass = name, vertices, faces, colour, mass


def word(name):
    """A name of an asset: letters, digits and underscores."""
    text = "".join(letter.lower() if letter.isascii() and letter.isalnum() else "_" for letter in name).strip("_")
    return text if text and not text[0].isdigit() else "mesh_" + text


def volume(vertices, faces):
    """Of a closed mesh, by the tetrahedra of its triangles and the origin."""
    total = 0.0
    for face in faces:
        for i in range(1, len(face) - 1):
            (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (vertices[face[k]] for k in (0, i, i + 1))
            total += (ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx)) / 6
    return total


def read_usd(path, notes):
    """Each UsdGeom.Mesh, by its transforms below the root's, in metres and Z up."""
    try:
        from pxr import Gf, Tf, Usd, UsdGeom, UsdPhysics  # type: ignore[import-not-found,unused-ignore]
    except ImportError as error:
        raise PackError(f"{path}: needs the package usd-core: pip install usd-core ({error})") from error
    try:
        stage = Usd.Stage.Open(str(path))
    except Tf.ErrorException as error:
        raise PackError(f"{path}: cannot be read as USD: {str(error).strip().splitlines()[-1]}") from error
    unit = UsdGeom.GetStageMetersPerUnit(stage)
    if not 0 < unit < math.inf:
        raise PackError(f"{path}: metersPerUnit is {unit:g}: expected a length above 0")
    turn = Gf.Matrix4d(1)
    if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y:
        turn.SetRotate(Gf.Rotation(Gf.Vec3d(1, 0, 0), 90))
    cache, others = UsdGeom.XformCache(), {}
    for prim in stage.Traverse(Usd.TraverseInstanceProxies()):
        if prim.IsA(UsdGeom.Gprim) and not prim.IsA(UsdGeom.Mesh):
            others[prim.GetTypeName()] = others.get(prim.GetTypeName(), 0) + 1
        if not prim.IsA(UsdGeom.Mesh):
            continue
        mesh, where = UsdGeom.Mesh(prim), f"{path}: {prim.GetPath()}"
        points, counts, indices = mesh.GetPointsAttr().Get(), mesh.GetFaceVertexCountsAttr().Get(), mesh.GetFaceVertexIndicesAttr().Get()
        if not points or not counts or not indices:
            raise PackError(f"{where}: has no points or no faces")
        if len(points) > MOST_VERTICES:
            raise PackError(f"{where}: has {len(points)} points: expected {MOST_VERTICES} at most")
        if sum(counts) != len(indices) or min(counts) < 3 or min(indices) < 0 or max(indices) >= len(points):
            raise PackError(f"{where}: its faceVertexCounts and faceVertexIndices do not fit its {len(points)} points")
        if mesh.GetSubdivisionSchemeAttr().Get() not in (UsdGeom.Tokens.none, None):
            notes.append(f"{prim.GetPath()}: subdivision: its cage is taken")
        # Scales apply; where the mesh stands does not: an asset has its own origin.
        to_world = cache.GetLocalToWorldTransform(prim) * turn
        to_world.SetTranslateOnly(Gf.Vec3d(0))
        vertices = [tuple(unit * x for x in to_world.Transform(Gf.Vec3d(p))) for p in points]
        flipped = (mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded) != (to_world.GetDeterminant3() < 0)
        faces, at = [], 0
        for count in counts:
            face = list(indices[at:at + count])
            faces.append(face[::-1] if flipped else face)
            at += count
        colours = mesh.GetDisplayColorAttr().Get()
        mass = UsdPhysics.MassAPI(prim).GetMassAttr().Get() if prim.HasAPI(UsdPhysics.MassAPI) else None
        name = prim.GetName() if prim.GetName().lower() not in ("mesh", "geometry", "visual", "collision") else prim.GetParent().GetName()
        yield Asset(name, vertices, faces, tuple(colours[0]) if colours else None, mass or None)
    for kind, count in sorted(others.items()):
        notes.append(f"{count} {kind}: only meshes are taken")


def read_mjcf(path, notes):
    """Each mesh of the compiled model, in the frame of its file."""
    try:
        import mujoco  # type: ignore[import-not-found,unused-ignore]
        import numpy
    except ImportError as error:
        raise PackError(f"{path}: needs the package mujoco: pip install mujoco ({error})") from error
    try:
        model = mujoco.MjModel.from_xml_path(str(path))
    except (ValueError, mujoco.FatalError) as error:
        raise PackError(f"{path}: cannot be read as MJCF: {' '.join(str(error).split())}") from error
    for i in range(model.nmesh):
        first, count = model.mesh_vertadr[i], model.mesh_vertnum[i]
        rotation = numpy.zeros(9)
        mujoco.mju_quat2Mat(rotation, model.mesh_quat[i])
        vertices = model.mesh_vert[first:first + count].astype(float) @ rotation.reshape(3, 3).T + model.mesh_pos[i]
        face, faces = model.mesh_faceadr[i], model.mesh_facenum[i]
        users = [g for g in range(model.ngeom) if model.geom_type[g] == mujoco.mjtGeom.mjGEOM_MESH and model.geom_dataid[g] == i]
        colour = None
        if users:
            material = model.geom_matid[users[0]]
            colour = tuple(float(c) for c in (model.mat_rgba[material] if material >= 0 else model.geom_rgba[users[0]])[:3])
        yield Asset(model.mesh(i).name or f"mesh_{i}", [tuple(map(float, v)) for v in vertices],
                    [list(map(int, f)) for f in model.mesh_face[face:face + faces]], colour)
    shapes = sum(1 for g in range(model.ngeom) if model.geom_type[g] != mujoco.mjtGeom.mjGEOM_MESH)
    if shapes:
        notes.append(f"{shapes} geoms that are no meshes")


def checked(path, assets):
    """The assets, or an error that names the mesh whose corner, colour or mass is no number."""
    for asset in assets:
        for i, corner in enumerate(asset.vertices):
            if not all(abs(x) < FARTHEST for x in corner):
                raise PackError(f"{path}: {asset.name}: corner {i} is at {', '.join(f'{x:g}' for x in corner)} m: expected numbers within {FARTHEST:g}")
        if asset.colour and not all(0 <= c < math.inf for c in asset.colour):
            raise PackError(f"{path}: {asset.name}: its colour is {', '.join(f'{c:g}' for c in asset.colour)}: expected numbers from 0 to 1")
        if asset.mass is not None and not 0 < asset.mass < math.inf:
            raise PackError(f"{path}: {asset.name}: its mass is {asset.mass:g} kg: expected a number above 0")
        yield asset


def write_obj(path, asset):
    lines = [f"# From {asset.name} by rubble.import_pack"]
    if asset.colour:
        lines += [f"mtllib {path.stem}.mtl", "usemtl surface"]
        path.with_suffix(".mtl").write_text("newmtl surface\nKd %.6f %.6f %.6f\n" % tuple(min(c, 1) for c in asset.colour), encoding="ascii")
    lines += ["v %.9g %.9g %.9g" % v for v in asset.vertices]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in asset.faces]
    path.write_text("\n".join(lines) + "\n", encoding="ascii")


def write_pack(folder, assets, options, source):
    folder.mkdir(parents=True, exist_ok=True)
    if (folder / "pack.lua").exists() and not options.force:
        raise PackError(f"{folder}/pack.lua: is there already: --force replaces it")
    entries, names = [], set()
    for asset in assets:
        name = stem = word(asset.name)
        number = 2
        while name in names:
            name, number = f"{stem}_{number}", number + 1
        names.add(name)
        write_obj(folder / (name + ".obj"), asset)
        entry = f'    {{ name = "{name}", mesh = "{name}.obj", collision = "decompose", material = "{options.material}"'
        if asset.mass:
            space = abs(volume(asset.vertices, asset.faces))
            if space > 1e-9:
                entry += f", density = {asset.mass / space:.6g}"
        entries.append(entry + " },")
    if not entries:
        raise PackError(f"{source}: has no mesh")
    text = f"-- From {source.name} by rubble.import_pack.\nreturn pack {{\n  name = \"{word(options.name or folder.name)}\",\n  assets = {{\n"
    (folder / "pack.lua").write_text(text + "\n".join(entries) + "\n  },\n}\n", encoding="utf-8")
    return len(entries)


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="rubble.import_pack", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("file", type=Path, help="USD (.usd, .usda, .usdc, .usdz) or MJCF (.xml)")
    parser.add_argument("-o", "--out", type=Path, required=True, help="the folder of the pack")
    parser.add_argument("--name", help="of the pack; default: that of the folder")
    parser.add_argument("--material", default="reinforced_concrete", help="of all assets; default: reinforced_concrete")
    parser.add_argument("--force", action="store_true", help="replace a pack that is there")
    notes = []
    try:
        options = parser.parse_args(arguments)
    except SystemExit as end:  # 2, that of argparse, is another code in all other commands
        return 1 if end.code else 0
    try:
        if not options.file.is_file():
            raise PackError(f"{options.file}: no such file")
        if options.file.suffix.lower() in USD:
            assets = list(checked(options.file, read_usd(options.file, notes)))
        elif options.file.suffix.lower() == ".xml":
            assets = list(checked(options.file, read_mjcf(options.file, notes)))
        else:
            raise PackError(f"{options.file}: expected {', '.join(USD)} or .xml")
        count = write_pack(options.out, assets, options, options.file)
    except (PackError, OSError) as error:
        print(f"rubble.import_pack: {error}", file=sys.stderr)
        return 1
    except Exception as error:  # of a reader that trusts its file
        print(f"rubble.import_pack: {options.file}: cannot be taken: {type(error).__name__}: {' '.join(str(error).split())}", file=sys.stderr)
        return 1
    for note in notes:
        print(f"{options.file}: left out: {note}", file=sys.stderr)
    print(f"{options.out}: {count} assets; check them with `rubble assets check {options.out}`")
    return 0


if __name__ == "__main__":
    sys.exit(main())
