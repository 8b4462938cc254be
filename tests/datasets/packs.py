"""Meshes of USD and MJCF, made here, as packs of rubble.import_pack: packs.py PROGRAM FOLDER"""
import json
import subprocess
import sys
from pathlib import Path

from pxr import Gf, Usd, UsdGeom, UsdPhysics

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
        need("1 Sphere: only meshes are taken" in notes, "notes: %s", notes)
        assets = checked()
        need(set(assets) == {"lump", "mirrored"}, "assets %s", set(assets))
        lump = assets["lump"]
        need(abs(lump["volume_m3"] - 0.048) < 1e-6 and lump["closed"], "lump %s", lump)
        need(abs(lump["mass_kg"] - 96) < 0.1, "its own mass %s", lump)
        need(abs(assets["mirrored"]["volume_m3"] - 0.001) < 1e-6 and assets["mirrored"]["closed"], "mirrored %s", assets["mirrored"])
    need("Kd 0.500000 0.250000 0.000000" in (FOLDER / "pack" / "lump.mtl").read_text(encoding="ascii"), "colour")


def write_mjcf():
    """A beam, off its origin, and a ball."""
    (FOLDER / "beam.obj").write_text("".join("v %g %g %g\n" % (c[0] * 2 + 5, c[1] * 0.2, c[2] * 0.3) for c in CORNERS) +
                                     "".join("f %d %d %d %d\n" % tuple(i + 1 for i in f) for f in FACES), encoding="ascii")
    (FOLDER / "model.xml").write_text("""<mujoco><asset><mesh name="big beam" file="beam.obj" scale="0.5 1 1"/></asset><worldbody>
      <body><freejoint/><geom type="mesh" mesh="big beam" rgba="0.2 0.4 0.6 1"/><geom type="sphere" size="0.1"/></body></worldbody></mujoco>""", encoding="ascii")


def mjcf_meshes_become_assets():
    write_mjcf()
    notes = import_pack(FOLDER / "model.xml", "--material", "timber")
    need("1 geoms that are no meshes" in notes, "notes: %s", notes)
    beam = checked()["big_beam"]
    need(abs(beam["volume_m3"] - 0.06) < 1e-6 and beam["closed"], "beam %s", beam)
    lines = [line.split() for line in (FOLDER / "pack" / "big_beam.obj").read_text(encoding="ascii").splitlines() if line.startswith("v ")]
    need(abs(min(float(line[1]) for line in lines) - 2.5) < 1e-6, "the frame of its file: %s", lines)
    need("Kd 0.200000" in (FOLDER / "pack" / "big_beam.mtl").read_text(encoding="ascii"), "colour")


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
    for check in (usd_meshes_become_assets, mjcf_meshes_become_assets, mistakes_are_named):
        for old in FOLDER.glob("*.usd*"):
            old.unlink()
        check()
        print("right:", check.__name__)


if __name__ == "__main__":
    main()
