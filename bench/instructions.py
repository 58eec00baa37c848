#!/usr/bin/env python3
"""Counts the instructions of small fixed works, and says what has become slower.

usage: bench/instructions.py BUILD [--record]

BUILD has bench_instructions, for the baseline processor (valgrind knows no AVX-512). What
callgrind counts is compared with instructions.txt, which has a line for each compiler,
version of Embree and work: a count that differs by more than 3 % fails. --record writes
the counts of this compiler there, in place of those it had.
"""
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
RECORDS = HERE / "instructions.txt"
GLASS = HERE / "equal_time/scenes/cornell-glass.pbrt"
FOG = HERE / "equal_time/scenes/fog.pbrt"
RING = HERE.parent / "scenes/ring/ring.pbrt"
WORKS = [("photons", GLASS), ("photons", RING), ("map", GLASS), ("path", GLASS), ("auto", GLASS),
         ("photonmap", GLASS), ("photonmap", FOG), ("sppm", RING), ("vcm", GLASS)]
ALLOWED = 0.03


def count(program, work, scene):
    """Instructions within guarded() and all that it calls."""
    done = subprocess.run(
        ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
         "--toggle-collect=guarded", program, work, scene],
        stderr=subprocess.PIPE, text=True)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode or not found or found[1] == "0":
        sys.exit(f"instructions: {work} of {scene.stem} is not counted:\n{done.stderr}")
    return int(found[1])


def made_by(program):
    """The compiler that is written in the program, and the Embree that it is linked with."""
    comment = subprocess.run(["readelf", "-p", ".comment", program], check=True,
                             stdout=subprocess.PIPE, text=True).stdout
    compiler = re.search(r"(GCC: .*|.*clang version \S+)", comment)
    linked = subprocess.run(["ldd", program], check=True, stdout=subprocess.PIPE,
                            text=True).stdout
    embree = pathlib.Path(re.search(r"=> (\S*libembree\S+)", linked)[1]).resolve().name
    return f"{compiler[1].strip()}, {embree}"


def read():
    """{(maker, work): instructions}"""
    lines = RECORDS.read_text().splitlines() if RECORDS.exists() else []
    return {tuple(line.split("\t")[:2]): int(line.split("\t")[2]) for line in lines
            if line and not line.startswith("#")}


def write(records):
    lines = "".join(f"{maker}\t{work}\t{n}\n" for (maker, work), n in sorted(records.items()))
    RECORDS.write_text("# Written by bench/instructions.py BUILD --record\n" + lines)


def main():
    program = pathlib.Path(sys.argv[1]) / "bench/bench_instructions"
    recording = sys.argv[2:] == ["--record"]
    records, maker, wrong = read(), made_by(program), []
    if not recording and not any(key[0] == maker for key in records):
        print(f"instructions: skipped, nothing is recorded for {maker}; --record does that")
        return
    for work, scene in WORKS:
        key = (maker, f"{work} {scene.stem}")
        n, before = count(program, work, scene), records.get(key)
        change = n / before - 1 if before else float("inf")
        print(f"{key[1]:28}{n:12}{before or 0:12}{100 * change:+8.2f} %")
        if recording:
            records[key] = n
        elif abs(change) > ALLOWED:
            wrong.append(key[1])
    if recording:
        write(records)
    if wrong:
        sys.exit(f"instructions: more than {100 * ALLOWED:.0f} % off what is recorded: "
                 f"{', '.join(wrong)}; if that is meant: bench/instructions.py "
                 f"{sys.argv[1]} --record")


if __name__ == "__main__":
    main()
