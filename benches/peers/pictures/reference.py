"""Makes a reference picture with Mitsuba 3 from path tracing and light tracing, and the masks that go with any reference."""

import argparse
import json

import numpy as np

import budget
import pixels

# Samples a pixel in one batch; means and variances are taken over batches.
BATCH = 8

# A floor pixel belongs to the caustic where it is so many times brighter than the floor's median.
CAUSTIC_CONTRAST = 5.0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--xml", help="the scene for Mitsuba; left out, the picture is there and only masks are made")
    parser.add_argument("--seconds", type=float, help="processor seconds, half for each method where there are two")
    parser.add_argument("--objects", required=True, help="EXR with the channel object-id.id")
    parser.add_argument("--floor", type=int, required=True, help="number of the floor in it")
    parser.add_argument("--lamp", type=int, required=True, help="number of the lamp")
    parser.add_argument("--spheres", type=int, nargs="+", required=True, help="numbers of the spheres")
    parser.add_argument("--lights-only", action="store_true", help="light tracing alone; the spheres stay uncounted")
    parser.add_argument("--picture", required=True, help="the reference: written, or read where --xml is left out")
    parser.add_argument("--counted", required=True, help="mask to write: what counts")
    parser.add_argument("--caustic", required=True, help="mask to write: the caustic on the floor")
    options = parser.parse_args()
    objects = pixels.read_exr(options.objects, ("object-id.id",))[..., 0].astype(int)
    spheres = np.isin(objects, options.spheres)
    seen_by_chance = spheres | (objects == options.lamp)
    work = {}
    if options.xml:
        picture, work = combined(options, seen_by_chance)
        pixels.write_exr(options.picture, picture)
    picture = pixels.read_exr(options.picture).mean(axis=-1)
    hidden = objects == options.lamp
    if options.lights_only:
        # A light tracer shows no sphere; pixels that touch one are mixtures.
        hidden = grown(hidden | spheres)
    floor = (objects == options.floor) & ~hidden
    caustic = floor & (picture > CAUSTIC_CONTRAST * np.median(picture[floor]))
    pixels.write_mask(options.counted, ~hidden)
    pixels.write_mask(options.caustic, caustic)
    print(json.dumps({"caustic_pixels": int(caustic.sum()), **work}))


def grown(mask):
    """The mask and all neighbours of its pixels."""
    padded = np.pad(mask, 1)
    height, width = mask.shape
    shifts = [(i, j) for i in range(3) for j in range(3)]
    return np.any([padded[i : i + height, j : j + width] for i, j in shifts], axis=0)


def combined(options, seen_by_chance):
    """Each pixel from both methods by inverse variance; light tracing has no say where it sees nothing."""
    import mitsuba

    mitsuba.set_variant("llvm_ad_rgb")
    scene = mitsuba.load_file(options.xml)
    seconds = options.seconds if options.lights_only else options.seconds / 2
    light, light_variance, light_samples = averaged(mitsuba, scene, "ptracer", seconds)
    if options.lights_only:
        return light, {"light_samples": light_samples}
    path, path_variance, path_samples = averaged(mitsuba, scene, "path", seconds)
    # Smooth variances: a lone firefly's own estimate says nothing of the pixels around it.
    weights = [1.0 / (1e-12 + smooth(v.mean(axis=-1)))[..., None] for v in (path_variance, light_variance)]
    weights[1] = np.where(grown(seen_by_chance)[..., None], 0.0, weights[1])
    picture = (weights[0] * path + weights[1] * light) / (weights[0] + weights[1])
    return picture, {"light_samples": light_samples, "path_samples": path_samples}


def averaged(mitsuba, scene, integrator, seconds):
    """Mean, variance of the mean and samples a pixel of one method, batch after batch until the time is spent."""
    method = mitsuba.load_dict({"type": integrator, "max_depth": 32, "rr_depth": 8})
    total, squares, batches = 0.0, 0.0, 0
    end = budget.spent() + seconds
    # No fewer than four batches: a variance of fewer is none.
    while batches < 4 or budget.spent() < end:
        seed = 7_000_000 + batches
        image = np.array(mitsuba.render(scene, integrator=method, spp=BATCH, seed=seed), dtype=np.float64)[..., :3]
        total, squares, batches = total + image, squares + image**2, batches + 1
    mean = total / batches
    variance = np.maximum(squares / batches - mean**2, 0.0) / (batches - 1)
    return mean, variance, batches * BATCH


def smooth(values, radius=3):
    """Means over squares of 2 radius + 1 pixels."""
    padded = np.pad(values, radius, mode="edge")
    height, width = values.shape
    side = 2 * radius + 1
    return np.mean([padded[i : i + height, j : j + width] for i in range(side) for j in range(side)], axis=0)


main()
