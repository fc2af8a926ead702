"""Reading VTK's XML files, .vtu and .vts: text, base64, raw or compressed data, inline or appended.

Those two are what field maps come in most; they need nothing but the standard library. Everything else that VTK reads
(legacy .vtk, lz4 compression, parallel pieces) is left to VTK itself, the extra ``vtk``: see `reading`. Rejected:
meshio, which has no .vts, no compressed raw data, and no release since January 2024.
"""

import base64
import lzma
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from stability.errors import SceneError

NUMBERS = {"Float": "f", "Int": "i", "UInt": "u"}
DECOMPRESS: dict[str, Callable[[bytes], bytes]] = {
    "vtkZLibDataCompressor": zlib.decompress,
    "vtkLZMADataCompressor": lzma.decompress,
}


class NeedsVTKError(SceneError):
    """A file that only VTK itself reads."""


@dataclass(frozen=True)
class Piece:
    """What a file holds: kind, points (n, 3), arrays at points and cells, topology, and points each way of a grid."""

    kind: str
    points: np.ndarray
    at_points: dict[str, np.ndarray]
    at_cells: dict[str, np.ndarray]
    topology: dict[str, np.ndarray]
    shape: tuple[int, ...]


@dataclass(frozen=True)
class Source:
    """How the numbers of one file are written."""

    order: str
    header: np.dtype
    decompress: Callable[[bytes], bytes] | None
    appended: bytes
    raw: bool

    def array(self, element: Any) -> np.ndarray:
        """Return a DataArray."""
        kind = element.get("type", "Float64")
        letters = kind.rstrip("0123456789")
        if letters not in NUMBERS:
            return np.empty(0)  # text, which no field is made of
        dtype = np.dtype(f"{self.order}{NUMBERS[letters]}{int(kind[len(letters) :]) // 8}")
        form = element.get("format", "ascii")
        if form == "ascii":
            flat = np.array((element.text or "").split(), dtype=dtype)
        else:
            raw = self.raw and form == "appended"
            start = int(element.get("offset", 0))
            data = self.appended[start:] if form == "appended" else (element.text or "").strip().encode()
            flat = np.frombuffer(self.unpacked(data, raw), dtype=dtype)
        components = int(element.get("NumberOfComponents", 1) or 1)
        return flat.reshape(-1, components) if components > 1 else flat

    def unpacked(self, data: bytes, raw: bool) -> bytes:
        """Return the bytes of an array that starts here."""

        def length(count: int) -> int:
            """Return how many characters or bytes a block takes that is encoded on its own."""
            return count if raw else 4 * -(-count // 3)

        def cut(first: int, count: int) -> bytes:
            block = data[first : first + length(count)]
            return block if raw else base64.b64decode(block)[:count]

        width = self.header.itemsize
        first = int(np.frombuffer(cut(0, width), self.header)[0])
        if self.decompress is None:
            apart = raw or b"=" in data[: length(width)]  # VTK encodes the length on its own, others with the numbers
            return cut(length(width), first) if apart else cut(0, width + first)[width:]
        if not first:
            return b""
        sizes = np.frombuffer(cut(0, width * (3 + first)), self.header)[3:].astype(int)
        packed = cut(length(width * (3 + first)), int(sizes.sum()))
        ends = np.cumsum(sizes)
        return b"".join(self.decompress(packed[end - size : end]) for size, end in zip(sizes, ends, strict=True))


def read(path: Path) -> Piece:
    """Return the one piece of a .vtu or .vts file, or raise `SceneError` with the reason."""
    try:
        return parsed(path.read_bytes(), path.name)
    except (ElementTree.ParseError, ValueError, LookupError, AttributeError, zlib.error, lzma.LZMAError) as e:
        if isinstance(e, SceneError):
            raise
        raise SceneError(f"{path.name} is not a whole VTK XML file: {type(e).__name__}: {e}") from None


def parsed(content: bytes, name: str) -> Piece:
    """Return the piece in the bytes of a file; appended data, which need not be XML, are cut out first."""
    head, mark, tail = content.partition(b"<AppendedData")
    appended, raw = b"", False
    if mark:
        opening, _, appended = tail.partition(b"_")
        raw = b'"raw"' in opening
        end = appended.rfind(b"</AppendedData>")
        appended = appended[:end] if end >= 0 else appended
        head += b"</VTKFile>"
    root = ElementTree.fromstring(head)
    kind, compressor = root.get("type", ""), root.get("compressor")
    if kind not in ("UnstructuredGrid", "StructuredGrid"):
        raise NeedsVTKError(f"{name} holds a {kind or 'file of no known type'}: give .vtu or .vts")
    if compressor and compressor not in DECOMPRESS:
        raise NeedsVTKError(f"{name} is compressed by {compressor}: write it with zlib")
    order = "<" if root.get("byte_order", "LittleEndian") == "LittleEndian" else ">"
    source = Source(
        order=order,
        header=np.dtype(order + ("u8" if root.get("header_type") == "UInt64" else "u4")),
        decompress=DECOMPRESS[compressor] if compressor else None,
        appended=appended,
        raw=raw,
    )
    pieces = root.findall(f".//{kind}/Piece")
    if len(pieces) != 1:
        raise SceneError(f"{name} has {len(pieces)} pieces: merge them into one first")
    piece = pieces[0]

    def named(path: str) -> dict[str, np.ndarray]:
        return {e.get("Name", ""): source.array(e) for e in piece.findall(f"{path}/DataArray")}

    shape: tuple[int, ...] = ()
    if kind == "StructuredGrid":
        low_high = [int(n) for n in piece.attrib["Extent"].split()]
        shape = tuple(high - low + 1 for low, high in zip(low_high[::2], low_high[1::2], strict=True))[::-1]
    points = next(iter(named("Points").values()))
    return Piece(kind, points, named("PointData"), named("CellData"), named("Cells"), shape)
