#!/usr/bin/env python3
"""Makes the small seed inputs of the fuzz targets: make_corpus.py SOURCES PROGRAM OUT

Scripts and packs are those that come with Rubble; recordings and saved states are of a run of 16 x 16
pixels, made by PROGRAM. OUT gets a folder for each target and is made anew.
"""
import base64
import io
import shutil
import struct
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

MISSION = """return rubble.mission {
  seed = 3,
  pile = { layers = 1, pieces_per_layer = 3, mix = { { asset = "brick" } },
           spawn_position = { 0, 0, 1 }, spawn_bounds = { 0.5, 0.5, 0.5 } },
  camera = { width = 16, height = 16 },
  trajectory = { rate_hz = 10, waypoints = {
    { t = 0, position = { -1.5, 0, 0.8 }, look_at = { 0, 0, 0.1 } },
    { t = 0.1, position = { -1.4, 0.1, 0.8 }, look_at = { 0, 0, 0.1 } },
  } },
  outputs = { bag = true, mcap = true, rawlog = true, simplemap = true, tum = true, colmap = true,
              frames = true },
}
"""

CUBE = ("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nusemtl a\n"
        "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nf 5 6 7 8\n")

DAE = ('<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" '
       'version="1.4.1"><library_geometries><geometry id="g"><mesh><source id="p"><float_array '
       'id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#a" '
       'count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param '
       'name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input '
       'semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" '
       'source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>'
       '<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/>'
       '</node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/>'
       '</scene></COLLADA>')


class Corpus:
    def __init__(self, out):
        self.out = Path(out)
        shutil.rmtree(out, ignore_errors=True)

    def add(self, target, content):
        folder = self.out / target
        folder.mkdir(parents=True, exist_ok=True)
        data = content.encode() if isinstance(content, str) else content
        (folder / f"seed_{len(list(folder.iterdir()))}").write_bytes(data)


def unsealed(path):
    """The content of one of our sealed files: without 20 bytes of head and 32 of checksum."""
    return path.read_bytes()[20:-32]


def binary_ply():
    head = ("ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty "
            "float y\nproperty float z\nelement face 4\nproperty list uchar int vertex_indices\n"
            "end_header\n").encode()
    for p in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)):
        head += struct.pack("<3f", *p)
    for f in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)):
        head += struct.pack("<B3i", 3, *f)
    return head


ASCII_PLY = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
             "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
             "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")


def geo_tiff():
    """Two heights of 32 bits, 30 m apart."""
    tags = [(256, 3, 1, struct.pack("<H", 2)), (257, 3, 1, struct.pack("<H", 1)), (258, 3, 1, struct.pack("<H", 32)),
            (259, 3, 1, struct.pack("<H", 1)), (262, 3, 1, struct.pack("<H", 1)), (273, 4, 1, b""),
            (277, 3, 1, struct.pack("<H", 1)), (278, 3, 1, struct.pack("<H", 1)), (279, 4, 1, struct.pack("<I", 8)),
            (339, 3, 1, struct.pack("<H", 3)), (33550, 12, 3, struct.pack("<3d", 30, 30, 0)),
            (33922, 12, 6, struct.pack("<6d", 0, 0, 0, 5e5, 4e6, 0)), (42113, 2, 6, b"-9999\0")]
    after = 8 + 2 + 12 * len(tags) + 4
    long = sum(len(value) for _, _, _, value in tags if len(value) > 4)
    directory, values = struct.pack("<H", len(tags)), b""
    for tag, kind, count, value in tags:
        if tag == 273:
            value = struct.pack("<I", after + long)
        if len(value) > 4:
            value, values = struct.pack("<I", after + len(values)), values + value
        directory += struct.pack("<HHI", tag, kind, count) + value.ljust(4, b"\0")
    return b"II*\0" + struct.pack("<I", 8) + directory + struct.pack("<I", 0) + values + struct.pack("<2f", 812, -9999)


def small_track():
    """One body that falls for two samples."""
    content = struct.pack("<QddQ", 2, 0.0, 0.5, 1) + struct.pack("<idddIQ", 4, 0, 0, 0, 2**32 - 1, 2)
    for sample, z in ((0, 3.0), (1, 2.0)):
        content += struct.pack("<I7d6f", sample, 1, 0, 0, 0, 0, 0, z, 0, 0, -2, 0, 0, 0)
    return content


def small_fines():
    """A grain of grit, and a sheet of one triangle."""
    content = struct.pack("<II4s", 1, 4, b"dust") + struct.pack("<QBBHi10f", 1, 0, 0, 3, 2, 0, 0, 1, 1, 0, 0, 0, 0.01, 0.01, 0.01)
    content += struct.pack("<QBBiI", 1, 5, 0, -1, 3)
    for x, y in ((0, 0), (1, 0), (0, 1)):
        content += struct.pack("<6f", x, y, 0, 0, 0, 1)
    return content + struct.pack("<I3I", 1, 0, 1, 2)


def run(program, folder):
    script = folder / "m.lua"
    script.write_text(MISSION)
    call = [program, "run", str(script), "--quiet", "--out", str(folder / "run")]
    subprocess.run(call, check=True, stdout=subprocess.DEVNULL)
    export = [program, "export", str(folder / "run"), "--out", str(folder / "export")]
    subprocess.run(export, check=True, stdout=subprocess.DEVNULL)
    # A checkpoint is there while a run is unfinished: one that is killed after its pile leaves it.
    call = [program, "settle", str(script), "--quiet", "--checkpoint-every", "0", "--set",
            "pile.layers=3", "--out", str(folder / "cut")]
    process = subprocess.Popen(call, stdout=subprocess.DEVNULL)
    checkpoint = folder / "cut/unfinished/settle.checkpoint"
    kept = folder / "checkpoint"
    while process.poll() is None:
        try:
            shutil.copy(checkpoint, kept)
        except OSError:
            pass
    return folder / "run"


def add_recordings(corpus, run_folder):
    for target, name in (("bag", "mission.bag"), ("mcap", "mission.mcap"),
                         ("rawlog", "mission.rawlog"), ("simplemap", "mission.simplemap"),
                         ("trajectory", "groundtruth.txt"), ("sealed_file", "pile.bin"),
                         ("manifest", "manifest.json")):
        corpus.add(target, (run_folder / name).read_bytes())
    corpus.add("pile_state", unsealed(run_folder / "pile.bin"))
    corpus.add("track", small_track())
    corpus.add("fines", small_fines())
    text = "-----".join((run_folder / "colmap" / f).read_text() for f in
                        ("cameras.txt", "images.txt", "points3D.txt")
                        if (run_folder / "colmap" / f).exists())
    corpus.add("colmap_text", text)
    corpus.add("picture_png", sorted((run_folder / "frames/rgb").glob("*.png"))[0].read_bytes())
    corpus.add("picture_exr", sorted((run_folder / "frames/depth").glob("*.exr"))[0].read_bytes())


GLTF = ('{"asset":{"version":"2.0"},"extensionsRequired":["KHR_mesh_quantization"],"scenes":[{"nodes":[0,1]}],'
        '"nodes":[{"mesh":0,"skin":0},{"scale":[1,-2,1]}],"skins":[{"joints":[1]}],"materials":[{"pbrMetallicRoughness":'
        '{"baseColorTexture":{"index":0,"extensions":{"KHR_texture_transform":{"scale":[2,1]}}}}}],"textures":[{"source":0}],'
        '"images":[{"uri":"a.png"}],"meshes":[{"weights":[1],"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,'
        '"JOINTS_0":2,"WEIGHTS_0":2},"indices":3,"material":0,"targets":[{"POSITION":0}]}]}],"buffers":[{"byteLength":24,'
        '"uri":"data:;base64,AAAAAQAAAAEAAAABAAECAQIDAAABAAEB"}],"bufferViews":[{"buffer":0,"byteLength":24}],"accessors":['
        '{"bufferView":0,"componentType":5120,"count":4,"type":"VEC3"},{"bufferView":0,"componentType":5121,"normalized":true,'
        '"count":4,"type":"VEC2"},{"bufferView":0,"componentType":5121,"count":4,"type":"VEC4"},'
        '{"bufferView":0,"byteOffset":12,"componentType":5121,"count":6,"type":"SCALAR"}]}')


def threemf():
    model = ('<model xmlns:p="http://schemas.microsoft.com/3dmanufacturing/production/2015/06" requiredextensions="p"><resources>'
             '<basematerials id="5"><base name="a" displaycolor="#FF0000"/></basematerials><object id="1" pid="5" pindex="0"><mesh>'
             '<vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/></vertices><triangles>'
             '<triangle v1="0" v2="1" v3="2"/></triangles></mesh></object><object id="2"><components><component objectid="1" '
             'p:path="/3D/3dmodel.model" transform="1 0 0 0 1 0 0 0 1 0 0 2"/></components></object></resources><build>'
             '<item objectid="2"/></build></model>')
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr(zipfile.ZipInfo("3D/3dmodel.model"), model)
    return packed.getvalue()


def colmap_binary():
    cameras = struct.pack("<QIiQQ4d", 1, 1, 1, 16, 16, 8, 8, 8, 8)
    images = struct.pack("<QI7dI", 1, 1, 1, 0, 0, 0, 0, 0, 0, 1) + b"a.png\0"
    images += struct.pack("<Qddq", 1, 1.0, 2.0, 7)
    points = struct.pack("<QQ3d3BdQII", 1, 7, 0, 0, 1, 9, 9, 9, 0.5, 1, 1, 0)
    return b"-----".join((cameras, images, points))


def main():
    sources, program, out = Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    corpus = Corpus(out)
    for script in sorted((sources / "scripts").glob("*.lua")):
        corpus.add("mission", script.read_text())
        corpus.add("source_map", script.read_text())
    for text in (
        '<?xml version="1.0" encoding="ISO-8859-1"?><robot name="r\xe4"><link name="world"/><link name="a"><visual>'
        '<geometry><capsule radius="1" length="2"/></geometry><material name="m"/></visual></link>'
        '<joint name="j" type="floating"><parent link="world"/><child link="a"/></joint></robot>',
        '<robot name="r"><link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
        '<collision><origin xyz="0 0 1" rpy="0 1 0"/><geometry><mesh filename="package://p/a.stl" scale="1 -1 1"/></geometry>'
        '</collision></link><link name="b"/><joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
        '<axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="5" velocity="2"/><mimic joint="k"/></joint>'
        '<material name="m"><color rgba="1 0 0 1"/></material><gazebo><![CDATA[x]]></gazebo></robot>',
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r"><xacro:include filename="$(find p)/a.xacro"/></robot>',
    ):
        corpus.add("urdf", text.encode("latin-1"))
    corpus.add("suite", (sources / "scripts/ci/suite.lua").read_text())
    corpus.add("pack", "return pack { name = 'p', assets = { { name = 'a', mesh = 'a.obj', "
                       "collision = 'hull', material = 'brick', looks = { x = 'brick' } } } }")
    for text in ("seed=4", "pile.mix[1].weight=2", "camera.width=64", "fogdensity=0.2"):
        corpus.add("override", text)
    corpus.add("frame_journal", "0123456789abcdef 0123456789abcdef 0\n" * 3)
    corpus.add("flow", struct.pack("<fii", 202021.25, 2, 1) + bytes(16))
    corpus.add("data_grid", "P2\n2 2\n255\n0 1 2 3\n")
    corpus.add("data_grid", "ncols 2\nnrows 1\nxllcorner 0\nyllcorner 0\ncellsize 30\nNODATA_value -9999\n1 -9999\n")
    corpus.add("data_grid", geo_tiff())
    corpus.add("data_grid", b"Pf\n1 1\n-1\n\0\0\x80\x3f")
    corpus.add("data_grid", b"BM" + struct.pack("<4I2i2H6I", 0, 0, 62, 40, 3, 1, 1, 4, 2, 0, 0, 0, 2, 0) +
               b"\x0a\x0a\x0a\0\xc8\xc8\xc8\0" + b"\3\x10\0\1")
    corpus.add("data_grid", base64.b64decode("UklGRhoAAABXRUJQVlA4TA0AAAAvAAAAEAcQERGIiP4HAA=="))  # WebP of one pixel
    for trajectory in ("1403636579763555584,0,0,0,1,0,0,0\n", "#t [ns],x,y,z,qx,qy,qz,qw\n0,1,2,3,0,0,0,1\n",
                       "1 0 0 0 0 1 0 0 0 0 1 0\n", "t;x;y;z;yaw_deg\n0;1;2;3;90\n"):
        corpus.add("trajectory", trajectory)
        corpus.add("text_table", trajectory)
    corpus.add("accelerogram", "PEER\nx, 090\nACCELERATION TIME SERIES IN UNITS OF G\n 2 .005 NPTS, DT\n .1 -.2E-1\n")
    corpus.add("accelerogram", "SAMPLING_INTERVAL_S: 0.005\nNDATA: 2\nUNITS: cm/s^2\nDATA_TYPE: ACCELERATION\n1\n2\n")
    corpus.add("accelerogram", "Sampling Freq(Hz) 100Hz\nScale Factor 2000(gal)/8388608\nMemo.\n 1 2\n 3\n")
    corpus.add("accelerogram", "t [s],a [g]\n0,1\n0.01,2\n")
    corpus.add("calibration", "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0, 0, 0, 0]\n  distortion_model: "
                              "radtan\n  intrinsics: [400, 400, 320, 240]\n  resolution: [640, 480]\n")
    corpus.add("calibration", "%YAML:1.0\n---\nimage_width: 4\nimage_height: 3\ncamera_matrix: !!opencv-matrix\n   "
                              "rows: 3\n   cols: 3\n   dt: d\n   data: [ 5., 0., 2., 0., 5., 1., 0., 0., 1. ]\n")
    corpus.add("calibration", '{"prod_line":"OS-1-64","lidar_mode":"1024x10","beam_altitude_angles":[1,2]}')
    corpus.add("ply_map", ASCII_PLY)
    corpus.add("ply_map", binary_ply())
    corpus.add("colmap_binary", colmap_binary())
    corpus.add("colmap_text", "1 PINHOLE 16 16 8 8 8 8\n-----1 1 0 0 0 0 0 0 1 a.png\n1 2 7\n-----"
                              "7 0 0 1 9 9 9 0.5 1 0\n")
    corpus.add("mesh_obj", CUBE)
    corpus.add("mesh_mtl", "newmtl a\nKd 1 0 0\nNs 9\nPm 1\nmap_Kd -s 2 2 1 -clamp on a b.png\nnorm n.png\n")
    corpus.add("mesh_gltf", GLTF)
    corpus.add("mesh_3mf", threemf())
    corpus.add("mesh_dae", DAE)
    corpus.add("mesh_ply", binary_ply())
    corpus.add("mesh_ply", ASCII_PLY)
    with tempfile.TemporaryDirectory() as folder:
        made = run(program, Path(folder))
        add_recordings(corpus, made)
        corpus.add("mesh_stl", (made / "pile.stl").read_bytes()[:84 + 50 * 12])
        corpus.add("mesh_glb", (Path(folder) / "export/pile.glb").read_bytes())
        corpus.add("data_grid", sorted((made / "frames/rgb").glob("*.png"))[0].read_bytes())
        checkpoint = Path(folder) / "checkpoint"
        corpus.add("checkpoint", unsealed(checkpoint) if checkpoint.exists() else b"")
        scenario = subprocess.run([program, "check", str(Path(folder) / "m.lua")], check=True,
                                  capture_output=True, text=True).stdout
        corpus.add("scenario_json", scenario)
        manifest = (made / "manifest.json").read_text()
        corpus.add("unfinished", manifest)


if __name__ == "__main__":
    main()
