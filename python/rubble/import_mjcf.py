"""Meshes of an MJCF model, for rubble.import_pack. Needs the package mujoco."""
import math
import struct
import zlib

if __package__:
    from .import_asset import Asset, Look, PackError
else:  # the file beside this one, where import_pack.py is run by its path
    from import_asset import Asset, Look, PackError  # type: ignore[import-not-found,no-redef,unused-ignore]

WATER = 1000.0  # density that MJCF gives to what names none; unit: kg/m3
RUBBER = (1.0, 0.005, 0.0001)  # friction, likewise


def png(pixels, width, height, channels):
    """Of bytes, row by row from the top, of one to four channels."""
    kind = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    rows = b"".join(b"\0" + pixels[row * width * channels:(row + 1) * width * channels] for row in range(height))

    def chunk(name, content):
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, kind, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))


class MjcfReader:
    """Each mesh of the compiled model, in the frame of its file; looks and masses are those of the first geom with it."""

    def __init__(self, path, notes):
        try:
            import mujoco  # type: ignore[import-not-found,unused-ignore]
            import numpy
        except ImportError as error:
            raise PackError(f"{path}: needs the package mujoco: pip install mujoco ({error})") from error
        self.mujoco, self.numpy, self.notes = mujoco, numpy, notes
        try:
            self.spec = mujoco.MjSpec.from_file(str(path))
            self.model = self.spec.compile()
        except (ValueError, mujoco.FatalError) as error:
            raise PackError(f"{path}: cannot be read as MJCF: {' '.join(str(error).split())}") from error

    def read(self):
        model, kind = self.model, self.mujoco.mjtGeom
        of_mesh = {}
        for geom in range(model.ngeom):
            if model.geom_type[geom] == kind.mjGEOM_MESH:
                of_mesh.setdefault(int(model.geom_dataid[geom]), geom)
            else:
                self.notes.add(f"a {kind(model.geom_type[geom]).name[len('mjGEOM_'):].lower()}: only meshes are taken")
        for mesh in range(model.nmesh):
            yield self.asset(mesh, of_mesh.get(mesh))

    def asset(self, mesh, geom):
        model = self.model
        rotation = self.numpy.zeros(9)
        self.mujoco.mju_quat2Mat(rotation, model.mesh_quat[mesh])
        first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
        vertices = model.mesh_vert[first:first + count].astype(float) @ rotation.reshape(3, 3).T + model.mesh_pos[mesh]
        begin, end = model.mesh_faceadr[mesh], model.mesh_faceadr[mesh] + model.mesh_facenum[mesh]
        faces = [list(map(int, face)) for face in model.mesh_face[begin:end]]
        name = model.mesh(mesh).name or f"mesh_{mesh}"
        look = self.look(geom, name) if geom is not None else Look()
        corners = []
        if look.picture and model.mesh_texcoordnum[mesh] > 0:
            at = model.mesh_texcoordadr[mesh]  # v runs down
            corners = [(float(model.mesh_texcoord[at + i][0]), 1 - float(model.mesh_texcoord[at + i][1]))
                       for face in model.mesh_facetexcoord[begin:end] for i in face]
        elif look.picture:
            self.notes.add(f"{name}: its picture, because it has no texture coordinates")
            look.picture = None
        asset = Asset(name, [tuple(map(float, v)) for v in vertices], faces, [look], [0] * len(faces), corners)
        self.weigh(name, asset)
        return asset

    def look(self, geom, name):
        model = self.model
        material = model.geom_matid[geom]
        if material < 0:
            return Look(tuple(float(c) for c in model.geom_rgba[geom][:3]))
        look = Look(tuple(float(c) for c in model.mat_rgba[material][:3]))
        metal, roughness = float(model.mat_metallic[material]), float(model.mat_roughness[material])
        look.metal, look.roughness = metal if metal >= 0 else None, roughness if roughness >= 0 else None
        if model.mat_emission[material] > 0:
            self.notes.add(f"{name}: emission")
        roles = self.mujoco.mjtTextureRole
        texture = next((t for t in (model.mat_texid[material][r] for r in (roles.mjTEXROLE_RGB, roles.mjTEXROLE_RGBA)) if t >= 0), -1)
        if texture < 0:
            return look
        if model.tex_type[texture] != self.mujoco.mjtTexture.mjTEXTURE_2D:
            self.notes.add(f"{name}: a picture of six sides")
            return look
        width, height, channels = (int(of[texture]) for of in (model.tex_width, model.tex_height, model.tex_nchannel))
        at = int(model.tex_adr[texture])
        look.picture = (".png", png(model.tex_data[at:at + width * height * channels].tobytes(), width, height, channels))
        repeat = tuple(float(x) for x in model.mat_texrepeat[material])
        look.placed = repeat + (0.0, 0.0) if repeat != (1.0, 1.0) else None
        return look

    def weigh(self, name, asset):
        """By what the file says, not by the usual density, that of water."""
        geoms = [g for g in self.spec.geoms if g.type == self.mujoco.mjtGeom.mjGEOM_MESH and g.meshname == name]
        for geom in geoms[:1]:
            if tuple(float(x) for x in geom.friction) != RUBBER:
                self.notes.add(f"{name}: friction: that of --material is taken")
            body = geom.parent
            others = [g for g in body.geoms if g.type != self.mujoco.mjtGeom.mjGEOM_MESH or g.meshname != name]
            if body.explicitinertial and others:
                self.notes.add(f"{name}: the mass of its body, because it is of several geoms")
            elif body.explicitinertial:
                asset.mass, asset.shares = float(body.mass), name
            elif not math.isnan(geom.mass):
                asset.mass, asset.shares = float(geom.mass), name
            elif geom.density != WATER:
                asset.density = float(geom.density)
