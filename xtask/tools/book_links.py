#!/usr/bin/env python3
"""A preprocessor of mdBook for docs/book.toml, so that links are valid in the repository and in the book.

A page of the book may include a page that lies outside of docs; the links of that one begin where it lies. A link to a file that is no
page of the book becomes its name: the book is read without the repository, too."""
import json
import posixpath
import re
import sys

INCLUDED = {
    "ARCHITECTURE.md": "architecture.md",
    "CONTRIBUTING.md": "contributing.md",
    "CHANGELOG.md": "changelog.md",
    "ardrone-link/README.md": "ardrone-link.md",
}
FOLDERS = {page: posixpath.dirname(source) for source, page in INCLUDED.items()}
# A block or a piece of code, in which nothing is a link, or a link.
LINK = re.compile(r"^ *```.*?^ *```|`[^`\n]*`|(!?)\[([^\]]*)\]\(([^)\s]+)\)", re.MULTILINE | re.DOTALL)


def relinked(text, folder):
    def link(match):
        image, label, target = match.groups()
        if target is None:
            return match[0]
        path, _, anchor = target.partition("#")
        if "://" in target or not path:
            return match[0]
        path = posixpath.normpath(posixpath.join("docs" if path.startswith("../") else folder, path))
        page = INCLUDED.get(path)
        if page is None and path.startswith("docs/"):
            page = path.removeprefix("docs/")
        if page is not None:
            return f"{image}[{label}]({page}{'#' if anchor else ''}{anchor})"
        return f"`{path}`" if posixpath.basename(path) in label else f"{label} (`{path}`)"

    return LINK.sub(link, text)


def chapters(items):
    for item in items:
        chapter = item.get("Chapter") if isinstance(item, dict) else None
        if chapter and chapter["path"]:
            folder = FOLDERS.get(chapter["path"], "docs")
            chapter["content"] = relinked(chapter["content"], folder)
            chapters(chapter["sub_items"])


if len(sys.argv) > 1 and sys.argv[1] == "supports":
    sys.exit(0)
_, book = json.load(sys.stdin)
chapters(book["sections"])
json.dump(book, sys.stdout)
