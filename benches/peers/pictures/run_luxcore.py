"""Renders a scene with LuxCore: path, path and light tracing together, bidirectional, or path with its photon caches."""

import json
import os
import subprocess
import sys
import time

import budget

HERE = os.path.dirname(os.path.abspath(__file__))

VARIANTS = {
    "path": {"renderengine.type": "PATHCPU"},
    "hybrid": {
        "renderengine.type": "PATHCPU",
        "path.hybridbackforward.enable": True,
        "path.hybridbackforward.partition": 0.8,
        "path.hybridbackforward.glossinessthreshold": 0.05,
    },
    "bidirectional": {"renderengine.type": "BIDIRCPU"},
    "photongi-caustic": {"renderengine.type": "PATHCPU", "path.photongi.photon.maxcount": 20_000_000},
    # The indirect cache fills until this many photons are traced: with the count above it takes longer than a minute.
    "photongi-both": {
        "renderengine.type": "PATHCPU",
        "path.photongi.photon.maxcount": 500_000,
        "path.photongi.indirect.enabled": True,
        "path.photongi.indirect.maxsize": 0,
        "path.photongi.indirect.haltthreshold": 0.05,
        "path.photongi.indirect.lookup.radius": 0.15,
        "path.photongi.indirect.lookup.normalangle": 10,
        "path.photongi.indirect.glossinessusagethreshold": 0.0,
        "path.photongi.indirect.usagethresholdscale": 8.0,
    },
}

# Radii are lengths of this scene, which is 5.5 wide: LuxCore's own defaults are of other scenes' sizes.
CAUSTIC_CACHE = {
    "path.photongi.sampler.type": "METROPOLIS",
    "path.photongi.photon.maxdepth": 8,
    "path.photongi.caustic.enabled": True,
    "path.photongi.caustic.maxsize": 100_000,
    "path.photongi.caustic.lookup.radius": 0.05,
    "path.photongi.caustic.lookup.normalangle": 10,
    "path.photongi.caustic.updatespp": 8,
    "path.photongi.caustic.updatespp.radiusreduction": 0.96,
    "path.photongi.caustic.updatespp.minradius": 0.003,
}

COMMON = {
    "film.filter.type": "BOX",
    "film.filter.width": 0.5,
    "film.imagepipelines.0.0.type": "NOP",
    "film.outputs.0.type": "RGB",
    "film.noiseestimation.warmup": 1_000_000,
    "native.threads.count": 1,
    "sampler.type": "SOBOL",
    "sampler.sobol.adaptive.strength": 0.0,
    "path.pathdepth.total": 32,
    "path.pathdepth.diffuse": 32,
    "path.pathdepth.glossy": 32,
    "path.pathdepth.specular": 32,
    "path.russianroulette.depth": 8,
    "path.russianroulette.cap": 0.5,
    "path.clamping.variance.maxvalue": 0.0,
    "path.maxdepth": 32,
    "light.maxdepth": 32,
    "light.russianroulette.depth": 8,
}


def main():
    options = budget.arguments(VARIANTS)
    import pyluxcore

    pyluxcore.Init()
    os.chdir(options.scene)
    with open("scene.json") as file:
        camera = json.load(file)["camera"]
    settings = dict(COMMON)
    if "photongi" in options.variant:
        settings |= CAUSTIC_CACHE
    settings |= VARIANTS[options.variant]
    out = os.path.abspath(options.out)
    settings |= {
        "film.width": camera["width"],
        "film.height": camera["height"],
        "film.outputs.0.filename": out,
        "renderengine.seed": options.seed + 1,
    }
    properties = pyluxcore.Properties()
    for key, value in settings.items():
        properties.Set(pyluxcore.Property(key, value))
    scene = pyluxcore.Scene()
    scene.Parse(pyluxcore.Properties("scene.scn"))
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(properties, scene))
    session.Start()
    while budget.spent() < options.budget - 0.15:
        time.sleep(0.02)
    session.UpdateStats()
    statistics = session.GetStats()
    samples = statistics.Get("stats.renderengine.total.samplecount").GetFloat()
    session.Stop()
    film = session.GetFilm()
    film.SaveOutput(out, pyluxcore.FilmOutputType.RGB, pyluxcore.Properties())
    measured = budget.spent()
    # Its pictures lie one row lower than everyone else's.
    subprocess.run([sys.executable, os.path.join(HERE, "raise_row.py"), out], check=True)
    pixels = camera["width"] * camera["height"]
    work = f"{samples / pixels:.1f} samples a pixel"
    budget.report(work=work, measured=measured)
    # Its threads may still log while the interpreter goes down, which ends in an abort.
    sys.stdout.flush()
    os._exit(0)


main()
