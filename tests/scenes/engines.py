#!/usr/bin/env python3
"""Simulates an exported scene by an engine: engines.py ENGINE EXPORT_FOLDER SECONDS

Prints one line of JSON: how far free pieces drifted, and how long it took. Engines: mujoco, drake, pybullet, newton,
rapier, and usd, which checks the file by OpenUSD's own validators and does not simulate. Each wants the Python package of its
name (usd: usd-core); see requirements.txt. Settings that an engine needs are here, each with its reason.
"""
import json
import math
import sys
import time
from pathlib import Path

from results import Result


def read_scene(folder):
    return json.loads((folder / "scene.json").read_text())


def free_links(scene):
    """Names and start positions of links that may move, robots left out."""
    for model in scene["models"]:
        if model["fixed"] and len(model["links"]) == 1 or model["robot"]:
            continue
        for i, link in enumerate(model["links"]):
            if not (i == 0 and model["fixed"]):
                yield model, link


def figures(begin, end, seconds, wall, loaded):
    """begin, end: positions by name; a piece that is not a number any more has drifted without end."""
    drifts = sorted(min(math.dist(begin[n], end[n]), 1e3) if all(map(math.isfinite, end[n])) else 1e3 for n in begin)
    if not drifts:
        return {"pieces": 0, "loaded_s": round(loaded, 1)}
    return {"pieces": len(drifts), "median_mm": round(1e3 * drifts[len(drifts) // 2], 2),
            "p90_mm": round(1e3 * drifts[int(0.9 * (len(drifts) - 1))], 2), "max_mm": round(1e3 * drifts[-1], 1),
            "beyond_5_cm": sum(d > 0.05 for d in drifts), "loaded_s": round(loaded, 1),
            "speed": round(seconds / max(wall, 1e-9), 3)}


def run_mujoco(folder, seconds):
    import mujoco
    began = time.time()
    model = mujoco.MjModel.from_xml_path(str(folder / "mjcf/pile.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    loaded = time.time() - began
    scene = read_scene(folder / "mjcf")
    names = {}
    for m, link in free_links(scene):
        body = link["name"] if len(m["links"]) == 1 else m["name"] + "/" + link["name"]
        names[link["name"]] = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, body)
        assert names[link["name"]] >= 0, body
        mass = model.body_mass[names[link["name"]]]
        assert abs(mass - link["mass_kg"]) < 1e-6 * mass, (body, mass, link["mass_kg"])
        assert math.dist(data.xpos[names[link["name"]]], link["position_m"]) < 1e-6, body
    begin = {n: tuple(data.xpos[b]) for n, b in names.items()}
    began = time.time()
    # Wheels brake and joints hold where they are.
    for a in range(model.nu):
        joint = model.actuator_trnid[a, 0]
        if model.actuator_biasprm[a, 1] != 0:
            data.ctrl[a] = data.qpos[model.jnt_qposadr[joint]]
    while data.time < seconds:
        mujoco.mj_step(model, data)
    end = {n: tuple(data.xpos[b]) for n, b in names.items()}
    result = figures(begin, end, seconds, time.time() - began, loaded)
    result["contacts"] = int(data.ncon)
    result["engine"] = "MuJoCo " + mujoco.__version__
    result["warnings"] = [mujoco.mjtWarning(i).name for i, w in enumerate(data.warning) if w.number]
    return result


def run_mujoco_drive(folder, seconds):
    """The rover of the pile drives forwards for 5 s at least: its wheels are motors of velocity. It drives against pieces, and
    over them."""
    import mujoco
    model = mujoco.MjModel.from_xml_path(str(folder / "mjcf/pile.xml"))
    data = mujoco.MjData(model)
    base = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, "rover/base_link")
    mujoco.mj_forward(model, data)
    begin = tuple(data.xpos[base])
    highest = begin[2]
    pieces = {mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, link["name"]) for m in read_scene(folder / "mjcf")["models"]
              if not m["robot"] and len(m["links"]) == 1 for link in m["links"]}
    own = {b for b in range(model.nbody) if model.body_rootid[b] == base}
    touched = set()
    for a in range(model.nu):
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, a)
        if name.startswith("rover/"):
            data.ctrl[a] = 5.0  # unit: rad/s
    while data.time < max(seconds, 5):
        mujoco.mj_step(model, data)
        highest = max(highest, data.xpos[base][2])
        for contact in data.contact[:data.ncon]:
            one, other = model.geom_bodyid[contact.geom1], model.geom_bodyid[contact.geom2]
            if one in own or other in own:
                touched |= pieces & {int(one), int(other)}
    driven = math.dist(begin[:2], data.xpos[base][:2])
    assert driven > 0.5, f"the rover drove {driven} m"
    assert touched, "the rover met no piece"
    return {"engine": "MuJoCo " + mujoco.__version__, "robot": "rover", "driven_m": round(driven, 2), "climbed_m": round(highest - begin[2], 3), "met": len(touched),
            "pieces": sum(1 for _ in free_links(read_scene(folder / "mjcf")))}


def run_drake(folder, seconds):
    from pydrake.all import (AddMultibodyPlantSceneGraph, ContactModel, DiagramBuilder, Parser, SceneGraphConfig, Simulator)
    from importlib.metadata import version
    began = time.time()
    builder = DiagramBuilder()
    plant, scene_graph = AddMultibodyPlantSceneGraph(builder, time_step=0.002)
    # Contact by areas: by points, which is what a file without Drake's own elements gives, two pieces touch in one point,
    # and a slab turns about it.
    config = SceneGraphConfig()
    config.default_proximity_properties.compliance_type = "compliant"
    config.default_proximity_properties.hydroelastic_modulus = 1e8
    config.default_proximity_properties.hunt_crossley_dissipation = 10
    scene_graph.set_config(config)
    plant.set_contact_model(ContactModel.kHydroelasticWithFallback)
    Parser(builder).AddModels(str(folder / "sdf/pile.sdf"))
    plant.Finalize()
    diagram = builder.Build()
    simulator = Simulator(diagram)
    context = plant.GetMyContextFromRoot(simulator.get_mutable_context())
    loaded = time.time() - began
    bodies = {}
    for m, link in free_links(read_scene(folder / "sdf")):
        instance = plant.GetModelInstanceByName(m["name"]) if plant.HasModelInstanceNamed(m["name"]) else \
            plant.GetModelInstanceByName("rubble::" + m["name"])
        body = plant.GetBodyByName("link" if len(m["links"]) == 1 else link["name"], instance)
        assert abs(body.get_mass(context) - link["mass_kg"]) < 1e-6 * link["mass_kg"], link
        bodies[link["name"]] = body
        assert math.dist(plant.EvalBodyPoseInWorld(context, body).translation(), link["position_m"]) < 1e-6, link
    where = lambda: {n: tuple(plant.EvalBodyPoseInWorld(context, b).translation()) for n, b in bodies.items()}
    begin = where()
    began = time.time()
    simulator.Initialize()
    simulator.AdvanceTo(seconds)
    result = figures(begin, where(), seconds, time.time() - began, loaded)
    result["engine"] = "Drake " + version("drake")
    return result


def run_rapier(folder, seconds):
    """On a box as the ground: pieces slide off the endless plane, which Rapier has for that of the file. Friction of a pair is
    the mean in Rapier, not the larger one as in MuJoCo: the box has that of the pieces."""
    import rapier3d as r
    from rapier3d.loaders import mjcf
    began = time.time()
    scene = read_scene(folder / "mjcf")
    world = r.PhysicsWorld(gravity=(0, 0, -scene["gravity_m_s2"]))
    ground = world.rigid_bodies.insert(r.RigidBody.fixed().build())
    world.colliders.insert_with_parent(r.Collider.cuboid(100, 100, 1).translation((0, 0, -1)).friction(0.8).build(), ground, world.rigid_bodies)
    options = mjcf.MjcfLoaderOptions(mesh_converter=r.MeshConverter.CONVEX_HULL, skip_plane_geoms=True)
    robot, _ = mjcf.MjcfRobot.from_file(str(folder / "mjcf/pile.xml"), options)
    handles = robot.insert_using_multibody_joints(world.rigid_bodies, world.colliders, world.multibody_joints, world.impulse_joints)
    world.physics_hooks = handles.contact_hooks()
    bodies = {}
    for m, link in free_links(scene):
        name = link["name"] if len(m["links"]) == 1 else m["name"] + "/" + link["name"]
        bodies[link["name"]] = handles.bodies[handles.body_names.index(name)].body
        at = tuple(world.rigid_bodies[bodies[link["name"]]].translation)
        assert math.dist(at, link["position_m"]) < 1e-5, (name, at)
    loaded = time.time() - began

    def where(name):
        return tuple(world.rigid_bodies[bodies[name]].translation)
    begin = {name: where(name) for name in bodies}
    began = time.time()
    world.integration_parameters.dt = 1 / 240
    for _ in range(round(seconds * 240)):
        world.step()
    for _, link in free_links(scene):
        mass = world.rigid_bodies[bodies[link["name"]]].mass
        assert abs(mass - link["mass_kg"]) < 1e-4 * link["mass_kg"], (link["name"], mass, link["mass_kg"])
    result = figures(begin, {name: where(name) for name in bodies}, seconds, time.time() - began, loaded)
    result["engine"] = "Rapier " + r.__version__
    return result


def run_pybullet(folder, seconds):
    import pybullet as p
    from importlib.metadata import version
    began = time.time()
    p.connect(p.DIRECT)
    scene = read_scene(folder / "urdf")
    p.setGravity(0, 0, -scene["gravity_m_s2"])
    # Light bars under heavy slabs: many iterations and short steps, or pieces sink into each other and are thrown out.
    p.setPhysicsEngineParameter(numSolverIterations=200, fixedTimeStep=1 / 480, contactERP=0.1)
    plane = p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    p.changeDynamics(plane, -1, lateralFriction=math.sqrt(0.8))
    p.loadURDF(str(folder / "urdf/fixed.urdf"), useFixedBase=True, flags=p.URDF_USE_INERTIA_FROM_FILE)
    bodies, joints = {}, {}
    for model in scene["models"]:
        if model["file"] == "fixed.urdf" or model["robot"]:
            continue
        root = model["links"][0]
        w, x, y, z = root["quaternion_wxyz"]
        body = p.loadURDF(str(folder / "urdf" / model["file"]), root["position_m"], (x, y, z, w), useFixedBase=model["fixed"],
                          flags=p.URDF_USE_INERTIA_FROM_FILE)
        position = {j["name"]: j["position"] for j in model.get("joints", [])}
        for j in range(p.getNumJoints(body)):
            info = p.getJointInfo(body, j)
            if info[2] == p.JOINT_FIXED:
                continue
            p.resetJointState(body, j, position.get(info[1].decode(), 0.0))
            p.setJointMotorControl2(body, j, p.VELOCITY_CONTROL, force=0)  # without its default motor
        for i in range(-1, p.getNumJoints(body)):
            name = (p.getBodyInfo(body)[0] if i < 0 else p.getJointInfo(body, i)[12]).decode()
            joints[name] = (body, i)
        for link in model["links"][1 if model["fixed"] else 0:]:
            bodies[link["name"]] = joints[link["name"]]
            mass = p.getDynamicsInfo(*joints[link["name"]])[0]
            assert abs(mass - link["mass_kg"]) < 1e-5 * mass, (link, mass)
    loaded = time.time() - began

    def where(body, link):  # of the centre of mass
        return p.getBasePositionAndOrientation(body)[0] if link < 0 else p.getLinkState(body, link, computeForwardKinematics=1)[0]
    begin = {n: where(*b) for n, b in bodies.items()}
    began = time.time()
    for _ in range(round(seconds * 480)):
        p.stepSimulation()
    result = figures(begin, {n: where(*b) for n, b in bodies.items()}, seconds, time.time() - began, loaded)
    result["engine"] = "pybullet " + version("pybullet")
    return result


def run_newton(folder, seconds):
    import newton
    import warp as wp
    wp.config.quiet = True
    began = time.time()
    builder = newton.ModelBuilder()
    builder.add_usd(str(folder / "usd/pile.usda"))
    model = builder.finalize(device="cpu")
    loaded = time.time() - began
    labels = list(getattr(builder, "body_label", None) or builder.body_key)
    numbers = {label.rsplit("/", 1)[-1]: i for i, label in enumerate(labels)}
    links = [link for _, link in free_links(read_scene(folder / "usd"))]
    solver = newton.solvers.SolverXPBD(model, iterations=6)
    # Of links as the file has them: joints begin where they stand, which joint_q does not say of balls.
    state, other = model.state(), model.state()
    control = model.control()
    where = lambda: {l["name"]: tuple(map(float, state.body_q.numpy()[numbers[l["name"]]][:3])) for l in links}
    masses = model.body_mass.numpy()
    for link in links:
        assert abs(masses[numbers[link["name"]]] - link["mass_kg"]) < 1e-4 * link["mass_kg"], link
        assert math.dist(where()[link["name"]], link["position_m"]) < 1e-4, link
    begin = where()
    step = 1 / 960  # of 1 / 240, a sofa flies away
    pipeline = newton.CollisionPipeline(model)
    contacts = pipeline.contacts()
    for i in range(round(seconds / step)):
        if i == 1:
            began = time.time()  # the first step compiles the kernels
        state.clear_forces()
        pipeline.collide(state, contacts)
        solver.step(state, other, control, contacts, step)
        state, other = other, state
    result = figures(begin, where(), seconds, time.time() - began, loaded)
    result["engine"] = "Newton " + newton.__version__ + ", XPBD on the CPU"
    return result


def run_usd(folder, _seconds):
    from pxr import Usd, UsdGeom, UsdPhysics, UsdValidation
    began = time.time()
    stage = Usd.Stage.Open(str(folder / "usd/pile.usda"))
    registry = UsdValidation.ValidationRegistry()
    context = UsdValidation.ValidationContext(registry.GetOrLoadAllValidators())
    errors = [f"{e.GetName()}: {e.GetMessage()}" for e in context.Validate(stage)
              if e.GetType() != UsdValidation.ValidationErrorType.Info]
    found = UsdPhysics.LoadUsdPhysicsFromRange(stage, ["/"])
    counts = {str(kind).rsplit(".", 1)[-1]: len(paths) for kind, (paths, _) in found.items()}
    masses = {p.GetName(): UsdPhysics.MassAPI(p).GetMassAttr().Get() for p in stage.Traverse() if p.HasAPI(UsdPhysics.MassAPI)}
    for _, link in free_links(read_scene(folder / "usd")):
        assert abs(masses[link["name"]] - link["mass_kg"]) < 1e-5 * link["mass_kg"], link
    version = ".".join(map(str, Usd.GetVersion()))
    return {"engine": "OpenUSD " + version, "errors": errors, "counts": counts, "loaded_s": round(time.time() - began, 1),
            "up": str(UsdGeom.GetStageUpAxis(stage)), "pieces": len(masses)}


if __name__ == "__main__":
    engine, folder, seconds, result = sys.argv[1], Path(sys.argv[2]), float(sys.argv[3]), Result()
    result.write(globals()["run_" + engine](folder, seconds))
