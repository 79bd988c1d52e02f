"""Makes the thesis's tables of photon searches (17, and the photon rows of 9 and 28) anew from profiles measured here.

    cargo build --release --bin photinus
    python3 studies/photon_tables.py [FOLDER]

Renders the four rooms and the pond at the thesis's settings with its members and with the default ones, and prints the tables
in Markdown, printed values first. Profiles are left in FOLDER (target/photon-tables), where those of a run before are
read instead of rendering again.
"""

import json
import pathlib
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
REFERENCE = tomllib.loads((ROOT / "studies/reference/photon_search.toml").read_text())
# The thesis does not say how many photons its pond was sent: as many as store what Table 28 prints.
PHOTONS = {"water-lily-6146": 81000}
SETTINGS = "--mode direct --size 800x600 --radius 20 --knn 100 --surface-model fixed --passes 1 --threads 1".split()
THESIS = "--accel kd-tree --intersect badouel-thesis --search kd-balanced".split()


def profile(folder, scene, members, name):
    """The statistics of one render."""
    path = folder / f"{scene}-{name}.json"
    if not path.exists():
        photons = ["--photons", str(PHOTONS.get(scene, 50000))]
        program = ROOT / "target/release/photinus"
        picture = ["-o", str(folder / f"{scene}-{name}.png"), "--stats", str(path), "--quiet"]
        subprocess.run([program, "render", scene, *SETTINGS, *photons, *members, *picture], check=True)
    return json.loads(path.read_text())


def row(title, printed, measured, digits):
    cells = [f"{p:,.{digits}f} / {m:,.{digits}f}" for p, m in zip(printed, measured)]
    print(f"| {title} | " + " | ".join(cells) + " |")


def table(name, columns, rows):
    print(f"\n{REFERENCE[name]['source']}, thesis / here\n")
    print("| | " + " | ".join(columns) + " |\n|" + "---|" * (len(columns) + 1))
    for title, key, measured, scale, digits in rows:
        row(title, [value / scale for value in REFERENCE[name][key]], [value / scale for value in measured], digits)


def main(arguments):
    folder = pathlib.Path(arguments[0]) if arguments else ROOT / "target/photon-tables"
    folder.mkdir(parents=True, exist_ok=True)
    scenes = ["room-1", "room-2", "room-3", "room-4", "water-lily-6146"]
    thesis = {scene: profile(folder, scene, THESIS, "thesis") for scene in scenes}
    default = {scene: profile(folder, scene, [], "default") for scene in scenes}

    def of(columns, profiles, value):
        return [value(profiles[scene]) for scene in columns]

    seconds = lambda p: p["search"]["seconds"]
    each = lambda p: p["search"]["seconds"] / p["search"]["searches"] * 1e6
    tests = lambda p: p["search"]["photons_tested"]
    brute = lambda p: p["search"]["searches"] * p["photons"]["stored"]
    columns = REFERENCE["table_17"]["columns"]
    table("table_17", columns, [
        ("tests of the kd-tree, million", "kd_tree_tests", of(columns, thesis, tests), 1e6, 0),
        ("tests of brute force, thousand million", "brute_force_tests", of(columns, thesis, brute), 1e9, 1),
        ("increase", "increase", of(columns, thesis, lambda p: brute(p) / tests(p)), 1, 1),
    ])
    table("table_9", columns, [
        ("all searches, s", "search_seconds", of(columns, thesis, seconds), 1, 2),
        ("a search, us", "search_microseconds", of(columns, thesis, each), 1, 2),
        ("all searches by `grid`, s", "search_seconds", of(columns, default, seconds), 1, 2),
        ("a search by `grid`, us", "search_microseconds", of(columns, default, each), 1, 2),
    ])
    columns = REFERENCE["table_28"]["columns"]
    search = lambda key: lambda p: p["search"][key]
    table("table_28", columns, [
        ("all searches, s", "search_seconds", of(columns, thesis, seconds), 1, 2),
        ("a search, us", "search_microseconds", of(columns, thesis, each), 1, 2),
        ("all searches by `grid`, s", "search_seconds", of(columns, default, seconds), 1, 2),
        ("a search by `grid`, us", "search_microseconds", of(columns, default, each), 1, 2),
        ("photons stored", "photons_stored", of(columns, thesis, lambda p: p["photons"]["stored"]), 1, 0),
        ("searches", "searches", of(columns, thesis, search("searches")), 1, 0),
        ("photons found of a search", "photons_found", of(columns, thesis, search("photons_found_mean")), 1, 1),
    ])


if __name__ == "__main__":
    main(sys.argv[1:])
