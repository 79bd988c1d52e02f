"""Renders a scene with Radiance: mkpmap makes a global and a caustic photon map, rpict gathers through one bounce."""

import json
import math
import os
import subprocess
import tempfile

import budget

# One path a pixel; one ambient bounce, whose ends look the photons up; no ambient cache, no approximations of shadows.
GATHER = "-pa 1 -pj 1 -ps 1 -ab 1 -aa 0 -ds 0.15 -dj 1 -dt 0 -dc 1 -lr -16 -lw 1e-4".split()

# Photons an estimate takes.
BANDWIDTH = "50"

# The picture is made in bands, so that the rays of the later ones can follow what the first ones cost.
BANDS = 8


def tool(name, *arguments, **streams):
    import pyradiance

    folder = os.path.dirname(pyradiance.__file__)
    environment = dict(os.environ, RAYPATH=os.path.join(folder, "lib"))
    command = [os.path.join(folder, "bin", name), *arguments]
    subprocess.run(command, check=True, env=environment, stderr=subprocess.PIPE, **streams)


def photons(seconds):
    """Global and caustic photons: 5,000 of each a second of the budget, the caustic half of that from a minute on."""
    count = int(5000 * seconds)
    return count, count if seconds < 30 else count // 2


def make_maps(scene, folder, options):
    octree, surfaces, caustic = (os.path.join(folder, name) for name in ("scene.oct", "g.pm", "c.pm"))
    with open(octree, "wb") as file:
        tool("oconv", os.path.join(scene, "scene.rad"), stdout=file)
    many, few = photons(options.budget)
    seed = str(1000 + options.seed)
    tool("mkpmap", "-apg", surfaces, str(many), "-apc", caustic, str(few), "-apr", seed, "-t", "0", "-fo+", octree)
    return octree, ["-ap", surfaces, BANDWIDTH, "-ap", caustic, BANDWIDTH]


def gather(scene, octree, maps, divisions, out, band, size=None):
    """Renders one of the bands of rows, from the top, with so many gather rays a pixel."""
    with open(os.path.join(scene, "scene.json")) as file:
        camera = json.load(file)["camera"]
    with open(os.path.join(scene, "view.txt")) as file:
        view = file.read().split()
    width, height = size or (camera["width"], camera["height"])
    opening = math.radians(camera["fov_degrees"])
    narrow = math.degrees(2.0 * math.atan(math.tan(opening / 2.0) / BANDS))
    # A view may be lifted by its own heights; of repeated options the last one counts.
    view += ["-vv", str(narrow), "-vl", str((BANDS - 1) / 2 - band), "-x", str(width), "-y", str(height // BANDS)]
    with open(out, "wb") as file:
        tool("rpict", "-t", "0", *view, *GATHER, "-ad", str(divisions), *maps, octree, stdout=file)


def main():
    options = budget.arguments(["photon-map"])
    with tempfile.TemporaryDirectory(dir=os.path.dirname(os.path.abspath(options.out))) as folder:
        if options.calibrate:
            calibrate(options, folder)
            return
        with open(options.costs) as file:
            costs = json.load(file)
        octree, maps = make_maps(options.scene, folder, options)
        files, divisions = [], []
        expected, begun = 0.0, budget.spent()
        for band in range(BANDS):
            # The same rays everywhere, as far as the bands so far cost what was expected of them.
            dearer = (budget.spent() - begun) / expected if expected else 1.0
            rest = {key: dearer * sum(cost[key] for cost in costs[band:]) for key in ("fixed", "each")}
            divisions.append(budget.affordable(rest, options.budget - budget.spent()))
            files.append(os.path.join(folder, f"{band}.hdr"))
            gather(options.scene, octree, maps, divisions[-1], files[-1], band=band)
            expected += costs[band]["fixed"] + divisions[-1] * costs[band]["each"]
        measured = budget.spent()
        join(files, options.out, folder)
        many, few = photons(options.budget)
        rays = f"{min(divisions)} to {max(divisions)} gather rays a pixel"
        budget.report(work=f"{many} + {few} photons, {rays}", measured=measured)


def calibrate(options, folder):
    """Costs of gather rays a pixel in each band, on a picture of 256 x 256 pixels."""
    octree, maps = make_maps(options.scene, folder, options)
    with open(os.path.join(options.scene, "scene.json")) as file:
        camera = json.load(file)["camera"]
    scale = camera["width"] * camera["height"] / 256**2
    costs = []
    for band in range(BANDS):
        seconds = []
        for divisions in (2, 10):
            before = budget.spent()
            gather(options.scene, octree, maps, divisions, os.path.join(folder, "out.hdr"), size=(256, 256), band=band)
            seconds.append(scale * (budget.spent() - before))
        costs.append(budget.linear(2, seconds[0], 10, seconds[1]))
    with open(options.costs, "w") as file:
        json.dump(costs, file)


def join(files, out, folder):
    """Bands in Radiance's RGBE as one EXR."""
    import numpy as np

    import pixels

    bands = []
    for hdr in files:
        raw = os.path.join(folder, "out.raw")
        with open(hdr, "rb") as source, open(raw, "wb") as target:
            tool("pvalue", "-df", "-h", "-o", "-H", stdin=source, stdout=target)
        bands.append(np.fromfile(raw, dtype=np.float32))
    values = np.concatenate(bands)
    side = round((values.size / 3) ** 0.5)
    pixels.write_exr(out, values.reshape(side, side, 3))


main()
