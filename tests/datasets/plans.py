"""Houses of IFC and DXF, drawn here, as plans of rubble.import_plan: plans.py PROGRAM FOLDER"""
import subprocess
import sys
from pathlib import Path

import ezdxf
import ifcopenshell
import ifcopenshell.api.aggregate
import ifcopenshell.api.context
import ifcopenshell.api.feature
import ifcopenshell.api.geometry
import ifcopenshell.api.owner.settings
import ifcopenshell.api.project
import ifcopenshell.api.root
import ifcopenshell.api.spatial
import ifcopenshell.api.unit
import ifcopenshell.util.placement
import numpy as np

PROGRAM, FOLDER = sys.argv[1], Path(sys.argv[2])
TOOL = Path(__file__).resolve().parents[2] / "python" / "rubble" / "import_plan.py"


def need(condition, text, *values):
    if not condition:
        raise AssertionError(text % values if values else text)


def import_plan(file, *options, code=0):
    done = subprocess.run([sys.executable, TOOL, file, "-o", FOLDER / "plan.txt", *options], check=False, text=True, stderr=subprocess.PIPE)
    need(done.returncode == code, "%s: exit code %d, not %d: %s", file.name, done.returncode, code, done.stderr)
    return done.stderr if code else [line.split() for line in (FOLDER / "plan.txt").read_text(encoding="ascii").splitlines()]


def check_in_rubble():
    """The program takes the plan, and finds the house standing by its rules of drawing."""
    (FOLDER / "house.lua").write_text('return rubble.mission { pile = rubble.building { plan = rubble.read_plan("plan.txt") } }\n', encoding="ascii")
    done = subprocess.run([PROGRAM, "check", FOLDER / "house.lua"], check=False, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    need(done.returncode == 0, "rubble check: %s", done.stderr)


class House:
    """Two storeys of 8 by 5 m in millimetres, turned by some degrees."""

    def __init__(self, turn=0.0, schema="IFC4"):
        self.model = ifcopenshell.api.project.create_file(version=schema)
        if schema == "IFC2X3":  # everything has an owner
            person = self.model.createIfcPerson(FamilyName="p")
            owner = self.model.createIfcPersonAndOrganization(person, self.model.createIfcOrganization(Name="o"))
            application = self.model.createIfcApplication(owner.TheOrganization, "1", "a", "a")
            ifcopenshell.api.owner.settings.get_user = lambda file: owner
            ifcopenshell.api.owner.settings.get_application = lambda file: application
        project = ifcopenshell.api.root.create_entity(self.model, ifc_class="IfcProject", name="p")
        ifcopenshell.api.unit.assign_unit(self.model)  # millimetres
        model = ifcopenshell.api.context.add_context(self.model, context_type="Model")
        self.body = ifcopenshell.api.context.add_context(
            self.model, context_type="Model", context_identifier="Body", target_view="MODEL_VIEW", parent=model)
        self.turn = np.radians(turn)
        building = ifcopenshell.api.root.create_entity(self.model, ifc_class="IfcBuilding", name="b")
        ifcopenshell.api.aggregate.assign_object(self.model, products=[building], relating_object=project)
        self.storeys = []
        for name, level in (("ground", 0), ("upper", 3000), ("roof", 5800)):
            storey = ifcopenshell.api.root.create_entity(self.model, ifc_class="IfcBuildingStorey", name=name)
            storey.Elevation = float(level)
            ifcopenshell.api.aggregate.assign_object(self.model, products=[storey], relating_object=building)
            self.storeys.append(storey)

    def frame(self, x, y, z, angle):
        c, s = np.cos(angle + self.turn), np.sin(angle + self.turn)
        ct, st = np.cos(self.turn), np.sin(self.turn)
        return np.array([[c, -s, 0, ct * x - st * y], [s, c, 0, st * x + ct * y], [0, 0, 1, z], [0, 0, 0, 1.0]])

    def add(self, kind, name, storey, frame, size):
        """A box from the frame's origin, of a size in metres; its Y is centred."""
        entity = ifcopenshell.api.root.create_entity(self.model, ifc_class=kind, name=name)
        builder = self.model
        x, y, z = (1000 * v for v in size)
        origin = builder.createIfcAxis2Placement2D(builder.createIfcCartesianPoint((x / 2, 0.0)))
        profile = builder.createIfcRectangleProfileDef("AREA", None, origin, x, y)
        solid = builder.createIfcExtrudedAreaSolid(profile, builder.createIfcAxis2Placement3D(builder.createIfcCartesianPoint((0.0, 0.0, 0.0))),
                                                   builder.createIfcDirection((0.0, 0.0, 1.0)), z)
        shape = builder.createIfcShapeRepresentation(self.body, "Body", "SweptSolid", [solid])
        ifcopenshell.api.geometry.assign_representation(self.model, product=entity, representation=shape)
        ifcopenshell.api.geometry.edit_object_placement(self.model, product=entity, matrix=frame, is_si=True)
        if storey is not None:
            ifcopenshell.api.spatial.assign_container(self.model, products=[entity], relating_structure=self.storeys[storey])
        return entity

    def build(self):
        quarter = np.pi / 2
        for storey, (floor, height) in enumerate(((0, 3.0), (3.0, 2.8))):
            street = self.add("IfcWall", "street brick", storey, self.frame(0, 0, floor, 0), (8, 0.24, height))
            self.add("IfcWall", "garden", storey, self.frame(8, 5, floor, np.pi), (8, 0.24, height))
            self.add("IfcWall", "west", storey, self.frame(0, 0, floor, quarter), (5, 0.3, height))
            self.add("IfcWall", "Beton east", storey, self.frame(8, 0, floor, quarter), (5, 0.3, height))
            sill = floor + 0.9 if storey else floor
            opening = self.add("IfcOpeningElement", "o", None, self.frame(2, 0, sill, 0), (1.2, 0.5, 1.3))
            ifcopenshell.api.feature.add_feature(self.model, feature=opening, element=street)
            self.add("IfcSlab", "floor", storey, self.frame(0, 2.5, floor + height - 0.2, 0), (8, 5, 0.2))
        self.add("IfcColumn", "concrete c", 0, self.frame(4, 2.5, 0, 0), (0.4, 0.4, 2.8))
        return self

    def save(self, name):
        self.model.write(str(FOLDER / name))
        return FOLDER / name


def ifc_houses_become_plans():
    for turn, schema in ((0, "IFC4"), (30, "IFC4"), (-12.5, "IFC2X3")):
        plan = import_plan(House(turn, schema).build().save("house.ifc"), "--turn", str(-turn))
        need([line[1] for line in plan if line[0] == "storey"] == ["3", "2.8"], "storeys %s", plan)
        walls = [line for line in plan if line[0] == "wall"]
        need(len(walls) == 8, "%d walls", len(walls))
        need(walls[0] == "wall 0 0 8 0 0.24 brick name=street_brick".split(), "first wall %s", walls[0])
        need("concrete" in walls[3] and walls[3][1:6] == "8 0 8 5 0.3".split(), "east %s", walls[3])
        need([line for line in plan if line[0] == "door"] == ["door 2 0 3.2 0 1.3".split()], "door %s", plan)
        need([line for line in plan if line[0] == "window"] == ["window 2 0 3.2 0 0.9 2.2".split()], "window %s", plan)
        need([line for line in plan if line[0] == "slab"] == 2 * ["slab 0 0 8 5 0.2 concrete".split()], "slabs %s", plan)
        need([line for line in plan if line[0] == "column"] == ["column 4.2 2.5 0.4 0.4 concrete".split()], "column %s", plan)
        check_in_rubble()


def what_plans_lack_is_named():
    """A hill of 100 m, a wall of two storeys with a window in each, a parapet, a floor with a stairwell and an L, a stair, a sofa."""
    house = House().build()
    for storey, level in zip(house.storeys, (100, 103, 105.8)):
        storey.Elevation = None  # placements alone
        ifcopenshell.api.geometry.edit_object_placement(house.model, product=storey, matrix=house.frame(0, 0, level, 0), is_si=True)
    for kind in ("IfcWall", "IfcColumn", "IfcSlab", "IfcOpeningElement"):
        for entity in house.model.by_type(kind):
            frame = ifcopenshell.util.placement.get_local_placement(entity.ObjectPlacement)
            frame[:3, 3] /= 1000
            frame[2, 3] += 100
            ifcopenshell.api.geometry.edit_object_placement(house.model, product=entity, matrix=frame, is_si=True)
    high = house.add("IfcWall", "high", 0, house.frame(0, 2.5, 100, 0), (8, 0.2, 5.8))
    for sill in (101, 104):
        opening = house.add("IfcOpeningElement", "o", None, house.frame(5, 2.5, sill, 0), (1, 0.5, 1))
        ifcopenshell.api.feature.add_feature(house.model, feature=opening, element=high)
        window = house.add("IfcWindow", "w", 0, house.frame(5, 2.5, sill, 0), (1, 0.1, 1))
        ifcopenshell.api.feature.add_filling(house.model, opening=opening, element=window)
    house.add("IfcWall", "parapet", 1, house.frame(1, 1, 103, 0), (2, 0.2, 1.0))
    floor = house.model.by_type("IfcSlab")[0]
    well = house.add("IfcOpeningElement", "well", None, house.frame(1, 1, 102.7, 0), (1, 2, 0.5))
    ifcopenshell.api.feature.add_feature(house.model, feature=well, element=floor)
    house.add("IfcStair", "stair", 0, house.frame(1, 1, 100, 0), (1, 2, 2))
    house.add("IfcFurniture", "sofa", 0, house.frame(1, 1, 100, 0), (1, 2, 1))
    house.add("IfcBeam", "low beam", 0, house.frame(1, 1, 101, 0), (3, 0.2, 0.4))
    column = house.add("IfcColumn", "round", 0, house.frame(6, 1, 100, 0), (0.4, 0.4, 3))
    solid = column.Representation.Representations[0].Items[0]
    solid.SweptArea = house.model.createIfcCircleProfileDef("AREA", None, solid.SweptArea.Position, 200.0)
    done = subprocess.run([sys.executable, TOOL, house.save("more.ifc"), "-o", FOLDER / "plan.txt"], check=False, text=True, stderr=subprocess.PIPE)
    need(done.returncode == 0, "%s", done.stderr)
    plan = [line.split() for line in (FOLDER / "plan.txt").read_text(encoding="ascii").splitlines()]
    for note in ("IfcWall parapet: is 1.00 m high", "1 IfcStair", "1 IfcFurniture", "IfcBeam low beam: its height of 1.40 m",
                 "IfcColumn round: its shape, which fills 7"):
        need(note in done.stderr, "%s in %s", note, done.stderr)
    need("IfcWindow" not in done.stderr, "windows are those of openings: %s", done.stderr)
    need([line[1] for line in plan if line[0] == "storey"] == ["3", "2.8"], "storeys on a hill: %s", plan)
    need(len([line for line in plan if "name=high" in line]) == 2 and not [line for line in plan if "name=parapet" in line], "walls %s", plan)
    need([line for line in plan if line[:2] == ["window", "5"]] == ["window 5 2.5 6 2.5 1 2".split()] * 2, "windows %s", plan)
    need([line for line in plan if line[0] == "hole"] == ["hole 1 0 2 2".split()], "the stairwell %s", plan)
    check_in_rubble()
    need("--height, --storeys: for drawings alone" in import_plan(FOLDER / "more.ifc", "--height", "4", "--storeys", "2", code=1), "options of DXF")


def ifc_mistakes_are_named():
    house = House(30).build().save("turned.ifc")
    error = import_plan(house, code=1)
    need("turned.ifc: #" in error and "IfcWall street brick: is turned by 30.00 degrees" in error and "--turn -30" in error, "%s", error)
    text = house.read_text(encoding="ascii")
    house.write_text(text[:len(text) // 2], encoding="ascii")
    need("turned.ifc" in import_plan(house, code=1), "a torn file")
    (FOLDER / "no.ifc").write_text("<ifcXML/>", encoding="ascii")
    need("no.ifc:1: is no IFC file" in import_plan(FOLDER / "no.ifc", code=1), "XML")
    empty = House().save("empty.ifc")
    need("no storey has a wall" in import_plan(empty, code=1), "an empty house")


def drawing(unit=4):
    document = ezdxf.new("R2010")
    document.units = unit
    document.layers.add("A-WALL")
    document.layers.add("furniture")
    return document, document.modelspace()


def save(document, name):
    document.saveas(FOLDER / name)
    return FOLDER / name


def dxf_walls_become_plans():
    # Faces of a room in millimetres: outside and inside outlines, and a thin closed rectangle within.
    document, space = drawing()
    for low, high_x, high_y in ((0, 8000, 5000), (240, 7760, 4760)):
        space.add_lwpolyline([(low, low), (high_x, low), (high_x, high_y), (low, high_y)], close=True, dxfattribs={"layer": "A-WALL"})
    space.add_lwpolyline([(3940, 240), (4060, 240), (4060, 4760), (3940, 4760)], close=True, dxfattribs={"layer": "A-WALL"})
    space.add_line((0, 0), (100, 333), dxfattribs={"layer": "furniture"})
    plan = import_plan(save(document, "room.dxf"), "--storeys", "2", "--slab", "0.2", "--height", "2.75")
    walls = sorted(line[1:6] for line in plan if line[0] == "wall")
    need(len(walls) == 10 and len([line for line in plan if line[0] == "slab"]) == 2, "%s", plan)
    need(walls[-1] == "7.88 0.24 7.88 4.76 0.24".split() and "4 0.24 4 4.76 0.12".split() in walls, "%s", walls)
    check_in_rubble()
    # Axes in feet, without a unit in the file.
    document, space = drawing(0)
    for a, b in (((0, 0), (20, 0)), ((20, 0), (20, 10)), ((20, 10), (0, 10)), ((0, 10), (0, 0))):
        space.add_line(a, b, dxfattribs={"layer": "outline"})
    axes = save(document, "axes.dxf")
    need("$INSUNITS" in import_plan(axes, code=1), "no unit")
    need("no layer of walls: give --layer, one of outline" in import_plan(axes, "--unit", "ft", code=1), "no layer")
    plan = import_plan(axes, "--unit", "ft", "--layer", "outline", "--thickness", "0.3")
    need("wall 0 0 6.096 0 0.3 brick".split() in plan, "%s", plan)


def dxf_mistakes_are_named():
    document, space = drawing()
    line = space.add_line((0, 0), (4000, 0), dxfattribs={"layer": "A-WALL"})
    error = import_plan(save(document, "alone.dxf"), code=1)
    need(f"alone.dxf: LINE #{line.dxf.handle} on layer A-WALL: the face from 0.000 to 4.000" in error, "%s", error)
    document, space = drawing()
    space.add_line((0, 0), (4000, 700), dxfattribs={"layer": "A-WALL"})
    need("is turned by 9.93 degrees" in import_plan(save(document, "skew.dxf"), "--thickness", "0.2", code=1), "a skew wall")
    document, space = drawing()
    space.add_lwpolyline([(0, 0, 0.5), (4000, 0, 0)], format="xyb", dxfattribs={"layer": "A-WALL"})
    need("has arcs" in import_plan(save(document, "arc.dxf"), code=1), "an arc")
    (FOLDER / "torn.dxf").write_text("0\nSECTION\n2\nENTITIES\n0\nLINE\n10\nnot", encoding="ascii")
    need("torn.dxf" in import_plan(FOLDER / "torn.dxf", code=1), "a torn drawing")
    need("expected .ifc or .dxf" in import_plan(FOLDER / "house.dwg", code=1), "another format")


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    for check in (ifc_houses_become_plans, what_plans_lack_is_named, ifc_mistakes_are_named, dxf_walls_become_plans, dxf_mistakes_are_named):
        check()
        print("right:", check.__name__)


if __name__ == "__main__":
    main()
