#!/usr/bin/env python3
"""Writes a building of IFC or walls of DXF as a plan for rubble.read_plan: python -m rubble.import_plan house.ifc -o house.txt

IFC needs the package ifcopenshell, DXF ezdxf; both come by pip. Plans have walls along X and Y: --turn turns a building
that stands otherwise. What is left out is printed. Exit code 1: a file or an entity that cannot be taken, named.
"""
import argparse
import sys

if __package__:
    from .import_dxf import UNITS, DxfReader
    from .import_ifc import IfcReader
    from .plan_lines import Plan, PlanError
else:  # the files beside this one, where it is run by its path
    from import_dxf import UNITS, DxfReader  # type: ignore[import-not-found,no-redef,unused-ignore]
    from import_ifc import IfcReader  # type: ignore[import-not-found,no-redef,unused-ignore]
    from plan_lines import Plan, PlanError  # type: ignore[import-not-found,no-redef,unused-ignore]


def parse(arguments):
    parser = argparse.ArgumentParser(prog="rubble.import_plan", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("file", help="an IFC file (.ifc) or a drawing (.dxf)")
    parser.add_argument("-o", "--out", help="the plan; default: standard output")
    parser.add_argument("--turn", type=float, default=0, help="degrees by which the building is turned, counter-clockwise")
    dxf = parser.add_argument_group("DXF")
    of_drawings = [
        dxf.add_argument("--layer", action="append", help="a layer with walls; default: those with `wall` in their names"),
        dxf.add_argument("--unit", choices=UNITS, help="of the drawing, where it does not state one"),
        dxf.add_argument("--thickness", type=float, help="lines are axes of walls of this thickness (m); default: lines are faces"),
        dxf.add_argument("--thickest", type=float, default=0.65, help="largest distance of two faces of a wall (m); default: 0.65"),
        dxf.add_argument("--height", type=float, default=3.0, help="of a storey (m); default: 3"),
        dxf.add_argument("--storeys", type=int, default=1, help="that are alike; default: 1"),
        dxf.add_argument("--slab", type=float, default=0.0, help="thickness of a concrete floor over each storey (m); default: none"),
        dxf.add_argument("--material", choices=["concrete", "brick", "block", "timber"], default="brick", help="default: brick"),
    ]
    options = parser.parse_args(arguments)
    options.of_drawings = [f"--{action.dest}" for action in of_drawings if getattr(options, action.dest) != action.default]
    return options


def main(arguments=None):
    try:
        options = parse(arguments)
    except SystemExit as end:  # 2, that of argparse, is another code in all other commands
        return 1 if end.code else 0
    plan = Plan(options.file, options.turn)
    try:
        if options.file.lower().endswith(".dxf"):
            DxfReader(options.file, plan, options).read()
        elif options.file.lower().endswith(".ifc"):
            if options.of_drawings:
                raise PlanError(f"{options.file}: {', '.join(options.of_drawings)}: for drawings alone; IFC says so itself")
            IfcReader(options.file, plan).read()
        else:
            raise PlanError(f"{options.file}: expected .ifc or .dxf; export DWG as DXF")
        text = plan.text()
        if options.out:
            with open(options.out, "w", encoding="ascii") as out:
                out.write(text)
        else:
            sys.stdout.write(text)
    except (PlanError, OSError) as error:
        print(f"rubble.import_plan: {error}", file=sys.stderr)
        return 1
    except Exception as error:  # of a reader that trusts its file
        place = f"{options.file}: {plan.place}: " if plan.place else f"{options.file}: "
        print(f"rubble.import_plan: {place}cannot be taken: {type(error).__name__}: {' '.join(str(error).split())}", file=sys.stderr)
        return 1
    for note in plan.notes:
        print(f"{options.file}: left out: {note}", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
