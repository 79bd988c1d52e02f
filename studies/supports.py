"""Renders scenes by the thesis's renderer with every support of estimates, and puts crops side by side.

    python3 -m venv target/studies && target/studies/bin/pip install numpy OpenEXR Pillow
    cargo build --release --bin photinus
    target/studies/bin/python studies/supports.py render   # target/studies/supports/: pictures, and results.csv
    target/studies/bin/python studies/supports.py draw     # docs/pictures/supports.png, table on stdout
    target/studies/bin/python studies/supports.py caustic  # after `render`: kernels and radii on a caustic, table on stdout

`turned` is `two-spheres` as Mitsuba XML, turned by 45 degrees about the line of sight together with its camera: the picture
is the same, but floor, ceiling and side walls meet the axes at 45 degrees.
"""

import csv
import json
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as xml

import numpy as np
import OpenEXR
from PIL import Image, ImageDraw, ImageFont

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
PROGRAM = TARGET / "release" / "photinus"
FOLDER = TARGET / "studies" / "supports"
RESULTS = FOLDER / "results.csv"
PICTURE = ROOT / "docs" / "pictures" / "supports.png"

SUPPORTS = ["box-fixed", "box-polygon", "box-trimmed", "ball", "disc", "ellipsoid"]
# Of the renders by the thesis's renderer, and of the references.
SCENES = {
    "spheres": ("384x384", "--photons 400000 --radius 0.5", "--passes 64"),
    "two-spheres": ("384x384", "--photons 50000 --radius 0.25", "--passes 64"),
    "turned": ("384x384", "--photons 50000 --radius 0.25", "--passes 64"),
    "room-1": (
        "400x300",
        "--photons 50000 --radius 20 --knn 100 --surface-model fixed",
        "--passes 24 --surface-model fixed",
    ),
}
# Rows of the picture: scene, square window of it (x, y, edge) in pixels, exposure in stops; none: the ratio to the reference.
ROWS = [
    ("spheres", (60, 110, 240), 0.0),
    ("spheres", (60, 110, 240), None),
    ("turned", (0, 0, 384), 0.5),
    ("turned", (0, 0, 384), None),
    ("turned", (216, 290, 80), -0.5),
    ("room-1", (0, 60, 240), 0.0),
]
# Edge of a crop in the picture, pixels.
CROP = 150
LABEL = 18


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], check=True, capture_output=True, text=True).stdout


def turn():
    """Writes the turned scene; returns its path."""
    folder = FOLDER / "turned"
    run("scenes", "write", "two-spheres", folder)
    path = folder / "two-spheres.xml"
    scene = xml.parse(path)
    for item in [*scene.iter("shape"), *scene.iter("sensor")]:
        transform = item.find("transform")
        if transform is None:
            transform = xml.SubElement(item, "transform", name="to_world")
        xml.SubElement(transform, "rotate", z="1", angle="45")
    path = folder / "turned.xml"
    scene.write(path, encoding="utf-8", xml_declaration=True)
    return path


def render():
    FOLDER.mkdir(parents=True, exist_ok=True)
    rows = []
    for scene, (pixels, direct, converged) in SCENES.items():
        source = turn() if scene == "turned" else scene
        size = ["--size", pixels, "--quiet"]
        reference = FOLDER / f"{scene}-reference.exr"
        run("render", source, *size, *converged.split(), "-o", reference)
        for support in SUPPORTS:
            output = FOLDER / f"{scene}-{support}.exr"
            how = ["--mode", "direct", "--passes", "1", *direct.split(), "--search", "kd-balanced", "--support", support]
            stats = json.loads(run("render", source, *size, *how, "--profile-every", "1", "--json", "-o", output))
            compared = json.loads(run("compare", output, reference, "--json"))
            rows.append({
                "scene": scene,
                "support": support,
                "relmse": compared["relmse"],
                "trimmed": compared["relmse_trimmed"],
                "found": stats["search"]["photons_found_mean"],
                "tested": stats["search"]["tests_per_search"],
                "brightness": read(output).mean() / read(reference).mean(),
            })
            print(rows[-1], flush=True)
    with RESULTS.open("w", newline="") as file:
        writer = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read(path):
    """RGB of the layer without a name, rows x columns x 3."""
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    return np.stack([np.asarray(channels[name].pixels, dtype=np.float64) for name in "RGB"], axis=-1)


def shown(linear, exposure):
    """A picture in sRGB."""
    linear = np.clip(linear * 2**exposure, 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return Image.fromarray((encoded * 255 + 0.5).astype(np.uint8))


def blurred(picture, edge=9):
    """Means over squares of pixels."""
    sums = np.pad(picture, ((edge // 2,) * 2, (edge // 2,) * 2, (0, 0)), mode="edge")
    for axis in (0, 1):
        sums = sum(np.roll(sums, shift, axis) for shift in range(-(edge // 2), edge // 2 + 1)) / edge
    return sums[edge // 2 : -(edge // 2), edge // 2 : -(edge // 2)]


def ratio(picture, reference):
    """Where a picture is too dark (blue), right (white) and too bright (red), to half as much again; noise blurred."""
    light, true = (blurred(p).mean(axis=-1) for p in (picture, reference))
    true = np.maximum(true, 1e-9)
    off = np.where(true < 1e-3, 0, np.clip((light / true - 1) / 0.5, -1, 1))[..., None]
    colour = np.where(off > 0, np.array([0.8, 0.1, 0.1]), np.array([0.1, 0.25, 0.8]))
    return Image.fromarray(((1 - np.abs(off) * (1 - colour)) * 255).astype(np.uint8))


def draw():
    columns = [*SUPPORTS, "reference"]
    sheet = Image.new("RGB", (len(columns) * (CROP + 4) - 4, LABEL + len(ROWS) * (CROP + 4) - 4), "white")
    pen, font = ImageDraw.Draw(sheet), ImageFont.load_default(size=13)
    for i, column in enumerate(columns):
        pen.text((i * (CROP + 4) + CROP / 2, LABEL / 2), column, fill="black", font=font, anchor="mm")
        for j, (scene, (x, y, edge), exposure) in enumerate(ROWS):
            pixels, true = (read(FOLDER / f"{scene}-{name}.exr") for name in (column, "reference"))
            crop = ratio(pixels, true) if exposure is None else shown(pixels, exposure)
            crop = crop.crop((x, y, x + edge, y + edge))
            how = Image.Resampling.LANCZOS if edge > CROP else Image.Resampling.NEAREST
            crop = crop.resize((CROP, CROP), how)
            sheet.paste(crop, (i * (CROP + 4), LABEL + j * (CROP + 4)))
    palette = sheet.quantize(256, kmeans=3)
    sheet.quantize(palette=palette, dither=Image.Dither.FLOYDSTEINBERG).save(PICTURE, optimize=True)
    with RESULTS.open(newline="") as file:
        rows = list(csv.DictReader(file))
    print("| scene | support | relMSE | trimmed | mean over the reference's | found a search | tested a search |")
    print("|---|---|---|---|---|---|---|")
    for row in rows:
        numbers = f"{float(row['relmse']):.4f} | {float(row['trimmed']):.4f} | {float(row['brightness']):.3f}"
        print(f"| `{row['scene']}` | `{row['support']}` | {numbers} | {float(row['found']):.1f} | {float(row['tested']):.0f} |")


# The caustic of `two-spheres`, pixels: x, y, and beyond; and what is tried on it.
CAUSTIC = (205, 310, 300, 372)
TRIED = [
    "--radius 0.25",
    "--radius 0.25 --kernel gaussian",
    "--radius 0.25 --kernel epanechnikov",
    "--radius 0.25 --kernel cone",
    "--radius 0.25 --knn 50",
    "--radius 0.25 --knn 50 --kernel cone",
    "--radius 0.08",
    "--radius 0.25 --caustic-radius 0.08",
    "--radius 0.25 --caustic-radius 0.08 --kernel cone",
]


def caustic():
    mask = Image.new("L", (384, 384))
    ImageDraw.Draw(mask).rectangle((CAUSTIC[0], CAUSTIC[1], CAUSTIC[2] - 1, CAUSTIC[3] - 1), fill=255)
    mask.save(FOLDER / "caustic-mask.png")
    output, reference = FOLDER / "caustic.exr", FOLDER / "two-spheres-reference.exr"
    direct = "--size 384x384 --mode direct --passes 1 --photons 50000 --quiet"
    print("| options | relMSE | trimmed | relMSE of the caustic |")
    print("|---|---|---|---|")
    for options in TRIED:
        run("render", "two-spheres", *direct.split(), *options.split(), "-o", output)
        whole = json.loads(run("compare", output, reference, "--json"))
        part = json.loads(run("compare", output, reference, "--mask", FOLDER / "caustic-mask.png", "--json"))
        print(f"| `{options}` | {whole['relmse']:.4f} | {whole['relmse_trimmed']:.4f} | {part['relmse']:.3f} |", flush=True)


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["render"]:
            render()
        case ["draw"]:
            draw()
        case ["caustic"]:
            caustic()
        case _:
            sys.exit(__doc__)
