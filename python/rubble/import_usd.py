"""Meshes of a USD stage, for rubble.import_pack. Needs the package usd-core."""
import math
from pathlib import PurePosixPath

if __package__:
    from .import_asset import Asset, Look, PackError
else:  # the file beside this one, where import_pack.py is run by its path
    from import_asset import Asset, Look, PackError  # type: ignore[import-not-found,no-redef,unused-ignore]

PICTURES = (".png", ".jpg", ".jpeg")
MOST_POINTS = 2_000_000


class UsdReader:
    """Each UsdGeom.Mesh that is drawn, at its first moment, by its transforms below the root's, in metres and Z up."""

    def __init__(self, path, notes):
        try:
            from pxr import Gf, Tf, Usd, UsdGeom, UsdPhysics, UsdShade  # type: ignore[import-not-found,unused-ignore]
        except ImportError as error:
            raise PackError(f"{path}: needs the package usd-core: pip install usd-core ({error})") from error
        self.gf, self.geom, self.physics, self.shade = Gf, UsdGeom, UsdPhysics, UsdShade
        self.path, self.notes = path, notes
        try:
            self.stage = Usd.Stage.Open(str(path))
        except Tf.ErrorException as error:
            raise PackError(f"{path}: cannot be read as USD: {str(error).strip().splitlines()[-1]}") from error
        self.unit, self.kilogram = UsdGeom.GetStageMetersPerUnit(self.stage), UsdPhysics.GetStageKilogramsPerUnit(self.stage)
        for name, value in (("metersPerUnit", self.unit), ("kilogramsPerUnit", self.kilogram)):
            if not 0 < value < math.inf:
                raise PackError(f"{path}: {name} is {value:g}: expected a number above 0")
        self.turn = Gf.Matrix4d(1)
        if UsdGeom.GetStageUpAxis(self.stage) == UsdGeom.Tokens.y:
            self.turn.SetRotate(Gf.Rotation(Gf.Vec3d(1, 0, 0), 90))
        self.moment, self.instances = Usd.TimeCode.EarliestTime(), Usd.TraverseInstanceProxies()
        self.cache = UsdGeom.XformCache(self.moment)

    def get(self, attribute):
        return attribute.Get(self.moment) if attribute else None

    def is_drawn(self, prim):
        image = self.geom.Imageable(prim)
        if image.ComputeVisibility(self.moment) == self.geom.Tokens.invisible:
            self.notes.add("a mesh that is invisible")
            return False
        purpose = image.ComputePurpose()
        if purpose in (self.geom.Tokens.guide, self.geom.Tokens.proxy):
            self.notes.add(f"a mesh of purpose {purpose}")
            return False
        return True

    def read(self):
        for prim in self.stage.Traverse(self.instances):
            if prim.IsA(self.geom.Gprim) and not prim.IsA(self.geom.Mesh):
                self.notes.add(f"a {prim.GetTypeName()}: only meshes are taken")
            asset = self.asset(prim) if prim.IsA(self.geom.Mesh) and self.is_drawn(prim) else None
            if asset:
                yield asset

    def asset(self, prim):
        mesh, where = self.geom.Mesh(prim), f"{self.path}: {prim.GetPath()}"
        points, counts, indices = (self.get(a) for a in (mesh.GetPointsAttr(), mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()))
        if not points or not counts or not indices:
            self.notes.add("a mesh without points or faces")
            return None
        if len(points) > MOST_POINTS:
            raise PackError(f"{where}: has {len(points)} points: expected {MOST_POINTS} at most")
        if sum(counts) != len(indices) or min(counts) < 3 or min(indices) < 0 or max(indices) >= len(points):
            raise PackError(f"{where}: its faceVertexCounts and faceVertexIndices do not fit its {len(points)} points")
        if self.get(mesh.GetSubdivisionSchemeAttr()) not in (self.geom.Tokens.none, None):
            self.notes.add(f"{prim.GetPath()}: subdivision: its cage is taken")
        if mesh.GetPointsAttr().ValueMightBeTimeVarying() or any(
                self.geom.Xformable(p).TransformMightBeTimeVarying() for p in self.ancestors(prim) if p.IsA(self.geom.Xformable)):
            self.notes.add(f"{prim.GetPath()}: motion: its first moment is taken")
        # Scales apply; where the mesh stands does not: an asset has its own origin.
        to_world = self.cache.GetLocalToWorldTransform(prim) * self.turn
        to_world.SetTranslateOnly(self.gf.Vec3d(0))
        vertices = [tuple(self.unit * x for x in to_world.Transform(self.gf.Vec3d(p))) for p in points]
        flipped = (self.get(mesh.GetOrientationAttr()) == self.geom.Tokens.leftHanded) != (to_world.GetDeterminant3() < 0)
        looks, look_of_all, uv_names = self.looks(prim, len(counts))
        uvs, holes = self.uvs(prim, uv_names, list(indices)), set(self.get(mesh.GetHoleIndicesAttr()) or ())
        for look in looks:
            look.picture, look.bumps = (look.picture, look.bumps) if uvs else (None, None)
        faces, look_of, corners, at = [], [], [], 0
        for number, count in enumerate(counts):
            order = range(at + count - 1, at - 1, -1) if flipped else range(at, at + count)
            at += count
            if number in holes:
                continue
            faces.append([indices[i] for i in order])
            look_of.append(look_of_all[number])
            corners += [uvs[i] for i in order] if uvs else []
        name = prim.GetName() if prim.GetName().lower() not in ("mesh", "geometry", "visual", "collision") else prim.GetParent().GetName()
        asset = Asset(name, vertices, faces, looks, look_of, corners)
        self.weigh(prim, asset)
        return asset

    @staticmethod
    def ancestors(prim):
        """The prim itself, then those above it."""
        while prim and not prim.IsPseudoRoot():
            yield prim
            prim = prim.GetParent()

    def weigh(self, prim, asset):
        """As UsdPhysics.MassAPI has it: a mass above goes before one below, and before every density; of these the nearest counts."""
        density = None
        for above in self.ancestors(prim):
            if not above.HasAPI(self.physics.MassAPI):
                continue
            api = self.physics.MassAPI(above)
            mass, dense = self.get(api.GetMassAttr()) or 0, self.get(api.GetDensityAttr()) or 0
            if mass:
                asset.mass, asset.shares = mass * self.kilogram, str(above.GetPath())
            if dense and density is None:
                density = dense
            if self.get(api.GetDiagonalInertiaAttr()) not in (None, self.gf.Vec3f(0)):
                self.notes.add(f"{above.GetPath()}: its inertia: that of an even solid is taken")
        bound = self.shade.MaterialBindingAPI(prim).ComputeBoundMaterial("physics")[0]
        if bound and bound.GetPrim().HasAPI(self.physics.MaterialAPI):
            api = self.physics.MaterialAPI(bound.GetPrim())
            density = density or self.get(api.GetDensityAttr()) or None
            if self.get(api.GetStaticFrictionAttr()) or self.get(api.GetDynamicFrictionAttr()):
                self.notes.add(f"{bound.GetPath()}: friction: that of --material is taken")
        if asset.mass is None and density:
            asset.density = density * self.kilogram / self.unit ** 3

    def looks(self, prim, faces):
        """All of the mesh, the number of that of each face, and the names of the coordinates that pictures take."""
        names = set()
        looks, look_of = [self.look(prim, names)], [0] * faces
        for subset in self.geom.Subset.GetGeomSubsets(self.geom.Imageable(prim), self.geom.Tokens.face, "materialBind"):
            looks.append(self.look(subset.GetPrim(), names, looks[0].colour))
            for face in self.get(subset.GetIndicesAttr()) or ():
                if 0 <= face < faces:
                    look_of[face] = len(looks) - 1
        if len(names) > 1:
            self.notes.add(f"{prim.GetPath()}: pictures by several coordinates: {min(names)} is taken")
        return looks, look_of, names

    def look(self, prim, names, otherwise=None):
        """By the UsdPreviewSurface that is bound, else by displayColor."""
        look = Look(otherwise or self.display_colour(prim))
        bound = self.shade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
        if not bound:
            return look
        shader = bound.ComputeSurfaceSource()[0]
        if not shader or shader.GetIdAttr().Get() != "UsdPreviewSurface":
            if bound.ComputeSurfaceSource("mdl")[0] or shader:
                self.notes.add(f"{bound.GetPath()}: a shader that is no UsdPreviewSurface")
            return look
        for name in ("emissiveColor", "opacity", "displacement", "occlusion", "clearcoat"):
            given = shader.GetInput(name)
            usual = {"opacity": 1, "occlusion": 1}.get(name, 0)
            if given and (given.HasConnectedSource() or given.Get(self.moment) not in (None, usual, self.gf.Vec3f(0))):
                self.notes.add(f"{bound.GetPath()}: {name}")
        colour = shader.GetInput("diffuseColor")
        if colour and colour.HasConnectedSource():
            look.picture, look.placed = self.picture(bound, colour, names)
        elif colour and colour.Get(self.moment) is not None:
            look.colour = tuple(colour.Get(self.moment))
        normal = shader.GetInput("normal")
        if normal and normal.HasConnectedSource():
            look.bumps, _ = self.picture(bound, normal, names)
        look.metal, look.roughness = (self.number(bound, shader.GetInput(name)) for name in ("metallic", "roughness"))
        return look

    def number(self, material, given):
        if given and given.HasConnectedSource():
            self.notes.add(f"{material.GetPath()}: a picture of {given.GetBaseName()}")
            return None
        return given.Get(self.moment) if given else None

    def display_colour(self, prim):
        primvar = self.geom.PrimvarsAPI(prim).FindPrimvarWithInheritance("displayColor")
        colours = primvar.Get(self.moment) if primvar else None
        if not colours:
            return None
        if len(set(map(tuple, colours))) > 1:
            self.notes.add(f"{prim.GetPath()}: colours of points or faces: their mean is taken")
        return tuple(sum(c[k] for c in colours) / len(colours) for k in range(3))

    def picture(self, material, given, names):
        """The file of a UsdUVTexture, with scale and offset of its coordinates, whose name goes into `names`."""
        texture = self.shade.Shader(given.GetConnectedSources()[0][0].source.GetPrim())
        what = f"{material.GetPath()}: {given.GetBaseName()}"
        file = texture.GetInput("file") if texture and texture.GetIdAttr().Get() == "UsdUVTexture" else None
        asset = file.Get(self.moment) if file else None
        if not asset:
            self.notes.add(f"{what} by something else than a picture")
            return None, None
        ending, content = PurePosixPath(asset.path).suffix.lower(), self.content(asset)
        if ending not in PICTURES or content is None:
            self.notes.add(f"{what}: picture {asset.path}: " + ("cannot be read" if content is None else "expected PNG or JPEG"))
            return None, None
        for name, usual in (("scale", (1, 1, 1, 1)), ("bias", (0, 0, 0, 0))):
            value = texture.GetInput(name).Get(self.moment) if texture.GetInput(name) else None
            if given.GetBaseName() == "diffuseColor" and value is not None and tuple(value) != usual:
                self.notes.add(f"{what}: {name} of its colours")
        coordinates, placed = texture.GetInput("st"), None
        reader = self.shade.Shader(coordinates.GetConnectedSources()[0][0].source.GetPrim()) if coordinates and coordinates.HasConnectedSource() else None
        if reader and reader.GetIdAttr().Get() == "UsdTransform2d":
            values = [reader.GetInput(n).Get(self.moment) if reader.GetInput(n) else None for n in ("scale", "translation", "rotation")]
            placed = tuple(values[0] or (1, 1)) + tuple(values[1] or (0, 0))
            if values[2]:
                self.notes.add(f"{what}: the rotation of its coordinates")
            inner = reader.GetInput("in")
            reader = self.shade.Shader(inner.GetConnectedSources()[0][0].source.GetPrim()) if inner and inner.HasConnectedSource() else None
        variable = reader.GetInput("varname").Get(self.moment) if reader and reader.GetInput("varname") else None
        names.add(str(variable) if variable else "st")
        return (ending, content), placed

    @staticmethod
    def content(asset):
        """Of a file, or of a part of a .usdz. None: it cannot be read."""
        from pxr import Ar  # type: ignore[import-not-found,unused-ignore]
        opened = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(asset.resolvedPath)) if asset.resolvedPath else None
        return bytes(opened.GetBuffer()) if opened else None

    def uvs(self, prim, names, indices):
        """Of each corner; empty: no picture needs them, or there are none."""
        if not names:
            return []
        primvar = self.geom.PrimvarsAPI(prim).FindPrimvarWithInheritance(min(names))
        values = primvar.ComputeFlattened(self.moment) if primvar else None
        kind = primvar.GetInterpolation() if primvar else ""
        if values and kind == self.geom.Tokens.faceVarying and len(values) == len(indices):
            return [tuple(v) for v in values]
        if values and kind in (self.geom.Tokens.vertex, self.geom.Tokens.varying) and len(values) > max(indices):
            return [tuple(values[i]) for i in indices]
        self.notes.add(f"{prim.GetPath()}: its pictures, because it has no coordinates `{min(names)}` of each corner")
        return []
