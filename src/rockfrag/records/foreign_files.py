"""What users give by mistake for a record, told by the first bytes of the file."""

import re

_GSE = "a GSE file, which is not read here; convert it with ObsPy: obspy.read(file).write('record.mseed', 'MSEED')"
_MAGIC: tuple[tuple[bytes, str], ...] = (
    (b"\xff\xfe", "UTF-16 text; save it as UTF-8"),
    (b"\xfe\xff", "UTF-16 text; save it as UTF-8"),
    (b"%PDF", "a PDF document"),
    (b"\xd0\xcf\x11\xe0", "an Excel workbook; save the sheet as CSV"),
    (b"version https://git-lfs", "a pointer of git-lfs; fetch the file itself with git lfs pull"),
    (b"\x89HDF", "an HDF5 file; export the record as text"),
    (b"MATLAB 5.0 MAT-file", "a MATLAB file; export the record as text"),
    (b"PAR1", "a Parquet table; export the record as text"),
    (b"\x89PNG", "a picture"),
    (b"\xff\xd8\xff", "a picture"),
    (b"7z\xbc\xaf", "an archive of a kind not unpacked here; unpack it first"),
    (b"WID1 ", _GSE),
    (b"WID2 ", _GSE),
    (b"XW01", _GSE),
    (b"BEGIN GSE", _GSE),
    (b"BEGIN IMS", _GSE),
    (b"Rar!", "an archive of a kind not unpacked here; unpack it first"),
)
_HTML = re.compile(rb"^\s*(?:<!--.*?-->\s*)*<(?:!doctype\s+html|html)\b", re.IGNORECASE | re.DOTALL)
_XML = re.compile(rb"^\s*<\?xml\b")
_SPECTRA = re.compile(
    rb"\b(?:response|fourier|pseudo\S*|elastic)\s+(?:\w+\s+){0,3}spectr", re.IGNORECASE
)


def foreign_kind(head: bytes) -> str:
    """Return what a file is, from its first bytes, if it is a known kind of no record; else ``""``."""
    for magic, kind in _MAGIC:
        if head.startswith(magic):
            return kind
    head = head.removeprefix(b"\xef\xbb\xbf")
    if not head.strip(b"\x00"):
        return "nothing but zero bytes"
    if _HTML.match(head):
        return "a web page (HTML), perhaps of a login or an error, and not the record"
    if _XML.match(head):
        station = b"StationXML" in head
        return "StationXML, which describes instruments and has no samples" if station else "XML"
    if b"\x00" not in head and _SPECTRA.search(head[:2000]):
        return "a file of spectra, not of acceleration in time"
    return ""
