"""What looks wrong: files of other kinds given for a record, units mistaken, records begun too late."""

import re

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.units import GRAVITY
from rockfrag.records.motion import SAID, Motion

_GSE = "a GSE file, which is not read here; convert it with ObsPy: obspy.read(file).write('record.mseed', 'MSEED')"
_KINDS: dict[tuple[bytes, ...], str] = {
    (b"\xff\xfe", b"\xfe\xff"): "UTF-16 text; save it as UTF-8",
    (b"%PDF",): "a PDF document",
    (b"\xd0\xcf\x11\xe0",): "an Excel workbook; save the sheet as CSV",
    (
        b"version https://git-lfs",
    ): "a pointer of git-lfs; fetch the file itself with git lfs pull",
    (b"\x89HDF",): "an HDF5 file; export the record as text",
    (b"MATLAB 5.0 MAT-file",): "a MATLAB file; export the record as text",
    (b"PAR1",): "a Parquet table; export the record as text",
    (b"\x89PNG", b"\xff\xd8\xff"): "a picture",
    (b"WID1 ", b"WID2 ", b"XW01", b"BEGIN GSE", b"BEGIN IMS"): _GSE,
    (b"7z\xbc\xaf", b"Rar!"): "an archive of a kind not unpacked here; unpack it first",
}
"""First bytes of files, and what these are."""

_HTML = re.compile(rb"^\s*(?:<!--.*?-->\s*)*<(?:!doctype\s+html|html)\b", re.I | re.S)
_XML = re.compile(rb"^\s*<\?xml\b")
_SPECTRA = re.compile(
    rb"\b(?:response|fourier|pseudo\S*|elastic)\s+(?:\w+\s+){0,3}spectr", re.I
)


def foreign_kind(head: bytes) -> str:
    """Return what a file is, from its first bytes, if it is a known kind of no record; else ``""``."""
    for magic, kind in _KINDS.items():
        if head.startswith(magic):
            return kind
    head = head.removeprefix(b"\xef\xbb\xbf")
    if not head.strip(b"\x00"):
        return "nothing but zero bytes"
    if _HTML.match(head):
        return "a web page (HTML), perhaps of a login or an error, and not the record"
    if _XML.match(head):
        station = b"StationXML" in head
        return (
            "StationXML, which describes instruments and has no samples"
            if station
            else "XML"
        )
    if b"\x00" not in head and _SPECTRA.search(head[:2000]):
        return "a file of spectra, not of acceleration in time"
    return ""


STRONGEST_G = 3.0  # peak [g] that hardly any record of an earthquake exceeds
# sampling interval [s] above which 20 Hz, which rocking bodies feel, are lost
_COARSEST = 0.025
DRIFT = "a drift"  # how the flag of a record that drifts begins
# fraction of the peak velocity that is left at the end of a record with a drift
_DRIFT = 0.5
# fraction of the peak velocity above which the mean of the last fifth of a record is a drift
_STILL = 0.1
_FEWEST_AT_END = 100  # samples of that fifth, fewer of which say nothing
# samples in a row at the largest value of a record cut off at its sensor's range
_CLIPPED_RUN = 4
# fraction of the peak in the first tenth of a second of a record begun too late
_LATE = 0.2
_SPIKE = 0.5  # fraction of the peak by which a lone sample leaves its neighbours
# ratio of a spike to what nine tenths of the samples leave their neighbours by
_SPIKE_RATIO = 20.0
# fraction of the samples that repeat the one before in a record of doubled samples
_DOUBLED = 0.9


def quality_flags(motion: Motion) -> list[str]:
    """Return what looks wrong in a motion, one phrase each; none for a record in order.

    Parameters
    ----------
    motion
        As read, in m/s².

    Returns
    -------
    list
        Phrases for tables and warnings.
    """
    a, peak = motion.acceleration, motion.pga
    if peak == 0:
        return ["all samples are zero"]
    # what its reader had to allow
    found = [str(step[SAID]) for step in motion.provenance if SAID in step]
    if peak > STRONGEST_G * GRAVITY:
        found.append(
            f"a peak of {peak / GRAVITY:.3g} g, above {STRONGEST_G:g} g (is the unit right?)"
        )
    if motion.dt > _COARSEST:
        found.append(
            f"a sampling interval of {motion.dt:g} s, too long for short impacts"
        )
    if a.size < 10:
        return [*found, f"only {a.size} samples"]
    velocity = np.cumsum(0.5 * (a[1:] + a[:-1]))
    left, fastest = abs(float(velocity[-1])), float(np.abs(velocity).max())
    left = left / fastest if fastest else 0.0
    if left > _DRIFT:
        found.append(
            f"{DRIFT}: {100 * left:.0f} % of the peak velocity is left at the end"
        )
    elif _drifts_on(velocity):
        found.append(f"{DRIFT}: its displacement still goes on at the end")
    edges = np.flatnonzero(
        np.diff(np.abs(a) >= peak * (1 - 1e-9), prepend=False, append=False)
    )
    if (edges[1::2] - edges[::2]).max() >= _CLIPPED_RUN:
        found.append("its peak is flat, as if clipped")
    first = a[: max(2, round(0.1 / motion.dt))]
    if first.size < a.size / 4 and np.abs(first).max() > _LATE * peak:
        found.append("strong from its first samples, as if triggered late")
    off = np.abs(a[1:-1] - 0.5 * (a[:-2] + a[2:]))
    if off.max() > max(_SPIKE * peak, _SPIKE_RATIO * float(np.quantile(off, 0.9))):
        found.append("a lone spike")
    if _is_doubled(a):
        found.append("every second sample repeats the one before it")
    return found


def _drifts_on(velocity: NDArray[np.float64]) -> bool:
    """Tell whether the mean velocity of the last fifth of a record is no longer that of shaking about a place."""
    last = velocity[-max(1, velocity.size // 5) :]
    fastest = float(np.abs(velocity).max())
    return last.size >= _FEWEST_AT_END and abs(float(last.mean())) > _STILL * fastest


def _is_doubled(a: NDArray[np.float64]) -> bool:
    """Whether every sample stands twice in a row."""
    moving = a[: a.size // 2 * 2].reshape(-1, 2)
    moving = moving[np.abs(moving).max(axis=1) > 0]
    if moving.shape[0] < 10 or np.unique(a).size < 10:
        return False
    shifted = a[1 : (a.size - 1) // 2 * 2 + 1].reshape(-1, 2)
    same = [float(np.mean(pairs[:, 0] == pairs[:, 1])) for pairs in (moving, shifted)]
    # a coarse record repeats samples everywhere, a doubled one at every second
    return max(same) > _DOUBLED and min(same) < 0.5
