#!/usr/bin/env python3
"""Writes the meshes of a USD or MJCF file as a pack of assets: python -m rubble.import_pack scene.usd -o my_pack

USD needs the package usd-core, MJCF mujoco; both come by pip. Each mesh becomes an OBJ file and an asset with its name, its
colours, its pictures and its mass; equal ones become one. The pack is checked by `rubble assets check my_pack`. What is left
out is printed. Exit code 1: a file or a mesh that cannot be taken, named.
"""
import argparse
import math
import sys
from pathlib import Path

if __package__:
    from .import_asset import Notes, PackError, volume
    from .import_mjcf import MjcfReader
    from .import_usd import UsdReader
else:  # the files beside this one, where it is run by its path
    from import_asset import Notes, PackError, volume  # type: ignore[import-not-found,no-redef,unused-ignore]
    from import_mjcf import MjcfReader  # type: ignore[import-not-found,no-redef,unused-ignore]
    from import_usd import UsdReader  # type: ignore[import-not-found,no-redef,unused-ignore]

USD = (".usd", ".usda", ".usdc", ".usdz")
LIGHTEST, HEAVIEST = 10, 25000  # of an asset of a pack; unit: kg/m3
FARTHEST = 1e5  # of a corner from the origin; unit: m


def word(name):
    """A name of an asset: letters, digits and underscores."""
    text = "".join(letter.lower() if letter.isascii() and letter.isalnum() else "_" for letter in name).strip("_")
    return text if text and not text[0].isdigit() else "mesh_" + text


def checked(path, assets):
    """The assets, or an error that names the mesh whose corner, colour or mass is no number."""
    for asset in assets:
        where = f"{path}: {asset.name}"
        for i, corner in enumerate(asset.vertices):
            if not all(abs(x) < FARTHEST for x in corner):
                raise PackError(f"{where}: corner {i} is at {', '.join(f'{x:g}' for x in corner)} m: expected numbers within {FARTHEST:g}")
        if not all(abs(x) < FARTHEST for place in asset.corners for x in place):
            raise PackError(f"{where}: a texture coordinate is no number within {FARTHEST:g}")
        for look in asset.looks:
            if look.colour and not all(0 <= c < math.inf for c in look.colour):
                raise PackError(f"{where}: its colour is {', '.join(f'{c:g}' for c in look.colour)}: expected numbers from 0 to 1")
            for name, value in (("metallic", look.metal), ("roughness", look.roughness)):
                if value is not None and not 0 <= value <= 1:
                    raise PackError(f"{where}: its {name} is {value:g}: expected a number from 0 to 1")
            if look.placed and not all(abs(x) < FARTHEST for x in look.placed):
                raise PackError(f"{where}: the scale or offset of its picture is no number within {FARTHEST:g}")
        for value, unit in ((asset.mass, "mass"), (asset.density, "density")):
            if value is not None and not 0 < value < math.inf:
                raise PackError(f"{where}: its {unit} is {value:g}: expected a number above 0")
        yield asset


def weigh(assets, notes):
    """Turns masses into densities. What shares a mass is of one density."""
    spaces = [volume(asset.vertices, asset.faces) for asset in assets]
    shared = {}
    for asset, space in zip(assets, spaces):
        if asset.mass is not None:
            shared[asset.shares] = shared.get(asset.shares, 0) + space
    for asset in assets:
        if asset.mass is None:
            continue
        if shared[asset.shares] > 1e-9:
            asset.density = asset.mass / shared[asset.shares]
        else:
            notes.add(f"{asset.name}: its mass, because it encloses no space")
    for asset in assets:
        if asset.density is not None and not LIGHTEST <= asset.density <= HEAVIEST:
            notes.add(f"{asset.name}: its density of {asset.density:.3g} kg/m3: expected {LIGHTEST} to {HEAVIEST}")
            asset.density = None


def single(assets, notes):
    """Each once: a stage may hold the same brick a hundred times."""
    first = {}
    for asset in assets:
        equal = first.setdefault(asset.key(), asset)
        if equal is asset:
            yield asset
        else:
            notes.add(f"a mesh that equals {equal.name}")


def write_look(folder, stem, number, look):
    """The lines of MTL; pictures become files."""
    lines = [f"newmtl surface_{number}"]
    colour = look.colour or ((1, 1, 1) if look.picture else (0.5, 0.5, 0.5))
    lines.append("Kd %.6f %.6f %.6f" % tuple(min(c, 1) for c in colour))
    lines += [f"{key} {value:.6f}" for key, value in (("Pm", look.metal), ("Pr", look.roughness)) if value is not None]
    placed = "-s %.9g %.9g 1 -o %.9g %.9g 0 " % look.placed if look.placed else ""
    for key, picture in (("map_Kd", look.picture), ("norm", look.bumps)):
        if picture:
            name = f"{stem}_{number}_{'colour' if key == 'map_Kd' else 'normal'}{picture[0]}"
            (folder / name).write_bytes(picture[1])
            lines.append(f"{key} {placed}{name}")
    return lines


def write_obj(path, asset):
    lines = [f"# From {' '.join(asset.name.split())} by rubble.import_pack"]
    is_plain = all(look.key() == (None,) * 6 for look in asset.looks)
    if not is_plain:
        library = [line for i, look in enumerate(asset.looks) for line in write_look(path.parent, path.stem, i, look)]
        path.with_suffix(".mtl").write_text("\n".join(library) + "\n", encoding="ascii")
        lines.append(f"mtllib {path.stem}.mtl")
    lines += ["v %.9g %.9g %.9g" % v for v in asset.vertices]
    lines += ["vt %.9g %.9g" % place for place in asset.corners]
    corner, current = 0, None
    for face, look in zip(asset.faces, asset.look_of):
        if look != current and not is_plain:
            lines.append(f"usemtl surface_{look}")
            current = look
        lines.append("f " + " ".join(f"{v + 1}/{corner + i + 1}" if asset.corners else str(v + 1) for i, v in enumerate(face)))
        corner += len(face)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_pack(folder, assets, options):
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
        entries.append(entry + (f", density = {asset.density:.6g}" if asset.density is not None else "") + " },")
    text = f"-- From {options.file.name} by rubble.import_pack.\nreturn pack {{\n  name = \"{word(options.name or folder.name)}\",\n  assets = {{\n"
    whole = folder / "pack.lua.part"
    whole.write_text(text + "\n".join(entries) + "\n  },\n}\n", encoding="utf-8")
    whole.replace(folder / "pack.lua")


def main(arguments=None):
    parser = argparse.ArgumentParser(prog="rubble.import_pack", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("file", type=Path, help="USD (.usd, .usda, .usdc, .usdz) or MJCF (.xml)")
    parser.add_argument("-o", "--out", type=Path, required=True, help="the folder of the pack")
    parser.add_argument("--name", help="of the pack; default: that of the folder")
    parser.add_argument("--material", default="reinforced_concrete", help="of all assets; default: reinforced_concrete")
    parser.add_argument("--force", action="store_true", help="replace a pack that is there")
    notes = Notes()
    try:
        options = parser.parse_args(arguments)
    except SystemExit as end:  # 2, that of argparse, is another code in all other commands
        return 1 if end.code else 0
    try:
        if not options.file.is_file():
            raise PackError(f"{options.file}: no such file")
        if options.file.suffix.lower() in USD:
            reader = UsdReader(options.file, notes)
        elif options.file.suffix.lower() == ".xml":
            reader = MjcfReader(options.file, notes)
        else:
            raise PackError(f"{options.file}: expected {', '.join(USD)} or .xml")
        assets = list(checked(options.file, reader.read()))
        weigh(assets, notes)
        assets = list(single(assets, notes))
        if not assets:
            raise PackError("; left out: ".join([f"{options.file}: has no mesh", *notes.lines()]))
        write_pack(options.out, assets, options)
    except (PackError, OSError) as error:
        print(f"rubble.import_pack: {error}", file=sys.stderr)
        return 1
    except Exception as error:  # of a reader that trusts its file
        print(f"rubble.import_pack: {options.file}: cannot be taken: {type(error).__name__}: {' '.join(str(error).split())}", file=sys.stderr)
        return 1
    for note in notes.lines():
        print(f"{options.file}: left out: {note}", file=sys.stderr)
    print(f"{options.out}: {len(assets)} assets; check them with `rubble assets check {options.out}`")
    return 0


if __name__ == "__main__":
    sys.exit(main())
