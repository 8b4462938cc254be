"""Pairs of levels that cannot be in one mission: those that the program refuses, each with words of its message, and those
that mean nothing because one level leaves out what the other is about."""
from factors import FACTORS


def but(factor, *left_out):
    """All levels of a factor, but some."""
    return [level for level in FACTORS[factor] if level not in left_out]


ONE_WITH_ODOMETRY = ("crawler", "rover", "cart", "team")

# (factor, levels, other factor, its levels, words of the message that the program must give)
REFUSED = [
    ("path", ["ride", "links"], "record_settling", ["all", "window"], "every camera is on a robot"),
    ("robots", ["none"], "path", ["ride", "links"], "no robot has this name"),
    ("robots", but("robots", *ONE_WITH_ODOMETRY), "rawlog", ["actions"], "actions need one robot with odometry"),
    ("start", ["after_2038"], "ros2", ["mcap"], "19 January 2038"),
    ("shutter", ["blur"], "exposure", ["ideal"], "an ideal image has no exposure time"),
    ("quality", ["reference"], "exposure", ["automatic"], "path tracing samples the pixel already"),
    ("surroundings", ["street"], "terrain", but("terrain", "none"), "the surroundings have their own ground"),
    ("victims", ["one"], "record_settling", ["all", "window"], "victims are placed after the pile has settled"),
    ("victims", ["one"], "track", ["on"], "victims are placed after the pile has settled"),
    ("lidar", ["none"], "scans", but("scans", "none"), "a mission with `lidars`"),
]

# (factor, levels, other factor, its levels, why)
MEANINGLESS = [
    ("building", ["none"], "cause", but("cause", "none"), "no building that a cause could bring down"),
    ("robots", ["none"], "control", but("control", "still"), "no robot to command"),
    ("robots", ["none"], "debris", ["fixed"], "no robot that could move debris"),
    ("robots", ["none"], "lamp", ["robot"], "no robot to carry a lamp"),
    ("lidar", ["none"], "control", ["senses"], "nothing to sense"),
]


def expand(rules):
    """(factor, level), (other, level) -> the text of the rule."""
    order = list(FACTORS)
    found = {}
    for a, a_levels, b, b_levels, text in rules:
        for x in a_levels:
            for y in b_levels:
                pair = sorted([(a, x), (b, y)], key=lambda item: order.index(item[0]))
                found[tuple(pair)] = text
    return found
