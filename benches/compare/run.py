#!/usr/bin/env python3
"""Runs cloakroom and its peers on the same work and prints one Markdown table of each kind of work.

    benches/compare/install.sh && benches/compare/run.py [--rounds 5] [--figures] [--pictures DIR]

Times are CPU seconds, user and system, of the whole process, start to finish, on all cores. Each round runs
every program once, so that ratios are of neighbours in time; times and ratios are medians over the rounds.
"""

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = ROOT / "benches" / "compare"
WORK = ROOT / "target" / "compare"
PYTHON = WORK / "venv" / "bin" / "python"
CLOAKROOM = ROOT / "target" / "release" / "cloakroom"
PHOTOGRAPH = ROOT / "crates" / "cloakroom" / "assets" / "bookshelf.jpg"

# The mirrors that designs (iii) and (iv) imitate: half their widths, cm.
STRIPS = {"(iii)": 14.1 / 2**0.5, "(iv)": 25.0}
DEVICES = {
    "(iii)": 'kind = "square-cloak"',
    "(iv)": 'kind = "double-gaussian-cloak"',
    "(i)": 'kind = "square-cloak"\nmaterial = "positive-uniaxial"',
    "(ii)": 'kind = "square-cloak"\nmaterial = "negative-uniaxial"',
}
POV_RAY, MITSUBA = "POV-Ray", "Mitsuba 3, llvm_ad_rgb"


def environment():
    """The environment of the peers: where Dr.Jit finds LLVM."""
    found = dict(os.environ)
    if "DRJIT_LIBLLVM_PATH" not in found:
        for name in sorted(Path("/usr/lib").glob("*/libLLVM*.so*"), reverse=True):
            if "19" in name.name:
                found["DRJIT_LIBLLVM_PATH"] = str(name)
                break
    return found


def timed(command):
    """CPU and wall seconds of a whole process."""
    start = time.perf_counter()
    with open(WORK / "output.txt", "wb") as out:
        process = subprocess.Popen(
            [str(word) for word in command], cwd=ROOT, stdout=out, stderr=out, env=environment()
        )
        _, status, usage = os.wait4(process.pid, 0)
    wall = time.perf_counter() - start
    if status != 0:
        sys.exit(f"{command}\n{(WORK / 'output.txt').read_text()}")
    return usage.ru_utime + usage.ru_stime, wall


def scene(device, show="cloak", rotation=10):
    """A scene file for cloakroom; the photograph and the camera are the default ones, but square."""
    path = WORK / f"{device}-{show}.toml"
    text = "[camera]\nresolution = [1024, 1024]\nsamples = 1\n"
    if device in DEVICES:
        text += f'[[device]]\n{DEVICES[device]}\nrotation = {rotation}\nshow = "{show}"\n'
    path.write_text(text)
    return path


def cloakroom(device, show, samples, picture, *more):
    return [
        CLOAKROOM, "render", scene(device, show), "--set", f"camera.samples={samples}",
        *more, "-o", picture,
    ]  # fmt: skip


def pov_ray(device, samples, picture):
    # The least threshold takes a grid of 4 x 4 rays in every pixel.
    quality = ["+A0.0", "+AM1", "+R4", "-J"] if samples == 16 else ["-A"]
    return [
        "povray", f"+I{HERE / 'strip.pov'}", f"+L{PHOTOGRAPH.parent}", "+W1024", "+H1024", "-D",
        f"Declare=Half_Width={STRIPS[device]}", *quality, f"+O{picture}",
    ]  # fmt: skip


def mitsuba(device, samples, picture):
    words = ["llvm_ad_rgb", STRIPS[device], samples, PHOTOGRAPH, picture]
    return [PYTHON, HERE / "strip_mitsuba.py", *words]


def rounds(commands, count, warm=True):
    """The CPU and the wall seconds of each command in each round, after one that warms caches up (files,
    and the kernels that Mitsuba compiles)."""
    for command in commands.values() if warm else ():
        timed(command)
    runs = {name: [] for name in commands}
    for _ in range(count):
        for name, command in commands.items():
            runs[name].append(timed(command))
    return runs


def median(runs, column=0):
    return statistics.median(run[column] for run in runs)


def ratio(runs, others):
    return statistics.median(run[0] / other[0] for run, other in zip(runs, others))


def table(head, rows):
    print(f"\n| {' | '.join(head)} |\n| {' | '.join(['---'] + ['---:'] * (len(head) - 1))} |")
    for row in rows:
        print(f"| {' | '.join(row)} |")
    sys.stdout.flush()


def machine():
    info = Path("/proc/cpuinfo").read_text().splitlines()
    model = next(line.split(":")[1].strip() for line in info if line.startswith("model name"))
    cores = sum(line.startswith("processor") for line in info)
    load = os.getloadavg()[0]
    print(f"{model}, {cores} cores, {platform.system()} {platform.release()}, load {load:.1f}")


def pictures(count, folder):
    """The view with the mirror by all programs, and cloaked."""
    rows = []
    for samples in (1, 16):
        for device in STRIPS:
            def picture(name):
                return folder / f"{device.strip('()')}-{samples}-{name}.png"

            commands = {
                POV_RAY: pov_ray(device, samples, picture("povray")),
                MITSUBA: mitsuba(device, samples, picture("mitsuba")),
                "cloakroom, mirror": cloakroom(device, "mirror", samples, picture("mirror")),
                "cloakroom, cloak": cloakroom(device, "cloak", samples, picture("cloak")),
            }
            runs = rounds(commands, count, warm=samples == 1)
            for name in commands:
                against = f"{ratio(runs[name], runs[POV_RAY]):.2f}"
                times = [f"{median(runs[name]):.2f}", f"{median(runs[name], 1):.2f}", against]
                rows.append([f"of {device}", str(samples), name, *times])
    head = ["mirror strip", "samples", "program", "CPU s", "wall s", "CPU over POV-Ray's"]
    table(head, rows)


def many(count, folder):
    """Pictures of 16 samples beside POV-Ray's mirror strip of design (iv)."""
    picture = folder / "many.png"

    def of_file(path, *more):
        square = ["--set", "camera.resolution=[1024, 1024]", "--set", "camera.samples=16"]
        return [CLOAKROOM, "render", path, *square, *more, "-o", picture]

    uneven = ["--set", "device.0.imperfection.error=0.02"]
    commands = {
        POV_RAY: pov_ray("(iv)", 16, picture),
        **{device: cloakroom(device, "cloak", 16, picture) for device in DEVICES},
        "(iii), error 0.02": of_file(scene("(iii)"), *uneven),
        "graded": of_file(ROOT / "scenes" / "gallery" / "graded.toml"),
        "calcite carpet": of_file(HERE / "calcite_carpet.toml"),
    }
    runs = rounds(commands, count, warm=False)
    rows = [
        [name, f"{median(runs[name]):.2f}", f"{ratio(runs[name], runs[POV_RAY]):.2f}"] for name in commands
    ]
    table(["16 samples", "CPU s", "CPU over POV-Ray's"], rows)


def own(count, folder):
    """What only cloakroom does."""
    picture = folder / "own.png"
    commands = {
        "empty view, 1 sample": cloakroom("empty", "cloak", 1, picture),
        "(i), 1 sample": cloakroom("(i)", "cloak", 1, picture),
        "(ii), 1 sample": cloakroom("(ii)", "cloak", 1, picture),
    }
    small = ["--set", "camera.resolution=[64, 64]"]
    for device in ("empty", *DEVICES):
        name = "empty view" if device == "empty" else device
        commands[f"start-up to 64 x 64, {name}"] = cloakroom(device, "cloak", 1, picture, *small)
    runs = rounds(commands, count)
    rows = [[name, f"{median(runs[name]):.3f}", f"{median(runs[name], 1):.3f}"] for name in runs]
    table(["cloakroom", "CPU s", "wall s"], rows)


def threads(count, folder):
    """Wall time of many samples less that of few: that of rendering alone, on 1 thread and on 2."""
    rows = []
    for device, show, base, more in (
        ("(iii)", "mirror", 16, 32),
        ("(iii)", "cloak", 16, 32),
        ("(iv)", "cloak", 1, 5),
        ("(ii)", "cloak", 1, 2),
    ):
        commands = {
            (number, samples): cloakroom(
                device, show, samples, folder / "own.png", "--threads", number
            )
            for number in (1, 2)
            for samples in (base, more)
        }
        runs = rounds(commands, count, warm=False)
        phase = [
            [big[1] - small[1] for big, small in zip(runs[number, more], runs[number, base])]
            for number in (1, 2)
        ]
        one, two = (statistics.median(walls) for walls in phase)
        name = f"{device} {show}, {more - base} samples"
        rows.append([name, f"{one:.2f}", f"{two:.2f}", f"{one / two:.2f}"])
    table(["render phase", "1 thread, wall s", "2 threads, wall s", "ratio"], rows)


def interfaces():
    out = subprocess.run([PYTHON, HERE / "interface_pyelli.py"], capture_output=True, check=True)
    rate = json.loads(out.stdout)["sets_per_cpu_second"]
    names = ["air_to_uniaxial", "uniaxial_to_uniaxial"]
    rows = [["pyElli, air to uniaxial", f"{rate / 1e6:.3f}"]]
    for name, rays in bench("cloakroom-optics", "interfaces", names).items():
        rows.append([f"cloakroom, {name.replace('_', ' ')}", f"{rays / 1e6:.2f}"])
    table(["interface, all modes and coefficients", "million a second a core"], rows)


def bench(package, target, names):
    """Items a second of some rows of a benchmark, by the fastest sample: the one least disturbed."""
    command = ["cargo", "bench", "--quiet", "--package", package, "--bench", target, "--", *names]
    out = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return rates(out, names)


def rates(out, names):
    """The same from divan's tree; of rows of the same name in several groups the best."""
    found, name = {}, None
    for line in out.splitlines():
        # A row `├─ name  1.2 µs │ ...` and, below it, the same in items a second.
        words = line.translate(str.maketrans("│├╰─", "    ")).split()
        if name in names and len(words) > 1 and words[1].endswith("item/s"):
            scale = {"K": 1e3, "M": 1e6, "G": 1e9}.get(words[1][0], 1.0)
            found[name] = max(found.get(name, 0.0), float(words[0]) * scale)
        times = [i for i, word in enumerate(words) if word in ("ns", "µs", "ms", "s")]
        name = " ".join(words[: times[0] - 1]) if times else None
    return found


def graded():
    command = [PYTHON, HERE / "graded_numba.py", CLOAKROOM]
    out = subprocess.run(command, cwd=ROOT, capture_output=True, check=True)
    rows = []
    for name, row in json.loads(out.stdout).items():
        error = f"{row['error_cm']:.1e}"
        rows.append([f"Runge-Kutta, numba, {name}", f"{row['rays_per_cpu_second']:.0f}", error])
        confirmed = row.get("sixteenth_of_the_step_off_cloakroom_cm")
        if confirmed is not None:
            print(f"\nA sixteenth of the step is {confirmed:.1e} cm off cloakroom's rays.")
    for name, kind in (("Luneburg lens", "luneburg-lens"), ("design (iv)", "double-gaussian-cloak")):
        rate = bench("cloakroom", "devices", [kind])[kind]
        bound = "rounding" if kind == "luneburg-lens" else "1e-6 at most"
        rows.append([f"cloakroom, {name}, whole ray trees", f"{rate:.0f}", bound])
    table(["rays through graded media", "rays a second a core", "largest error, cm"], rows)


def figures(folder):
    cpu, wall = timed([CLOAKROOM, "figures", "--out", folder / "figures"])
    row = ["cloakroom figures", f"{cpu:.0f}", f"{wall:.0f}"]
    table(["all figures, default size", "CPU s", "wall s"], [row])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--figures", action="store_true", help="time all figures of the paper, too")
    parser.add_argument("--pictures", type=Path, default=WORK / "pictures", help="where they go")
    parser.add_argument("--only", action="append", help="pictures, many, own, threads, interfaces, graded or figures")
    arguments = parser.parse_args()
    arguments.pictures.mkdir(parents=True, exist_ok=True)
    parts = {
        "pictures": lambda: pictures(arguments.rounds, arguments.pictures),
        "many": lambda: many(arguments.rounds, arguments.pictures),
        "own": lambda: own(arguments.rounds, arguments.pictures),
        "threads": lambda: threads(arguments.rounds, arguments.pictures),
        "interfaces": interfaces,
        "graded": graded,
        "figures": lambda: figures(arguments.pictures),
    }
    machine()
    for name, part in parts.items():
        if (not arguments.only or name in arguments.only) and (name != "figures" or arguments.figures):
            part()


main()
