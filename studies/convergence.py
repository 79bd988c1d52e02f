"""Measures how the error falls with the number of passes, scene by scene, fits exponents and draws the page of curves.

    python3 -m venv target/studies && target/studies/bin/pip install matplotlib
    target/studies/bin/python studies/convergence.py measure [SCENE ...]   # rewrites rows of studies/convergence.csv
    target/studies/bin/python studies/convergence.py draw                  # docs/pictures/convergence.png, table on stdout

`measure` runs the example `convergence` of the crate `photinus`. The scene `bitterli` needs PHOTINUS_SCENES.
"""

import csv
import math
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
TABLE = ROOT / "studies" / "convergence.csv"
PICTURE = ROOT / "docs" / "pictures" / "convergence.png"
FIELDS = ["scene", "width", "height", "reference", "reference_passes", "mode", "part", "seed", "passes", "relmse"]
BITTERLI = "cornell/bitterli/mitsuba/scene_v3.xml"

# Scene: size, mode of the references, their passes, seeds of the measured renders.
SCENES = {
    "two-spheres": ("96x72", "progressive", 96, 3),
    "small-lamp": ("64x48", "progressive", 48, 2),
    "cornell": ("96x72", "path", 512, 2),
    "furnace": ("96x72", "path", 1024, 3),
    "spheres": ("64x48", "path", 512, 2),
    "texture-10": ("64x48", "path", 512, 2),
    "texture-1210": ("64x48", "path", 512, 2),
    "texture-7590": ("64x48", "path", 512, 2),
    "study-22054": ("64x48", "progressive", 48, 1),
    "water-lily-1426": ("64x48", "progressive", 48, 2),
    "water-lily-6146": ("64x48", "progressive", 48, 1),
    "room-1": ("64x48", "progressive", 32, 1),
    "room-2": ("64x48", "progressive", 32, 1),
    "room-3": ("64x48", "progressive", 32, 1),
    "room-4": ("64x48", "progressive", 32, 1),
    "bitterli": ("64x48", "path", 512, 2),
}

# From this number of passes on, the fit looks at the fall: the first passes are led by the edges of single samples.
FIT_FROM = 4


def read_table():
    if not TABLE.exists():
        return []
    with TABLE.open(newline="") as file:
        return list(csv.DictReader(file))


def write_table(rows):
    order = list(SCENES)
    rows.sort(key=lambda row: order.index(row["scene"]))
    with TABLE.open("w", newline="") as file:
        writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def measure(scenes):
    subprocess.run(["cargo", "build", "--release", "--quiet", "-p", "photinus", "--example", "convergence"], cwd=ROOT, check=True)
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    program = target / "release" / "examples" / "convergence"
    for scene in scenes:
        size, reference, passes, seeds = SCENES[scene]
        source = scene
        if scene == "bitterli":
            source = pathlib.Path(os.environ["PHOTINUS_SCENES"]) / BITTERLI
        command = [program, source, size, reference, str(passes), str(seeds)]
        lines = subprocess.run(command, check=True, capture_output=True, text=True).stdout.splitlines()
        rows = [dict(zip(FIELDS, line.split(","), strict=True)) | {"scene": scene} for line in lines]
        write_table([row for row in read_table() if row["scene"] != scene] + rows)
        print(f"{scene}: {len(rows)} rows", flush=True)


def curve(rows, scene, mode, part):
    """Passes and mean error over seeds, in order."""
    sums = {}
    for row in rows:
        if (row["scene"], row["mode"], row["part"]) == (scene, mode, part):
            sums.setdefault(int(row["passes"]), []).append(float(row["relmse"]))
    return [(passes, sum(errors) / len(errors)) for passes, errors in sorted(sums.items())]


def exponent(points):
    """Slope of the straight line through log(error) over log(passes), by least squares; None where an error is not positive."""
    points = [(n, e) for n, e in points if n >= FIT_FROM]
    if len(points) < 2 or any(e <= 0 for _, e in points):
        return None
    x = [math.log(n) for n, _ in points]
    y = [math.log(e) for _, e in points]
    mx, my = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mx) * (b - my) for a, b in zip(x, y)) / sum((a - mx) ** 2 for a in x)


CURVES = [
    ("progressive", "all", "tab:blue", "o", "progressive"),
    ("progressive", "photons", "tab:orange", "s", "progressive, light found by photons"),
    ("progressive", "photons-away-from-edges", "tab:red", "d", "the same, away from edges"),
    ("path", "all", "tab:green", "^", "path"),
]


def draw():
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    rows = read_table()
    measured = {row["scene"] for row in rows}
    scenes = [scene for scene in SCENES if scene in measured]
    figure, axes = plt.subplots(-(-len(scenes) // 4), 4, figsize=(11, 1 + 2.5 * -(-len(scenes) // 4)), squeeze=False)
    for axis in axes.flat[len(scenes) :]:
        axis.set_visible(False)
    print("| scene | progressive | its photons | away from edges | path | relMSE after 64 passes |")
    print("|---|---|---|---|---|---|")
    for scene, axis in zip(scenes, axes.flat):
        axis.set_title(scene, fontsize=9)
        cells = []
        for mode, part, colour, marker, label in CURVES:
            points = curve(rows, scene, mode, part)
            slope = exponent(points)
            cells.append("-" if slope is None else f"{slope:.2f}")
            if not points:
                continue
            axis.loglog(*zip(*points), color=colour, marker=marker, markersize=3, linewidth=1.2, label=label)
            if mode == "path" or part == "photons":
                law, style = (-1, ":") if mode == "path" else (-2 / 3, "--")
                last_n, last_error = points[-1]
                line = [last_error * (n / last_n) ** law for n, _ in points]
                axis.loglog([n for n, _ in points], line, color=colour, linestyle=style, linewidth=0.7)
        last = curve(rows, scene, "progressive", "all")
        print(f"| `{scene}` | {' | '.join(cells)} | {f'{last[-1][1]:.1e}' if last else '-'} |")
        axis.grid(True, which="major", linewidth=0.3)
        axis.tick_params(labelsize=7)
        axis.set_xticks([1, 4, 16, 64], ["1", "4", "16", "64"])
    handles = {}
    for axis in axes.flat:
        for handle, label in zip(*axis.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=3, fontsize=9)
    figure.suptitle("Relative squared error against passes N; dashed N^(-2/3), dotted 1/N", fontsize=10)
    figure.tight_layout(rect=(0, 0.08, 1, 1))
    figure.savefig(PICTURE, dpi=80, metadata={"Software": None})


def main(arguments):
    match arguments:
        case ["measure", *scenes]:
            unknown = [scene for scene in scenes if scene not in SCENES]
            if unknown:
                sys.exit(f"unknown scene {unknown[0]}: use {', '.join(SCENES)}")
            measure(scenes or SCENES)
        case ["draw"]:
            draw()
        case _:
            sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
