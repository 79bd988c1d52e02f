"""Renders a scene with Mitsuba 3, by path tracing or by light tracing (ptracer), pass after pass until the time is spent."""

import os

import numpy as np

import budget
import pixels

VARIANTS = {
    "path": ("llvm_ad_rgb", "path", 8),
    "path-scalar": ("scalar_rgb", "path", 1),
    "ptracer": ("llvm_ad_rgb", "ptracer", 8),
}


def main():
    options = budget.arguments(VARIANTS)
    variant, integrator, pass_samples = VARIANTS[options.variant]
    import drjit
    import mitsuba

    mitsuba.set_variant(variant)
    drjit.set_thread_count(1)
    scene = mitsuba.load_file(os.path.join(options.scene, "scene.xml"))
    # Roulette starts late, as in the other engines, so that few paths pay for the light that they carry far.
    method = mitsuba.load_dict({"type": integrator, "max_depth": 32, "rr_depth": 8})

    def one_pass(samples, seed):
        image = np.array(mitsuba.render(scene, integrator=method, spp=samples, seed=seed), dtype=np.float64)
        return image[..., :3]

    # The first pass holds the compilation of the kernels; the pace is taken from the passes after it.
    total = one_pass(1, options.seed * 100_000)
    done, passes = 1, 1
    pace = None
    reserve = 0.1
    while True:
        left = options.budget - reserve - budget.spent()
        samples = 1 if pace is None else min(pass_samples, int(left / pace))
        if samples < 1 or left <= 0:
            break
        before = budget.spent()
        total += samples * one_pass(samples, options.seed * 100_000 + passes)
        now = (budget.spent() - before) / samples
        pace = now if pace is None else 0.5 * (pace + now)
        done += samples
        passes += 1
    pixels.write_exr(options.out, total / done)
    budget.report(work=f"{done} samples a pixel")


main()
