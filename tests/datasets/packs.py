"""Meshes of USD and MJCF, made here, as packs of rubble.import_pack: packs.py PROGRAM FOLDER"""
import json
import struct
import subprocess
import sys
import zlib
from pathlib import Path

from pxr import Gf, Sdf, Usd, UsdGeom, UsdPhysics, UsdShade

PROGRAM, FOLDER = sys.argv[1], Path(sys.argv[2])
TOOL = Path(__file__).resolve().parents[2] / "python" / "rubble" / "import_pack.py"
CORNERS = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
FACES = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def need(condition, text, *values):
    if not condition:
        raise AssertionError(text % values if values else text)


def import_pack(file, *options, code=0):
    done = subprocess.run([sys.executable, TOOL, file, "-o", FOLDER / "pack", "--force", *options], check=False, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    need(done.returncode == code, "%s: exit code %d, not %d: %s", file.name, done.returncode, code, done.stderr)
    return done.stderr


def checked():
    """What `rubble assets check` says of each asset."""
    done = subprocess.run([PROGRAM, "assets", "check", FOLDER / "pack", "--json"], check=False, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    need(done.returncode == 0, "rubble assets check: %s", done.stderr)
    found = json.loads(done.stdout)
    assets = found if isinstance(found, list) else found["assets"]
    return {asset["name"]: asset for asset in assets}


def add_box(stage, path, size, **more):
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr([Gf.Vec3f(*(c * s for c, s in zip(corner, size))) for corner in CORNERS])
    mesh.CreateFaceVertexCountsAttr([4] * 6)
    mesh.CreateFaceVertexIndicesAttr(more.get("indices", [i for face in FACES for i in face]))
    mesh.CreateSubdivisionSchemeAttr("none")
    return mesh


def usd_meshes_become_assets():
    for ending in ("usda", "usdc"):
        stage = Usd.Stage.CreateNew(str(FOLDER / f"scene.{ending}"))
        UsdGeom.SetStageMetersPerUnit(stage, 0.01)
        UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
        UsdGeom.Xform.Define(stage, "/Lump").AddScaleOp().Set(Gf.Vec3f(2, 1, 1))
        mesh = add_box(stage, "/Lump/mesh", (20, 30, 40))  # cm; up is Y: 0.4 by 0.4 by 0.3 m
        mesh.CreateDisplayColorAttr([Gf.Vec3f(0.5, 0.25, 0)])
        UsdPhysics.MassAPI.Apply(mesh.GetPrim()).CreateMassAttr(96.0)
        mirrored = add_box(stage, "/Mirrored", (10, 10, 10))
        mirrored.AddScaleOp().Set(Gf.Vec3f(-1, 1, 1))
        UsdGeom.Sphere.Define(stage, "/ball")
        stage.Save()
        notes = import_pack(FOLDER / f"scene.{ending}")
        need("a Sphere: only meshes are taken" in notes, "notes: %s", notes)
        assets = checked()
        need(set(assets) == {"lump", "mirrored"}, "assets %s", set(assets))
        lump = assets["lump"]
        need(abs(lump["volume_m3"] - 0.048) < 1e-6 and lump["closed"], "lump %s", lump)
        need(abs(lump["mass_kg"] - 96) < 0.1, "its own mass %s", lump)
        need(abs(assets["mirrored"]["volume_m3"] - 0.001) < 1e-6 and assets["mirrored"]["closed"], "mirrored %s", assets["mirrored"])
    need("Kd 0.500000 0.250000 0.000000" in (FOLDER / "pack" / "lump.mtl").read_text(encoding="ascii"), "colour")


def write_picture(path):
    """Red at the left, green at the right."""
    rows = b"".join(b"\0" + b"\xff\0\0" * 4 + b"\0\xff\0" * 4 for _ in range(8))
    chunks = ((b"IHDR", struct.pack(">2I5B", 8, 8, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(rows)), (b"IEND", b""))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(struct.pack(">I", len(c)) + n + c + struct.pack(">I", zlib.crc32(n + c)) for n, c in chunks))


def add_material(stage, path, colour=None, picture=None, **more):
    """A UsdPreviewSurface; a picture comes by coordinates `st`, placed by a UsdTransform2d."""
    material, shader = UsdShade.Material.Define(stage, path), UsdShade.Shader.Define(stage, path + "/surface")
    shader.CreateIdAttr("UsdPreviewSurface")
    material.CreateSurfaceOutput().ConnectToSource(shader.ConnectableAPI(), "surface")
    given = shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f)
    if colour:
        given.Set(Gf.Vec3f(*colour))
    for name, value in more.items():
        shader.CreateInput(name, Sdf.ValueTypeNames.Float).Set(value)
    if picture:
        nodes = [UsdShade.Shader.Define(stage, f"{path}/{name}") for name in ("picture", "place", "st")]
        for node, kind in zip(nodes, ("UsdUVTexture", "UsdTransform2d", "UsdPrimvarReader_float2")):
            node.CreateIdAttr(kind)
        nodes[0].CreateInput("file", Sdf.ValueTypeNames.Asset).Set(picture)
        nodes[0].CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(nodes[1].ConnectableAPI(), "result")
        nodes[1].CreateInput("scale", Sdf.ValueTypeNames.Float2).Set(Gf.Vec2f(2, 3))
        nodes[1].CreateInput("in", Sdf.ValueTypeNames.Float2).ConnectToSource(nodes[2].ConnectableAPI(), "result")
        nodes[2].CreateInput("varname", Sdf.ValueTypeNames.String).Set("st")
        given.ConnectToSource(nodes[0].ConnectableAPI(), "rgb")
    return material


def bind(prim, material, purpose=UsdShade.Tokens.allPurpose):
    UsdShade.MaterialBindingAPI.Apply(prim).Bind(material, UsdShade.Tokens.weakerThanDescendants, purpose)


def usd_surfaces_come_along():
    write_picture(FOLDER / "half.png")
    stage = Usd.Stage.CreateNew(str(FOLDER / "looks.usda"))
    painted = add_material(stage, "/Looks/painted", picture="half.png", roughness=0.3, metallic=0.0, opacity=0.5)
    grey = add_material(stage, "/Looks/grey", colour=(0.25, 0.5, 0.75))
    box = add_box(stage, "/box", (1, 1, 1))
    bind(box.GetPrim(), painted)
    places = [Gf.Vec2f(*place) for _ in FACES for place in ((0, 0), (1, 0), (1, 1), (0, 1))]
    UsdGeom.PrimvarsAPI(box).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying).Set(places)
    lid = UsdGeom.Subset.CreateGeomSubset(box, "lid", UsdGeom.Tokens.face, [5], "materialBind")
    bind(lid.GetPrim(), grey)
    bare = add_box(stage, "/bare", (1, 1, 2))
    bind(bare.GetPrim(), painted)
    spotted = add_box(stage, "/spotted", (2, 1, 1))
    UsdGeom.PrimvarsAPI(spotted).CreatePrimvar("displayColor", Sdf.ValueTypeNames.Color3fArray, UsdGeom.Tokens.uniform).Set(
        [Gf.Vec3f(1, 0, 0)] * 3 + [Gf.Vec3f(0, 0, 1)] * 3)
    stage.Save()
    notes = import_pack(FOLDER / "looks.usda")
    for note in ("/Looks/painted: opacity", "/bare: its pictures, because it has no coordinates `st`", "/spotted: colours of points or faces: their mean"):
        need(note in notes, "%s in %s", note, notes)
    need((FOLDER / "pack" / "box_0_colour.png").read_bytes() == (FOLDER / "half.png").read_bytes(), "the picture")
    library = (FOLDER / "pack" / "box.mtl").read_text(encoding="ascii")
    for line in ("map_Kd -s 2 3 1 -o 0 0 0 box_0_colour.png", "Pr 0.300000", "Kd 0.250000 0.500000 0.750000"):
        need(line in library, "%s in %s", line, library)
    lines = (FOLDER / "pack" / "box.obj").read_text(encoding="utf-8").splitlines()
    faces = {line: [after for after in lines[i + 1:] if after[0] in "fu"] for i, line in enumerate(lines) if line.startswith("usemtl")}
    need(len(faces["usemtl surface_1"]) == 1 and faces["usemtl surface_1"][0].split()[1] == "2/21", "the lid %s", faces)
    need("Kd 0.500000 0.000000 0.500000" in (FOLDER / "pack" / "spotted.mtl").read_text(encoding="ascii"), "the mean of its colours")
    need(set(checked()) == {"box", "bare", "spotted"}, "assets")


def usd_masses_are_those_of_bodies():
    """In grams and centimetres; of a body that holds two boxes; by density; beside what is not drawn."""
    stage = Usd.Stage.CreateNew(str(FOLDER / "masses.usda"))
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    UsdPhysics.SetStageKilogramsPerUnit(stage, 0.001)
    body = UsdGeom.Xform.Define(stage, "/body").GetPrim()
    UsdPhysics.MassAPI.Apply(body).CreateMassAttr(9000.0)
    for path, size in (("/body/small", (10, 10, 10)), ("/body/large", (20, 10, 10))):
        UsdPhysics.MassAPI.Apply(add_box(stage, path, size).GetPrim()).CreateMassAttr(1.0)  # that of the body goes before it
    UsdPhysics.MassAPI.Apply(add_box(stage, "/dense", (10, 10, 30)).GetPrim()).CreateDensityAttr(2.0)
    rubber = UsdShade.Material.Define(stage, "/rubber")
    api = UsdPhysics.MaterialAPI.Apply(rubber.GetPrim())
    api.CreateDensityAttr(1.5), api.CreateStaticFrictionAttr(0.9)
    bind(add_box(stage, "/tyre", (10, 10, 40)).GetPrim(), rubber, "physics")
    UsdGeom.Imageable(add_box(stage, "/hidden", (1, 1, 1))).MakeInvisible()
    add_box(stage, "/hull", (5, 5, 5)).CreatePurposeAttr(UsdGeom.Tokens.guide)
    for path in ("/twin_a", "/twin_b"):
        UsdPhysics.MassAPI.Apply(add_box(stage, path, (10, 20, 30)).GetPrim()).CreateMassAttr(1e9)
    moving = add_box(stage, "/moving", (10, 10, 10))
    scale = moving.AddScaleOp()
    scale.Set(Gf.Vec3f(2, 1, 1), 0), scale.Set(Gf.Vec3f(5, 1, 1), 10)
    open_box = add_box(stage, "/open", (30, 30, 30))
    open_box.CreateHoleIndicesAttr([5])
    stage.Save()
    notes = import_pack(FOLDER / "masses.usda")
    for note in ("a mesh that is invisible", "a mesh of purpose guide", "a mesh that equals twin_a", "/rubber: friction", "twin_a: its density of 1.67e+08 kg/m3", "/moving: motion: its first moment"):
        need(note in notes, "%s in %s", note, notes)
    done = subprocess.run([PROGRAM, "assets", "check", FOLDER / "pack", "--json"], check=False, stdout=subprocess.PIPE, text=True)
    found = json.loads(done.stdout)
    assets = {asset["name"]: asset for asset in (found if isinstance(found, list) else found["assets"])}
    need(set(assets) == {"small", "large", "dense", "tyre", "twin_a", "moving", "open"}, "assets %s", set(assets))
    for name, mass in (("small", 3), ("large", 6), ("dense", 6), ("tyre", 6)):
        need(abs(assets[name]["mass_kg"] - mass) < 0.01 * mass, "%s weighs %s kg", name, assets[name]["mass_kg"])
    need(abs(assets["moving"]["volume_m3"] - 0.002) < 1e-6, "moving %s", assets["moving"])
    need(not assets["open"]["closed"], "a hole is no face")


def write_mjcf():
    """A beam, off its origin, and a ball."""
    (FOLDER / "beam.obj").write_text("".join("v %g %g %g\n" % (c[0] * 2 + 5, c[1] * 0.2, c[2] * 0.3) for c in CORNERS) +
                                     "".join("f %d %d %d %d\n" % tuple(i + 1 for i in f) for f in FACES), encoding="ascii")
    (FOLDER / "model.xml").write_text("""<mujoco><asset><mesh name="big beam" file="beam.obj" scale="0.5 1 1"/></asset><worldbody>
      <body><freejoint/><geom type="mesh" mesh="big beam" rgba="0.2 0.4 0.6 1"/><geom type="sphere" size="0.1"/></body></worldbody></mujoco>""", encoding="ascii")


def mjcf_meshes_become_assets():
    write_mjcf()
    notes = import_pack(FOLDER / "model.xml", "--material", "timber")
    need("a sphere: only meshes are taken" in notes, "notes: %s", notes)
    beam = checked()["big_beam"]
    need(abs(beam["volume_m3"] - 0.06) < 1e-6 and beam["closed"], "beam %s", beam)
    lines = [line.split() for line in (FOLDER / "pack" / "big_beam.obj").read_text(encoding="ascii").splitlines() if line.startswith("v ")]
    need(abs(min(float(line[1]) for line in lines) - 2.5) < 1e-6, "the frame of its file: %s", lines)
    need("Kd 0.200000" in (FOLDER / "pack" / "big_beam.mtl").read_text(encoding="ascii"), "colour")


def mjcf_surfaces_and_masses_come_along():
    """v runs down in MuJoCo: corner 2 of the file, at v = 0.25, is there again."""
    write_picture(FOLDER / "half.png")
    (FOLDER / "tetra.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 0.25\n"
                                      "f 1/1 3/3 2/2\nf 1/1 2/2 4/3\nf 1/1 4/3 3/2\nf 2/1 3/2 4/3\n", encoding="ascii")
    (FOLDER / "bricks.xml").write_text("""<mujoco><asset><texture name="half" type="2d" file="half.png"/>
      <material name="painted" texture="half" texrepeat="2 3" rgba="1 0.5 1 1" metallic="0.25" roughness="0.5"/>
      <mesh name="heavy" file="tetra.obj"/><mesh name="dense" file="tetra.obj" scale="1 1 2"/><mesh name="body" file="tetra.obj" scale="1 2 2"/>
      <mesh name="usual" file="tetra.obj" scale="2 2 2"/></asset><worldbody><geom type="plane" size="1 1 1"/>
      <body><geom type="mesh" mesh="heavy" material="painted" mass="300"/></body>
      <body><geom type="mesh" mesh="dense" density="1800" friction="0.4 0.1 0.1"/></body>
      <body><inertial mass="500" pos="0 0 0" diaginertia="9 9 9"/><geom type="mesh" mesh="body"/></body>
      <body><geom type="mesh" mesh="usual"/></body></worldbody></mujoco>""", encoding="ascii")
    notes = import_pack(FOLDER / "bricks.xml", "--material", "brick")
    for note in ("a plane: only meshes are taken", "dense: friction"):
        need(note in notes, "%s in %s", note, notes)
    library = (FOLDER / "pack" / "heavy.mtl").read_text(encoding="ascii")
    for line in ("Kd 1.000000 0.500000 1.000000", "Pm 0.250000", "Pr 0.500000", "map_Kd -s 2 3 1 -o 0 0 0 heavy_0_colour.png"):
        need(line in library, "%s in %s", line, library)
    text = (FOLDER / "pack" / "heavy.obj").read_text(encoding="utf-8")
    need("vt 0 0.25" in text and "vt 1 0\n" in text, "texture coordinates: %s", text)
    assets = checked()
    usual = assets["usual"]["mass_kg"] / assets["usual"]["volume_m3"]
    need(usual > 1500, "what says nothing is of the material: %s kg/m3", usual)
    for name, mass in (("heavy", 300), ("dense", 600), ("body", 500)):
        need(abs(assets[name]["mass_kg"] - mass) < 0.01 * mass, "%s weighs %s kg", name, assets[name]["mass_kg"])


def mistakes_are_named():
    stage = Usd.Stage.CreateNew(str(FOLDER / "bad.usda"))
    add_box(stage, "/a/broken", (1, 1, 1), indices=[0, 1, 99, 2] * 6)
    stage.Save()
    need("bad.usda: /a/broken: its faceVertexCounts" in import_pack(FOLDER / "bad.usda", code=1), "a broken mesh")
    (FOLDER / "torn.usda").write_text("#usda 1.0\ndef Mesh \"a\" {", encoding="ascii")
    need("torn.usda: cannot be read as USD" in import_pack(FOLDER / "torn.usda", code=1), "a torn stage")
    (FOLDER / "bad.xml").write_text("<mujoco><worldbody><geom type='cube'/></worldbody></mujoco>", encoding="ascii")
    need("bad.xml: cannot be read as MJCF" in import_pack(FOLDER / "bad.xml", code=1), "a broken model")
    (FOLDER / "empty.xml").write_text("<mujoco/>", encoding="ascii")
    need("has no mesh" in import_pack(FOLDER / "empty.xml", code=1), "no mesh")
    (FOLDER / "mesh.fbx").write_text("", encoding="ascii")
    need("expected .usd" in import_pack(FOLDER / "mesh.fbx", code=1), "another format")


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    for check in (usd_meshes_become_assets, usd_surfaces_come_along, usd_masses_are_those_of_bodies, mjcf_meshes_become_assets,
                  mjcf_surfaces_and_masses_come_along, mistakes_are_named):
        for old in FOLDER.glob("*.usd*"):
            old.unlink()
        check()
        print("right:", check.__name__)


if __name__ == "__main__":
    main()
