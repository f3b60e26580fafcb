"""Solves the same problems with our solver and with other programs, checks that they agree, and times them in turn.

Usage: python xtask/peers/compare.py [--quick] [--rounds N] [--peers numba,scipy,akantu,kratos,openseespy]

The interpreter needs numpy; `pip install -r xtask/peers/requirements.txt` has the others, and one that is not there is left
out by name. Ours (`crates/fe/contact/examples/peer.rs`) runs again before every run of another, so that both meet the same
machine. Writes docs/results/compare.csv and .md; `--quick` takes the small problems, three rounds, and writes nothing.
"""

import argparse
import csv
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
RESULTS = ROOT / "docs/results"
COLUMNS = "problem,elements,program,version,element,round,ours_cpu_ns,ours_wall_ns,theirs_cpu_ns,theirs_wall_ns"
ONE_THREAD = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL", "NUMBA", "NUMEXPR")}

# Shapes are known to 3e-14 from positions of 0.1 m; a body that is longer by as much everywhere is off by 1e-9 of displacements
# of some µm, and a thousand steps add about the same. Strains are about 2e-4, and so are the terms that a small-strain element
# leaves out. Two elements of the same order: the dispersion of waves differs by some (kh)²/24 = 4e-5 a radian, over ten radians
# and more in the short waves.
ROUNDING, LINEAR, DISPERSION = 1e-8, 1e-3, 2e-3
SAME, OTHER = "same element: rounding", "another element: dispersion"
TWIN = "numba full"

# Name, variant, script, slow, limit, its reason, limit of the difference from the twin. Fastest first.
ON_BLOCKS = [
    ("numba", "strips", "numba_kernels.py", False, ROUNDING, SAME, None),
    ("numba", "grid", "numba_kernels.py", False, ROUNDING, SAME, None),
    ("numba", "general", "numba_kernels.py", False, ROUNDING, SAME, None),
    ("numba", "random", "numba_kernels.py", False, ROUNDING, SAME, None),
    ("scipy", "matrix", "scipy_csr.py", False, LINEAR, "same element, small strain", None),
    ("numba", "full", "numba_kernels.py", False, DISPERSION, OTHER, None),
    ("akantu", "small", "akantu_block.py", True, DISPERSION, OTHER, LINEAR),
    ("kratos", "small", "kratos_block.py", True, DISPERSION, OTHER, LINEAR),
    ("kratos", "total", "kratos_block.py", True, DISPERSION, OTHER, ROUNDING),
    ("openseespy", "small", "opensees_block.py", True, DISPERSION, OTHER, LINEAR),
]
# Contact that opens and closes enlarges what rounding leaves.
ON_DISC = [("numba", "squeeze", "numba_squeeze.py", False, 1e-7, "same elements and contact: rounding", None)]


class Program:
    """A process that answers line by line (`problem.py`)."""

    def __init__(self, words, folder):
        self.folder, self.log = folder, open(folder / "log", "w+")
        environment = os.environ | ONE_THREAD | {"PYTHONDONTWRITEBYTECODE": "1"}
        pipe = subprocess.PIPE
        self.child = subprocess.Popen(words, stdin=pipe, stdout=pipe, stderr=self.log, text=True, cwd=folder, env=environment)
        self.about = self.answer()

    def answer(self):
        for line in self.child.stdout:
            # Programs that print on their own share this stream.
            if line.startswith("@"):
                return json.loads(line[1:])
        self.log.seek(0)
        lines = [line.strip() for line in self.log if line.strip()]
        # Python chains errors; the first one is the cause.
        raise RuntimeError(next((line for line in lines if "Error: " in line), (lines or ["it ended without a word"])[-1]))

    def tell(self, line):
        print(line, file=self.child.stdin, flush=True)
        return self.answer()

    def pace(self, steps, elements):
        """Time per element and step [ns], of the processor and of the clock."""
        time = self.tell(f"run {steps}")
        return [1e9 * time[key] / (steps * elements) for key in ("cpu_s", "wall_s")]

    def solve(self, checks, elements):
        """Displacements after each number of steps, and steps that take half a second."""
        found, done = {}, 0
        for steps in checks:
            cpu, _ = self.pace(steps - done, elements)
            self.tell(f"write {self.folder / 'answer.bin'}")
            found[steps], done = np.fromfile(self.folder / "answer.bin"), steps
        return found, min(max(int(0.5e9 / (cpu * elements)), 1), 1_000_000)


@dataclass
class Entry:
    """One program on one problem; differences are the other program, norm over norm, limit and its reason."""

    about: dict
    differences: list = field(default_factory=list)
    rounds: list = field(default_factory=list)


@dataclass
class Measured:
    title: str
    text: str
    elements: int
    ours: dict
    entries: list = field(default_factory=list)

    def rows(self):
        for entry in self.entries:
            for number, paces in enumerate(entry.rounds, 1):
                about = (entry.about[key] for key in ("program", "version", "element"))
                yield [self.title, self.elements, *about, number, *(f"{pace:.4f}" for pace in paces)]


def measure(title, text, elements, words, file, checks, peers, rounds, absent, also=None):
    """Answers first, then the times in turn."""
    folder = lambda: pathlib.Path(tempfile.mkdtemp(dir=file.parent))
    ours = Program(words, folder())
    ours_found, ours_steps = ours.solve(checks, elements)
    solved, running = {"ours": ours_found}, []
    todo = [(None, "random", also, False, ROUNDING, SAME, None)] if also else []
    for name, variant, script, slow, limit, reason, twin in todo + peers:
        print(f"{title}: {name or 'ours'} {variant} …", file=sys.stderr)
        try:
            command = script if name is None else [sys.executable, HERE / script, file, variant]
            program = Program(command, folder())
            found, steps = program.solve(checks[:1] if slow else checks, elements)
        except (RuntimeError, OSError) as why:
            print(f"  left out: {why}", file=sys.stderr)
            absent[f"{name} {variant}"] = why
            continue
        solved[f"{name} {variant}"] = found
        entry = Entry(program.about)
        references = [("ours", limit, reason), (TWIN, twin, "same element")]
        for other, limit, reason in references:
            if limit is not None and other in solved:
                u, v = found[max(found)], solved[other][max(found)]
                off = np.linalg.norm(u - v) / np.linalg.norm(v) if u.shape == v.shape else np.inf
                entry.differences.append((other, off, limit, reason))
        running.append((program, entry, steps))
    for number in range(rounds):
        print(f"{title}: round {number + 1} of {rounds}", file=sys.stderr)
        for program, entry, steps in running:
            entry.rounds.append(ours.pace(ours_steps, elements) + program.pace(steps, elements))
    return Measured(title, text, elements, ours.about, [entry for _, entry, _ in running])


def bearing():
    """The bearing of second_code.md, timed by `fixtures/peers/second_code.py cost`: OpenRadioss is no package."""
    with open(RESULTS / "second_code_cost.csv") as file:
        rows = list(csv.DictReader(file))
    text = "The scene `second_code`, whose forces agree ([second code](second_code.md)), from " \
        "[second_code_cost.csv](second_code_cost.csv)."
    found = {}
    for row in rows:
        ours = {"program": "Stribeck", "version": "", "element": "one-point, total Lagrangian; node-to-segment"}
        problem = found.setdefault(row["problem"], Measured(row["problem"], text, int(row["elements"]), ours))
        about = {key: row[key] for key in ("program", "version", "element")}
        entry = next((entry for entry in problem.entries if entry.about == about), None)
        if entry is None:
            problem.entries.append(entry := Entry(about))
        entry.rounds.append([float(row[key]) for key in COLUMNS.split(",")[6:]])
    return list(found.values())


def digits(value):
    return f"{value:.{2 if value < 10 else 1 if value < 100 else 0}f}"


def spread(values):
    values = list(values)
    return digits(min(values)), digits(statistics.median(values))


def ratio(entry):
    return statistics.median(theirs / ours for ours, _, theirs, _ in entry.rounds)


def exponent(value, places):
    mantissa, power = f"{value:.{places}e}".split("e")
    return f"{mantissa}e{int(power)}"


def table(measured):
    least, median = spread(paces[0] for entry in measured.entries for paces in entry.rounds)
    lines = [
        f"\n## {measured.title}\n\n{measured.text}\n",
        "| program | element | least | median | times ours | displacements differ by |",
        "|---|---|---|---|---|---|",
        f"| **{measured.ours['program']}** | {measured.ours['element']} | **{least}** | **{median}** | 1 | |",
    ]
    for entry in measured.entries:
        differences = [
            f"{exponent(off, 1)}{'' if other == 'ours' else f' from {other}'}, limit {exponent(limit, 0)} ({reason})"
            + ("" if off <= limit else " **too much**")
            for other, off, limit, reason in entry.differences
        ]
        least, median = spread(paces[2] for paces in entry.rounds)
        about = entry.about
        lines.append(f"| {about['program']} {about['version']} | {about['element']} | {least} | {median} | "
                     f"{digits(ratio(entry))} | {'; '.join(differences)} |")
    return "\n".join(lines)


def page(rounds, all_measured, absent):
    ratios = [ratio(e) for m in all_measured for e in m.entries if not e.about["program"].startswith("Stribeck")]
    # Of blocks of several sizes the first is shown; the others are in the file of all runs.
    first = {m.title.split(" ")[0]: m for m in reversed(all_measured)}
    text = f"""# The same work in other programs

The same work takes {digits(min(ratios))} to {digits(max(ratios))} times ours in other programs.

Timed is the step loop alone, in ns of processor time per element and step on one thread in double precision, least and median \
of {rounds} runs; ours ran again directly before each run of another program, and the ratio is the median over these pairs. \
E 200 GPa, ν 0.3, ρ 7850 kg/m³. Written by `python xtask/peers/compare.py`; all runs are in [compare.csv](compare.csv).
"""
    text += "\n".join(table(m) for m in reversed(first.values())) + "\n"
    if absent:
        text += "\n## Left out\n\n" + "".join(f"- {name}: {why}\n" for name, why in absent.items())
    return text


def made_by(minutes):
    """Notes that this program made the page, as studies do."""
    commit = subprocess.run(["git", "log", "-1", "--format=%h,%cs"], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    digest = (ROOT / "fixtures/golden/digest").read_text().strip()
    file = RESULTS / "made_by.csv"
    own = f"compare,{digest},{commit or ','},{minutes:.0f},python xtask/peers/compare.py"
    lines = [own if line.startswith("compare,") else line for line in file.read_text().splitlines()]
    file.write_text("\n".join(lines) + "\n")


def main():
    began = time.monotonic()
    known = sorted({peer[0] for peer in ON_BLOCKS})
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--peers", metavar="NAMES", help=f"of {', '.join(known)} [default: all]")
    parser.add_argument("--quick", action="store_true", help="only the small problems, three rounds, and nothing written")
    parser.add_argument("--rounds", type=int, default=7)
    options = parser.parse_args()
    wanted = options.peers.split(",") if options.peers else known
    for name in wanted:
        if name not in known:
            parser.error(f"there is no peer `{name}`; known are {', '.join(known)}")
    rounds = 3 if options.quick else options.rounds
    subprocess.run(["cargo", "build", "--release", "--quiet", "-p", "stribeck-contact", "--example", "peer"], cwd=ROOT, check=True)
    ours = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve() / "release/examples/peer"
    absent, measured = {}, []
    chosen = lambda peers: [peer for peer in peers if peer[0] in wanted]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for columns, rows in [(210, 125), (420, 250)][: 1 if options.quick else 2]:
            elements = columns * rows
            words = [ours, "block", folder, str(columns), str(rows)]
            text = f"A free block of steel in plane strain, {columns} × {rows} squares of 0.5 mm, central differences of 50 ns, " \
                "lumped mass, no contact, started by a smooth velocity field of 1 m/s."
            file = folder / f"block-{elements}.json"
            measured.append(measure(f"Block of {elements} quads", text, elements, words, file, [100, 1000], chosen(ON_BLOCKS), rounds, absent, [*words, "random"]))
        if on_disc := chosen(ON_DISC):
            words, file = [ours, "squeeze", folder], folder / "squeeze.json"
            Program(words, folder).child.kill()
            problem = json.loads(file.read_text())
            quads, triangles = len(problem["quads"]), len(problem["triangles"])
            text = f"A disc of 18 mm between two blocks of 20 × 10 mm, elements of 0.5 mm ({quads} quads, {triangles} triangles); the " \
                "lower block is held, the upper one comes down with 1 m/s. Frictionless penalty contact (E / 0.5 mm), nodes of either " \
                f"side against facets of the other; steps of {1e9 * problem['time_step']:.2f} ns. Contact is part of the time per element."
            title, elements = f"Disc between two blocks, {quads + triangles} elements", quads + triangles
            measured.append(measure(title, text, elements, words, file, [1000, 4000], on_disc, rounds, absent))
    own = measured
    measured = own + bearing()
    print(page(rounds, measured, absent))
    if not options.quick:
        (RESULTS / "compare.md").write_text(page(rounds, measured, absent))
        with open(RESULTS / "compare.csv", "w") as file:
            file.write(COLUMNS + "\n")
            csv.writer(file, quoting=csv.QUOTE_MINIMAL, lineterminator="\n").writerows(row for m in measured for row in m.rows())
        made_by(max(1, (time.monotonic() - began) / 60))
    apart = [e.about["program"] for m in own for e in m.entries if any(not off <= limit for _, off, limit, _ in e.differences)]
    if apart:
        sys.exit(f"answers differ by more than their limits: {', '.join(apart)}")


if __name__ == "__main__":
    main()
