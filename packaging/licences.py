#!/usr/bin/env python3
"""Prints the licences of all libraries that the programs contain: their condition is that the texts go with the programs.

Usage: licences.py PACKAGE... (from the workspace, with the libraries' sources where Cargo keeps them)
"""

import json
import pathlib
import re
import subprocess
import sys

NAMES = re.compile(r"licen[cs]e|copying|copyright|notice|unlicense", re.IGNORECASE)


def cargo(*arguments):
    command = ["cargo", *arguments, "--locked", "--offline"]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def contained(packages):
    """Names with versions of what is linked into the programs: neither build scripts nor macros are."""
    chosen = [word for package in packages for word in ("--package", package)]
    tree = cargo("tree", *chosen, "--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}")
    # `name vVERSION`, and a folder for those of the workspace.
    return {tuple(line.split()[:2]) for line in tree.splitlines() if line and " (/" not in line}


def main():
    host = next(
        line.split()[1]
        for line in subprocess.run(["rustc", "-vV"], check=True, capture_output=True, text=True).stdout.splitlines()
        if line.startswith("host:")
    )
    wanted = contained(sys.argv[1:])
    metadata = json.loads(cargo("metadata", "--format-version", "1", "--filter-platform", host))
    # Many texts are the same but for a name: each is printed once.
    texts = {}
    without = []
    for package in sorted(metadata["packages"], key=lambda package: package["name"]):
        if (package["name"], "v" + package["version"]) not in wanted:
            continue
        title = f"{package['name']} {package['version']} ({package['license']})"
        folder = pathlib.Path(package["manifest_path"]).parent
        files = [path for path in sorted(folder.iterdir()) if path.is_file() and NAMES.search(path.name)]
        for path in files:
            texts.setdefault(path.read_text(errors="replace").strip(), []).append(title)
        if not files:
            authors = ", ".join(package["authors"]) or "not named"
            without.append(f"{title}, by: {authors}")
        wanted.remove((package["name"], "v" + package["version"]))
    if wanted:
        sys.exit(f"licences.py: no sources of {sorted(wanted)}")
    print("The programs of ardrone-pilot contain these libraries, under these licences.\n")
    for text, titles in sorted(texts.items(), key=lambda item: item[1]):
        print("=" * 78)
        print("\n".join(sorted(set(titles))))
        print("-" * 78)
        print(text + "\n")
    if without:
        print("=" * 78)
        print("Published without a text of their licence:")
        print("\n".join(without))


main()
