"""What is varied, and the two sizes of the work: the whole of what was chosen is in this file."""
import collections

# mission: of scripts/paper; settings: --set of the program; images: what is done to the pictures before
# COLMAP sees them; dataset: whose pictures are used (default: its own).
Condition = collections.namedtuple("Condition", "name title mission settings images dataset")


def condition(name, title, mission, settings=(), images=None, dataset=None):
    return Condition(name, title, mission, tuple(settings), images, dataset or name)


AUTO = ("camera.exposure.mode=automatic",)
CONDITIONS = [
    condition("exterior", "exterior", "exterior"),
    condition("dark", "void, dark", "void_dark"),
    condition("dark_auto", "void, dark, camera with automatic exposure and noise", "void_dark", AUTO),
    condition("dark_clahe", "void, dark, CLAHE on the pictures", "void_dark", images="clahe", dataset="dark"),
    condition("lit_20", "void, lamp of 20 cd", "void_lit", ["lamp.intensity_cd=20"]),
    condition("lit", "void, lamp of 60 cd", "void_lit"),
    condition("lit_180", "void, lamp of 180 cd", "void_lit", ["lamp.intensity_cd=180"]),
    condition("lit_auto", "60 cd, camera with automatic exposure and noise", "void_lit", AUTO),
    condition("lit_clahe", "60 cd, CLAHE on the pictures", "void_lit", images="clahe", dataset="lit"),
    condition("lit_smoke", "60 cd, smoke of 0.3 / m", "void_lit", ["air.fog_density=0.3", "air.fog_noise=0.5"]),
    condition("lit_dust", "60 cd, dust plumes every 0.8 s", "void_lit",
              ["air.dust.period=0.8", "air.dust.position=-1.4,0,0.5", "air.dust.bounds=0.8,6,0.6"]),
    condition("lit_blur", "60 cd, automatic exposure, noise and motion blur", "void_lit",
              AUTO + ("camera.shutter.motion_blur=true", "camera.exposure.longest_time=0.033")),
]
# Daylight drowns a lamp (see docs/explanation/sfm.md), so its power counts at night alone, with a camera that has noise.
NIGHT = AUTO + ("light.intensity=0",)
CONDITIONS += [condition("night_%d" % power, "night, lamp of %d cd, automatic exposure and noise" % power, "void_lit",
                         NIGHT + ("lamp.intensity_cd=%d" % power,)) for power in (2, 20, 180)]
HARD = ["lit_smoke", "lit_dust", "night_20"]  # are drawn, too
PAPER = {  # Of the published table: images, segments, % on track, points.
    "exterior": (126, 1, 92.6, 79885),
    "dark": (88, 2, 65.9, 4776),
    "lit": (157, 3, 67.5, 40521),
}

# settings: of the camera and the path; features, matching: options of COLMAP, the same for all conditions.
Size = collections.namedtuple("Size", "settings features matching")
SIZES = {
    "full": Size((), ["--SiftExtraction.max_num_features", "8192"], ["--SequentialMatching.overlap", "10"]),
    "quick": Size(("camera.width=640", "camera.height=640", "trajectory.rate_hz=10"),
                  ["--SiftExtraction.max_num_features", "2048", "--SiftExtraction.first_octave", "0"],
                  ["--SequentialMatching.overlap", "6"]),
}


def find(names):
    known = {c.name: c for c in CONDITIONS}
    unknown = [n for n in names if n not in known]
    if unknown:
        raise SystemExit("no condition %s; there are %s" % (", ".join(unknown), ", ".join(known)))
    return [known[n] for n in names]
