"""What a user does with an installed wheel, without the checkout: python -I check_wheel.py FOLDER

It uses nothing of the machine but the C and C++ libraries. Frames need EGL, which a bare machine lacks: --frames draws some.
"""
import json
import os
import re
import subprocess
import sys
import sysconfig

import numpy as np

import rubble
from rubble import missions as m

folder, frames = sys.argv[1], "--frames" in sys.argv
package = os.path.dirname(rubble.__file__)
assert package.startswith(sysconfig.get_paths()["platlib"]), package
program = os.path.join(sysconfig.get_paths()["scripts"], "rubble")
bare = {"PATH": "/usr/bin:/bin", "HOME": folder}


def rubble_says(*words):
    return subprocess.run([program, *words], check=True, env=bare, cwd=folder, stdout=subprocess.PIPE, text=True).stdout


assert rubble_says("--version").split() == ["rubble", rubble.__version__]

# A mission in Python and in Lua, here and by the program.
mission = rubble.Mission(seed=3, pile=m.Pile(layers=1, pieces_per_layer=6), lidars={"top": m.Lidar(model="vlp16")},
                         outputs=m.Outputs(bag=True, frames=False))
pile = rubble.settle(mission)
manifest = rubble.run(mission, os.path.join(folder, "settled"), settle=True)
assert manifest["pile"]["pieces"] == len(pile) and manifest["pile"]["settled"], manifest["pile"]
assert rubble.open_pile(os.path.join(folder, "settled")).state_hash == pile.state_hash
with open(os.path.join(folder, "mission.lua"), "w") as file:
    file.write(mission.to_lua())
rubble_says("settle", "mission.lua", "--out", "lua", "--quiet")
with open(os.path.join(folder, "lua", "manifest.json")) as file:
    assert json.load(file)["outputs"] == manifest["outputs"]
print(f"{len(pile)} pieces, {pile.state_hash:016x}")

points = rubble.Lidar(pile, "vlp16").scan(rubble.look_at([-4, 0, 1.2], [0, 0, 0.3]))
assert len(points) > 1000 and points.dtype.names[0] == "x" and np.isfinite(points["x"]).all()
robot = rubble.RobotWorld(pile, "crawler", rubble.pose([-6, 0, 0.01]))
robot.drive(0.4)
assert robot.step(0.5)["links"].strides == (56, 8)

try:
    import gymnasium
except ImportError:
    print("gymnasium is not there")
else:
    env = gymnasium.make("rubble.envs:rubble/VoidExplore-v0", pile_seeds=[1], size=16)
    observation, _ = env.reset(seed=3)
    for _ in range(3):
        observation, reward, *_ = env.step(env.action_space.sample())
    assert observation["depth"].shape[:2] == (16, 16)
    print("gymnasium", gymnasium.__version__)

with open("/proc/self/maps") as file:
    loaded = set(re.findall(r"/\S+\.so[.\d]*", file.read()))
allowed = re.compile(r"/(ld-linux[^/]*|lib(c|m|dl|rt|pthread|util|resolv|gcc_s|stdc\+\+|nss_\w+|python3[^/]*|z|bz2|lzma|expat|ffi)[^/]*)\.so")
foreign = sorted(path for path in loaded if not path.startswith((sys.prefix, sys.base_prefix, sysconfig.get_paths()["stdlib"])) and not allowed.search(path))
assert not foreign, f"libraries of this machine are loaded: {foreign}"

if frames:
    eye = rubble.look_at([-4, 0, 2], [0, 0, 0.3])
    assert rubble.Renderer(pile).render(eye, 160, 120)["rgb"].std() > 5
else:
    try:
        rubble.Renderer(pile)
    except rubble.RunError as error:
        assert "EGL" in str(error), error

libraries = os.listdir(os.path.join(os.path.dirname(package), "rubble_sim.libs"))
print(f"Python {sys.version.split()[0]}, numpy {np.__version__}, {len(libraries)} libraries")
