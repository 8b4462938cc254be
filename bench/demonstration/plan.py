"""What the demonstration varies, and in which order: the base case, and one factor changed at a time."""
import collections

# settings: --set of scripts/demonstration.lua. carrier: whose motion is added to the planned way (carriers.py).
# calibrated: whether the judge gets the true intrinsics. seeds: how many of the seeds.
Row = collections.namedtuple("Row", "name group title settings carrier calibrated seeds")


def row(name, group, title, *settings, carrier="spline", calibrated=True, seeds=2):
    return Row(name, group, title, settings, carrier, calibrated, seeds)


INSIDE = ("flight=inside",)


def lamp(candela):
    return INSIDE + ("lamp.on=true", "lamp.intensity_cd=%d" % candela)


NIGHT = ("light.elevation_deg=-18",)
# Luminous intensities of lamps that robots carry. A beam distance of ANSI/PLATO FL 1 (0.25 lx) is 2 sqrt(I).
BASE = lamp(15)
ROWS = [
    row("exterior", "paper", "outside, by day", "flight=outside", seeds=5),
    row("dark", "paper", "void, no lamp, day outside", *INSIDE, seeds=5),
    row("lamp_15", "paper", "void, lamp of 15 cd", *BASE, seeds=5),
    row("lamp_200", "light", "lamp of 200 cd", *lamp(200), seeds=5),
    row("lamp_5", "light", "lamp of 5 cd", *lamp(5), seeds=5),
    row("night", "light", "no lamp, night outside", *INSIDE, *NIGHT),
    row("night_15", "light", "night, lamp of 15 cd", *BASE, *NIGHT),
    row("night_200", "light", "night, lamp of 200 cd", *lamp(200), *NIGHT),
    row("ideal", "camera", "ideal camera: no noise, blur or lag", *BASE, "camera.exposure.mode=ideal",
        "camera.optics.point_spread=0", "camera.sensor.prnu=0", "camera.sensor.jpeg_quality=0",
        "camera.shutter.motion_blur=false"),
    row("at_once", "camera", "exposure without delay", *BASE, "camera.exposure.time_constant=0", "camera.exposure.delay=0"),
    row("sharp", "camera", "no motion blur", *BASE, "camera.shutter.motion_blur=false"),
    row("uncalibrated", "camera", "focal length unknown to the judge", *BASE, calibrated=False),
    row("smoke", "air", "smoke of 0.3 / m", *BASE, "air.fog_density=0.3", "air.fog_noise=0.5"),
    row("dust", "air", "dust that the robot raises", *BASE, "air.dust.period=0.5", "air.dust.density=2"),
    row("wet", "air", "wet surfaces", *BASE, "wetness=0.8"),
    row("bare", "air", "no fines", *BASE, "fines.amount=0"),
    row("street", "place", "outside, in a street", "flight=outside", "surroundings.type=street", "surroundings.clearance=6"),
    row("crawler", "motion", "moved as a crawler", *BASE, carrier="crawler"),
    row("snake", "motion", "moved as a snake", *BASE, carrier="snake"),
    row("vine", "motion", "moved as a vine", *BASE, carrier="vine"),
    row("hand_held", "motion", "moved as by hand", *BASE, carrier="hand_held"),
]
PUBLISHED = {  # images, segments, % on track, points
    "exterior": (126, 1, 92.6, 79885), "dark": (88, 2, 65.9, 4776), "lamp_15": (157, 3, 67.5, 40521)}

# pile: --set for the pile and every flight. camera: of flights alone. outputs: what is recorded besides the truth. heavy: what of
# it goes when all judges have seen it.
Size = collections.namedtuple("Size", "title pile camera outputs heavy", defaults=(("colmap",), ("colmap/images",)))
SIZES = {
    "full": Size("1024x1024, every frame, 3,770 pieces", (), ()),
    "small": Size("640x480, 5 frames a second, 1,570 pieces", ("bricks=600", "fines.amount=15000"),
                  ("camera.width=640", "camera.height=480", "trajectory.rate_hz=5")),
}
# Pictures of a flight of which only the way matters. They are path-traced, because no light is baked for these.
TINY = ("camera.width=32", "camera.height=32", "camera.quality=reference", "camera.samples=1", "camera.exposure.mode=ideal",
        "camera.optics.point_spread=0", "camera.sensor.prnu=0", "camera.sensor.jpeg_quality=0", "camera.shutter.motion_blur=false",
        "trajectory.rate_hz=20")
# incremental, global: COLMAP's two mappers.
JUDGES = ("colmap", "pycolmap_incremental", "pycolmap_global")


def order(seeds, rows):
    """Every row of the first seed, then of the second: whoever stops it early has all rows."""
    return [(seed, r) for seed in seeds for r in ROWS if seed <= r.seeds and (not rows or r.name in rows)]
