"""Piles, flights and recordings of scripts/demonstration.lua."""
import pathlib
import shutil

import carriers
import plan
import work as stages

HERE = pathlib.Path(__file__).resolve().parent
OFF = ["rawlog", "simplemap", "bag", "stl"]  # that are recorded by default


def words(settings):
    return [word for setting in settings for word in ("--set", setting)]


def last_of_each(settings):
    """Without those whose key a later one sets."""
    return list({setting.split("=")[0]: setting for setting in settings}.values())


SHOWN = (0.03, 0.12, 0.25, 0.38, 0.49)  # frames that the documents show, as shares of a flight that turns back in its middle


def shown_frames(dataset):
    """Their files; kept for good before the pictures are cleared away."""
    kept, images = dataset.parent / "shown", sorted((dataset / "colmap" / "images").glob("*"))
    if images:
        kept.mkdir(exist_ok=True)
        for i, share in enumerate(SHOWN):
            source = images[int(share * len(images))]
            shutil.copy(source, kept / ("%d%s" % (i, source.suffix)))
    return sorted(kept.glob("*"))


def clear(dataset, size):
    shown_frames(dataset)
    for name in size.heavy:
        path = dataset / name
        shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)


class Flights:
    def __init__(self, work, size):
        self.work, self.size = work, size
        self.base = {"program": work.identity, "mission": stages.digest_file(stages.MISSION)}

    def pile(self, seed, settings=()):
        """settings: of a row; those of fines are the pile's."""
        settings = last_of_each([*self.size.pile, *(s for s in settings if s.startswith("fines."))])
        depends = dict(self.base, seed=seed, settings=settings)
        return self.work.stage("pile", depends, lambda folder: self.work.run(
            [self.work.program, "settle", stages.MISSION, *words(settings), "--seed", seed, "--out", folder / "run", "--quiet"],
            folder / "log.txt"), "seed %d" % seed) / "run"

    def planned(self, seed):
        """A dataset of the planned way, with tiny pictures: for motions that are added to it, and for what depends on where it goes."""
        settings = [*self.size.pile, "flight=inside", *plan.TINY]
        depends = dict(self.base, seed=seed, settings=settings)
        return self.work.stage("planned", depends, lambda folder: self.render(folder, seed, stages.MISSION, settings, ()),
                               "seed %d" % seed) / "run"

    def deepest(self, seed, row):
        return carriers.way_in(self.planned(seed)) if "flight=inside" in row.settings else None

    def depends(self, seed, row):
        added = [stages.digest_file(HERE / name) for name in ("carriers.py", "carrier.lua")]
        return dict(self.base, seed=seed, settings=self.settings(row), outputs=self.size.outputs, dust=row.name == "dust",
                    carrier=row.carrier, added=added if "flight=inside" in row.settings else [])

    def settings(self, row):
        return last_of_each([*self.size.pile, *row.settings, *self.size.camera])

    def key(self, seed, row):
        return stages.digest("flight", self.depends(seed, row))

    def dataset(self, seed, row):
        """The recording of a row; made again where its pictures were cleared away. All flights into the ruin follow the one way
        that was planned, so that only what the row names differs."""
        def make(folder):
            settings, mission = self.settings(row), stages.MISSION
            if row.name == "dust":
                settings += carriers.dust_around(self.planned(seed))
            if "flight=inside" in settings:
                mission = folder / stages.MISSION.name
                shutil.copy(stages.MISSION, mission)
                (folder / "track.txt").write_text(carriers.move(self.work, self.planned(seed), row.carrier))
                settings = ["flight=track" if s == "flight=inside" else s for s in settings]
            self.render(folder, seed, mission, settings, self.size.outputs)

        run = self.work.out / "flight" / self.key(seed, row) / "run"
        if not all((run / name).exists() for name in self.size.heavy):
            (run.parent / "done.json").unlink(missing_ok=True)
        return self.work.stage("flight", self.depends(seed, row), make, "seed %d, %s" % (seed, row.name)) / "run"

    def render(self, folder, seed, mission, settings, outputs):
        outputs = ["outputs.%s=false" % name for name in OFF if name not in outputs] + ["outputs.%s=true" % name for name in outputs]
        self.work.run([self.work.program, "render", self.pile(seed, settings), "--mission", mission, "--seed", seed, *words(settings),
                       *words(outputs), "--out", folder / "run", "--quiet"], folder / "log.txt")
