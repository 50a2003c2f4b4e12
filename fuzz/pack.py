"""Packs folders into one archive, the same bytes for the same files: pack.py ARCHIVE.zip FOLDER...

Paths in it begin with the folder's own name. `python3 -m zipfile -e ARCHIVE.zip .` unpacks it.
"""

import pathlib
import sys
import zipfile


def pack(archive: pathlib.Path, folders: list[pathlib.Path]) -> int:
    """Writes the archive and returns how many files are in it."""
    files = sorted((f"{folder.name}/{path.relative_to(folder).as_posix()}", path)
                   for folder in folders for path in folder.rglob("*") if path.is_file())
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as out:
        for name, path in files:
            # A date of their own would make other bytes of the same files.
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            out.writestr(entry, path.read_bytes())
    return len(files)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    count = pack(pathlib.Path(sys.argv[1]), [pathlib.Path(p) for p in sys.argv[2:]])
    print(f"{sys.argv[1]}: {count} files")
