"""Small records of every format, built here from the formats' definitions."""

import io
import tarfile
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

N = 43
"""Samples of a built record: no multiple of any row length, so that last rows are short."""


@dataclass(frozen=True)
class Built:
    """A built file and what must be read from it, samples in the unit of the file."""

    path: Path
    format: str
    samples: NDArray[np.float64]
    dt: float
    unit: str
    station: str = ""
    start_time: str | None = None
    components: tuple[str, ...] = ("",)
    tolerance: float = 0.0
    stated_dt: bool = True

    @property
    def dt_to_give(self) -> float | None:
        """The interval that a user has to name, None where the file states it."""
        return None if self.stated_dt else self.dt


def variant(built: Built, name: str, change: Callable[[bytes], bytes], **facts: Any) -> Built:
    """Write a record once more, changed and under another name."""
    content = change(built.path.read_bytes())
    built.path.unlink()
    path = built.path.with_name(name)
    path.write_bytes(content)
    return replace(built, path=path, **facts)


def wave(seed: int, scale: float, digits: int) -> NDArray[np.float64]:
    """Return samples that a field with so many decimals holds exactly."""
    t = np.arange(N) * 0.2
    noise = np.random.default_rng(seed).normal(size=N)
    return np.round(scale * (np.sin(t) + 0.3 * noise), digits)


def rows(values: NDArray[np.float64], per_line: int, form: Callable[[float], str]) -> str:
    fields = [form(value) for value in values]
    return "".join(
        "".join(fields[i : i + per_line]) + "\n" for i in range(0, len(fields), per_line)
    )


def fixed(width: int, digits: int) -> Callable[[float], str]:
    return lambda value: f"{value:{width}.{digits}f}"


def fortran_e(width: int, digits: int) -> Callable[[float], str]:
    """Fortran's E format with a leading zero before the point: ``-.1234567E-02``."""

    def form(value: float) -> str:
        if value == 0:
            return f"{'.' + '0' * digits + 'E+00':>{width}}"
        exponent = int(np.floor(np.log10(abs(value)))) + 1
        mantissa = f"{abs(value) / 10.0**exponent:.{digits}f}"[1:]
        return f"{('-' if value < 0 else '') + mantissa + f'E{exponent:+03d}':>{width}}"

    return form


def one_digit_exponent(value: float) -> str:
    """Fortran's 1PE10.4E1: ``-2.2223E-1`` fills its ten columns."""
    mantissa, exponent = f"{value:.4e}".split("e")
    return f"{mantissa}E{int(exponent):+d}".rjust(10)


def at2(path: Path, header: str, values: NDArray[np.float64], line_end: str = "\n") -> Built:
    text = header + rows(values, 5, fortran_e(15, 7))
    path.write_bytes(text.replace("\n", line_end).encode())
    return Built(path, "AT2", values[None, :], 0.005, "g", "GILROY ARRAY #3", None, ("090",), 1e-7)


_PEER = (
    "PEER STRONG MOTION DATABASE RECORD. PROCESSING BY PACIFIC ENGINEERING.\n"
    "LOMA PRIETA 10/18/89 00:05, GILROY ARRAY #3, 090 (CDMG STATION 47381)\n"
    "ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz\n"
)


def at2_peer(folder: Path) -> Built:
    return at2(folder / "peer.AT2", _PEER + f"NPTS=  {N}, DT= .00500 SEC\n", wave(1, 0.3, 5))


def seismosoft(folder: Path) -> Built:
    path, values = folder / "soft.dat", wave(5, 0.2, 4)
    lines = [
        "The Friuli (Italy) earthquake of May 06, 1976.",
        "Source: PEER Strong Motion Database",
        "Recording station: TOLMEZZO(000)",
        "Frequency range: 0.1-30.0 Hz",
        "Time[s] Accel[g]",
        *(f"{i * 0.01:.4f}\t{value:.4f}" for i, value in enumerate(values)),
    ]
    path.write_bytes("\r\n".join(lines).encode())
    return Built(path, "SEISMOSOFT", values[None, :], 0.01, "g", "TOLMEZZO", None, ("000",))


def cosmos_header(azimuth: int, comments: int) -> str:
    whole = [-999] * 100
    whole[39:45] = [2005, 167, 6, 16, 20, 53]
    whole[53] = azimuth
    real = [-999.0] * 100
    real[0:2] = [34.046, -117.035]
    real[29] = 4.4
    real[61] = 10.0
    lines = [
        "Corrected acceleration    (Format v01.20 with 13 text lines) Src: none",
        "Somewhere in Los Angeles, CA            June 16,2005 13:53 PDT",
        "Hypocenter: 34.0580  -117.0110  H= 12km(SCSN) ML=4.9",
        "Origin: 06/16/2005, 20:53:26.1 UTC (SCSN)",
        "Statn No: 01-23075  Code:CE-J2236  CDMG Yucaipa - Bryant & Oak Glen",
        "Coords: 34.0460 -117.0350  Site Geology:  none",
        "Recorder: SSA-2  s/n 1238 ( 1 Chns of 12  at Sta) Sensor:FBA-11  s/n 1889",
        "Rcrd start time:06/16/2005, 20:53:04.400 UTC (Q=2) RcrdId: none",
        f"Sta Chan  1: {azimuth} deg (Rcrdr Chan  1) Location: free field",
        "Processed: 06/17/2005, 12:01:00 PDT      Max =  -161.962 cm/sec2",
        "Values used when parameter or data value is unknown/unspecified:   -999, -999.0",
        " 100 Integer-header values follow on  10 lines, Format= (10I8)",
    ]
    text = "\n".join(lines) + "\n" + rows(np.array(whole), 10, lambda v: f"{int(v):8d}")
    text += " 100 Real-header values follow on  20 lines, Format= (5F15.6)\n"
    text += rows(np.array(real), 5, fixed(15, 6))
    text += f'  {comments} Comment line(s) follow, each starting with a "|":\n'
    return text + "".join(f"| {N} acceleration pts, a comment, units=g\n" for _ in range(comments))


def _cosmos(path: Path, text: str, samples: NDArray[np.float64], unit: str, *comps: str) -> Built:
    path.write_text(text)
    return Built(
        path, "COSMOS", samples, 0.01, unit, "J2236", "2005-06-16T20:53:04.400000Z", comps, 1e-9
    )


def cosmos_v1(folder: Path) -> Built:
    values = wave(6, 90.0, 5)
    text = cosmos_header(340, 2)
    text += f"   {N}  acceleration pts, approx   1 secs, units=cm/sec2(04),Format=(8F10.5)\n"
    text += rows(values, 8, fixed(10, 5)) + "/&  ------  End of data for channel  1  ------\n"
    return _cosmos(folder / "cosmos.v1", text, values[None, :], "cm/s2", "340")


def cosmos_touching(folder: Path) -> Built:
    """Fields that fill their columns, in g, and the last header line of another writer."""
    values = np.round(-1.5 - 0.1 * np.abs(wave(7, 1.0, 5)), 5)
    text = cosmos_header(90, 0)
    text += f"{N} acceleration pts, approx 1 secs, units=g (02),Format=(10F8.5)\n"
    text += rows(values, 10, fixed(8, 5)) + "End-of-data for Chan  1 acceleration\n"
    return _cosmos(folder / "touching.V2c", text, values[None, :], "g", "90")


def cosmos_v2(folder: Path) -> Built:
    """Two channels, each with acceleration, velocity and displacement."""
    text, kept = "", []
    for seed, azimuth in ((8, 90), (9, 180)):
        text += cosmos_header(azimuth, 1)
        for quantity, unit in (
            ("acceleration", "cm/sec2 (04)"),
            ("velocity", "cm/sec (05)"),
            ("displacement", "cm (06)"),
        ):
            values = wave(seed, 50.0, 3)
            kept += [values] if quantity == "acceleration" else []
            text += f" {N} {quantity} pts, approx 1 secs, units={unit},Format=(1E15.6)\n"
            text += rows(values, 1, lambda value: f"{value:15.6E}")
        text += "/&  ------  End of data  ------\n"
    return _cosmos(folder / "cosmos.V2", text, np.array(kept), "cm/s2", "90", "180")


def csmip_header(volume: int, chan: str, when: str) -> str:
    lines = ["UNCORRECTED ACCELEROGRAM DATA              PROCESSED:  6/06/83, CDMG"]
    if volume == 2:
        lines.insert(0, f"CORRECTED ACCELEROGRAM   36456-S4384       CHAN  1:  {chan}     FROM")
    lines += [
        "COALINGA EARTHQUAKE",
        "MAY 2, 1983 16:42 PDT                   (ORIGIN(BRK): 05/02/83, 23:42:38.5 UTC)",
        f"36456-S4384-83123.01               {when}",
        "STATION NO. 36456   35.908N, 120.458W     SMA-1  S/N 4384",
        "PARKFIELD FAULT ZONE 14",
        f"CHAN  1:  {chan}",
        "COALINGA EARTHQUAKE     MAY 2, 1983 16:42 PDT",
        "HYPOCENTER(BRK): 36.25N,120.28W, H=9KM.",
        "INSTR PERIOD =  .0407 SEC,  DAMPING =  .630,  SENSITIVITY = 1.87 CM/G.",
    ]
    if volume == 1:
        lines += [
            f"NO. OF POINTS =  {N}  RECORD LENGTH = 1.000 SEC",
            "UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = -0.051 G, AT   3.910 SEC.",
            "RMS ACCEL OF COMPLETE RECORD = 0.010 G",
        ]
    zeros = rows(np.zeros(100), 16, lambda value: f"{int(value):5d}")
    reals = rows(np.zeros(100 if volume == 2 else 50), 8, fixed(10, 3))
    return "\n".join(lines) + "\n" + zeros + reals


_TRIGGER = "TRIGGER TIME: 05/02/83, 16:42:48.2 PDT"
_TRIGGERED = "1983-05-02T23:42:48.200000Z"


def csmip_v2(folder: Path) -> Built:
    path, text, kept = folder / "csmip.V2", "", []
    for seed, chan in ((10, "90 DEG"), (11, "UP")):
        text += csmip_header(2, chan, _TRIGGER)
        for quantity, unit in (
            ("ACCEL", "CM/SEC/SEC"),
            ("VELOC", "CM/SEC"),
            ("DISPL", "CM"),
        ):
            values = wave(seed, 80.0, 3)
            kept += [values] if quantity == "ACCEL" else []
            text += (
                f" {N} POINTS OF {quantity} DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: {unit})\n"
            )
            text += rows(values, 8, fixed(10, 3))
        text += f"/&  ----------  END OF DATA FOR CHANNEL  {seed}  ----------\n"
    path.write_bytes(text.replace("\n", "\r\n").encode() + b"\x1a" * 40)
    return Built(
        path, "CSMIP", np.array(kept), 0.02, "cm/s2", "36456", _TRIGGERED, ("90", "UP"), 1e-9
    )


def csmip_v2_modern(folder: Path) -> Built:
    path, values = folder / "modern.v2", wave(12, 80.0, 6)
    text = csmip_header(2, "360 Deg", "Start time:  2/13/12, 21:06:45.0 UTC (GPS)")
    text += f" {N} points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)\n"
    text += rows(values, 8, fixed(10, 6)) + "/&  ------  End of data  ------\n"
    path.write_text(text)
    start = "2012-02-13T21:06:45.000000Z"
    return Built(path, "CSMIP", values[None, :], 0.005, "cm/s2", "36456", start, ("360",), 1e-9)


def csmip_v1(folder: Path) -> Built:
    path, values = folder / "csmip.V1", wave(13, 0.02, 6)
    text = csmip_header(1, "360 Deg", "").replace("UNITS OF UNCOR ACCEL ARE SEC AND G/10", "UNITS")
    text += f" {N} Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)\n"
    text += rows(values, 8, fixed(9, 6)) + "/&  ------  End of Data  ------\n"
    path.write_text(text)
    return Built(path, "CSMIP", values[None, :], 0.005, "g", "36456", None, ("360",), 1e-9)


def pair_rows(times: NDArray[np.float64], values: NDArray[np.float64], first: int) -> str:
    """Five pairs a line, 10F7.3, the first field ``first`` wide."""
    both = np.column_stack([times, values]).ravel()
    lines = []
    for i in range(0, both.size, 10):
        line = "".join(f"{value:7.3f}" for value in both[i : i + 10])
        lines.append(" " * (first - 7) + line + "\n")
    return "".join(lines)


def csmip_v1_pairs(folder: Path) -> Built:
    path, values = folder / "old.V1", wave(14, 0.8, 3)
    text = csmip_header(1, "90 DEG", _TRIGGER)
    text += pair_rows(990.0 + np.arange(N) * 0.02, values, 7) + "/&  END\n"
    path.write_text(text)
    return Built(path, "CSMIP", values[None, :], 0.02, "g/10", "36456", _TRIGGERED, ("90",), 1e-9)


def renadic(folder: Path) -> Built:
    path, text, kept = folder / "altohospicio0911131.v1", "", []
    for seed, chan in ((15, "EW"), (16, "NS"), (17, "V")):
        values = wave(seed, 0.8, 3)
        kept.append(values)
        header = csmip_header(1, chan, "TRIGGER TIME: 11/12/2009 23:10:03.000 GMT").split("\n")
        header[1] = "0911131"
        header[7] = "UNIVERSIDAD DE CHILE - RENADIC"
        header = [line for line in header if "STATION NO" not in line]
        text += "\n".join(header) + pair_rows(np.arange(N) * 0.01, values, 7) + "/&  END\n"
    path.write_text(text)
    start = "2009-11-12T23:10:03.000000Z"
    return Built(
        path,
        "RENADIC",
        np.array(kept),
        0.01,
        "g/10",
        "altohospicio",
        start,
        ("EW", "NS", "V"),
        1e-9,
    )


def usc(folder: Path) -> Built:
    """Points of a line a + b t at uneven times: interpolation to 200 Hz gives the line again."""
    path = folder / "usc.v1"
    times = np.round(np.cumsum(np.tile([0.004, 0.005, 0.004], 15)[:N]) - 0.004, 3)
    values = np.round(0.1 + 2.0 * times, 3)
    words = [
        "FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:",
        "NORTHRIDGE EARTHQUAKE",
        "JAN 17, 1994 -1230 GMT",
        "IBB123  94.570.0 N",
        "STATION USC# 0057   34 25 09N, 118 25 34W",
        "16628 W. LOST CANYON RD., CANYON COUNTRY, CA",
        "COMP N00W",
        "NORTHRIDGE EARTHQUAKE   JAN 17, 1994 -1230 GMT",
        "EPICENTER -   34 12 48N, 118 32 13W",
        "INSTR PERIOD =  .039 SEC  DAMPING =   .577  SENSITIVITY =   1.86CM/G",
        f"NO. OF POINTS =   {N}      DURATION =   1.000 SEC",
        "UNITS ARE SEC AND G/10",
        "RMS ACCLN. OF COMPLETE RECORD =     .638 G/10",
    ]
    text = words[0] + "\n" + "".join(f"{w:72s}{len(w)}\n" for w in words[1:])
    text += rows(np.zeros(100), 16, lambda value: f"{int(value):5d}")
    text += rows(np.zeros(50), 8, fixed(10, 3)) + pair_rows(times, values, 8)
    path.write_text(text)
    grid = np.arange(int(times[-1] / 0.005 + 1e-9) + 1) * 0.005
    line = np.round(0.1 + 2.0 * grid, 6)
    return Built(path, "USC", line[None, :], 0.005, "g/10", "0057", None, ("N00W",), 1e-9)


def smc_text(values: NDArray[np.float64], comments: int, precise: bool, kind: str) -> str:
    whole = [-32768] * 48
    whole[1:7] = [1989, 291, 0, 4, 15, 250]
    whole[12], whole[13], whole[15], whole[16] = 90, 360, comments, N
    whole[46] = 8 if precise else 6
    real = [1.7e38] * 50
    real[1], real[10], real[11] = 200.0, 37.728, -122.385
    lines = [
        kind,
        "*",
        "SAF0A",
        "     1989  10  18    0004 Loma Prieta, CA",
        "Moment Mag=      7.1 Ms=      7.1 Ml=      7.0",
        "station = San Francisco, 1295 Shafter, F component=    360",
        "epicentral dist =     89.0       pk     =    104.4",
        "inst type=SMA-1      data source = USGS",
        *"***",
    ]
    text = "\n".join(lines) + "\n" + rows(np.array(whole), 8, lambda v: f"{int(v):10d}")
    text += rows(np.array(real), 5, lambda v: f"{v:15.7E}")
    text += "".join(f"|comment {i} 1.0 2.0\n" for i in range(comments))
    if precise:
        return text + rows(values, 5, lambda v: f"{v:14.7E}")
    return text + rows(values, 8, one_digit_exponent)


def _smc(path: Path, text: str, values: NDArray[np.float64]) -> Built:
    path.write_bytes(text.replace("\n", "\r\n").encode())
    start = "1989-10-18T00:04:15.250000Z"
    return Built(path, "SMC", values[None, :], 0.005, "cm/s2", "SAF0", start, ("360",), 1e-12)


def smc(folder: Path) -> Built:
    values = np.array([float(f"{v:.4e}") for v in wave(18, 30.0, 9)])
    return _smc(
        folder / "corrected.smc", smc_text(values, 3, False, "2 CORRECTED ACCELEROGRAM"), values
    )


def smc_precise(folder: Path) -> Built:
    values = np.array([float(f"{v:.7e}") for v in wave(19, 30.0, 12)])
    return _smc(folder / "raw.smc", smc_text(values, 0, True, "1 UNCORRECTED ACCELEROGRAM"), values)


def smc_uneven(folder: Path) -> Built:
    """Pairs of time and acceleration on a line, at uneven times; the count is of all values."""
    times = np.array([float(f"{t:.4e}") for t in np.cumsum(np.tile([0.004, 0.006], 21)) - 0.004])
    both = np.array([float(f"{v:.4e}") for v in np.column_stack([times, 5 + 20 * times]).ravel()])
    text = smc_text(both, 2, False, "1 UNCORRECTED ACCELEROGRAM").split("\n")
    text[13] = f"{both.size:10d}" + text[13][10:]
    text[17] = text[17][:15] + f"{1.7e38:15.7E}" + text[17][30:]
    line = 5 + 20 * np.arange(int(times[-1] / 0.005 + 1e-9) + 1) * 0.005
    built = _smc(folder / "uneven.smc", "\n".join(text), line)
    return replace(built, tolerance=1e-3)


def esm_text(values: NDArray[np.float64], kind: str, first: str) -> str:
    lines = [
        "EVENT_NAME: GREECE",
        "EVENT_ID: EMSC-20190728_0000106",
        "EVENT_DATE_YYYYMMDD: 20190728",
        "EVENT_TIME_HHMMSS: 160908",
        "MAGNITUDE_W: ",
        "MAGNITUDE_L: 4.6",
        "NETWORK: HL",
        "STATION_CODE: DLFA",
        "STATION_NAME: Delfoi, Ελλάς",
        "LOCATION: ",
        f"DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS: {first}",
        "SAMPLING_INTERVAL_S: 0.005000",
        f"NDATA: {N}",
        "STREAM: HNN",
        "UNITS: cm/s^2",
        "INSTRUMENT: sensor = CMG_5 [Unknown] | digitizer = Unknown [Unknown]",
        "HEADER_FORMAT: DYNA 1.2",
        f"DATA_TYPE: {kind}",
        "USER5: ",
        *(f"{value:.6f}" for value in values),
    ]
    return "\n".join(lines) + "\n"


def esm(folder: Path) -> Built:
    path, values = folder / "esm.ASC", wave(20, 3.0, 6)
    text = esm_text(values, "ACCELERATION", "20190728_160905.700")
    path.write_text(text, encoding="utf-8")
    start = "2019-07-28T16:09:05.700000Z"
    return Built(path, "ESM", values[None, :], 0.005, "cm/s2", "DLFA", start, ("HNN",))


def esm_tadas(folder: Path) -> Built:
    """As AFAD's TADAS delivers: a first line without a key, the kind and the day in another way."""
    path, values = folder / "20230206011732_0118_ap_AAD_Acc_E.asc", wave(21, 3.0, 6)
    head = (
        "AAD_Filtered_TADAS_FILE\nAAD_FILTER_TYPE: BUTTERWORTH\nAAD_LOW_CUT_FREQUENCY_HZ: 0.025\n"
    )
    text = head + esm_text(values, "Acceleration", "14/11/2010 23:09:19.300")
    path.write_text(text.replace("LOCATION: ", "LOCATION: HATAY_HASSA"), encoding="utf-8")
    start = "2010-11-14T23:09:19.300000Z"
    return Built(path, "ESM", values[None, :], 0.005, "cm/s2", "DLFA", start, ("HNN",))


def geonet_component(component: str, values: NDArray[np.float64], corrected: bool) -> str:
    whole = [0] * 40
    whole[8:10], whole[18:20], whole[38:40] = [2016, 11], [13, 11], [2, 20500]
    whole[30] = 4 * N if corrected else N
    whole[33:36] = [N, N, N] if corrected else [N, 0, 0]
    real = [0.0] * 60
    real[10:12], real[14], real[24:26] = [42.523, 172.830], 7.82, [0.005, 0.02]
    if not corrected:
        real[25] = 0.005
    words = [
        f"{'C' if corrected else 'Unc'}orrected accelerogram 20161113_110256_HSES_20 GNS Science",
        "Site HSES      42 31 24S  172 49 50E     Basalt file:  20161113_110300_HSES",
        "Hanmer Springs Emergency Centre",
        "Instrument Basalt_2430",
        "Resolution: 24-bit   Instr Period: 0.0050 s   Damping: 0.700",
        "Accelerogram 20161113_110256_HSES_20                 Processed 2016 December 09",
        "5 km south-west of Waiau",
        "2016 November 13         11:02:56 UT",
        "Epicentre  42 41 33S 173 01 19E  Bearing S40E  Dist   25km  Depth   15km Mw 7.82",
        f"Number of points  {N}    Duration 0.86 s",
        "Instrument corrected data at 0.020 sec intervals"
        if corrected
        else "Raw readings in units of 1.00 mm/s/s  at intervals of 0.005 s",
        "Data is unfiltered",
        f"Component {component}",
        "Acceleration:  Peak   2394.8 mm/s/s at  48.13 s     RMS   209.89 mm/s/s",
        "Velocity record unevaluated",
        "Displacement record unevaluated",
    ]
    text = "\n".join(words) + "\n" + rows(np.array(whole), 10, lambda v: f"{int(v):8d}")
    text += rows(np.array(real), 10, fixed(8, 3))
    text += rows(values, 10, fixed(8, 1))
    if corrected:
        text += rows(values / 10, 10, fixed(8, 2)) + rows(values / 100, 10, fixed(8, 3))
    return text


def _geonet(path: Path, corrected: bool, dt: float) -> Built:
    components = ("N10E", "N80W", "Up")
    # -1234.5 and more fill the columns, so that neighbours touch
    values = [wave(seed, 12000.0, 1) - 20000.0 for seed in (22, 23, 24)]
    text = "".join(
        geonet_component(c, v, corrected) for c, v in zip(components, values, strict=True)
    )
    path.write_text(text)
    start = "2016-11-13T11:02:20.500000Z"
    return Built(path, "GEONET", np.array(values), dt, "mm/s2", "HSES", start, components, 1e-6)


def geonet_v1a(folder: Path) -> Built:
    return _geonet(folder / "hses.V1A", False, 0.005)


def geonet_v2a(folder: Path) -> Built:
    return _geonet(folder / "hses.V2A", True, 0.02)


def cwa(folder: Path) -> Built:
    path = folder / "cwa.txt"
    values = np.array([wave(seed, 40.0, 3) for seed in (25, 26, 27)])
    lines = [
        "#Earthquake Information",
        "#Origin Time(GMT+08): 2018/02/06-23:50:42",
        "#Magnitude(Ml): 6.0",
        "#StationCode: ECU",
        "#StationName: Chulu",
        "#StartTime(GMT+08): 2018/02/06-23:50:29.000",
        "#RecordLength(sec): 1",
        "#SampleRate(Hz): 50",
        "#AmplitudeUnit:  gal. DCoffset(corr)",
        "#DataSequence: Time U(+); N(+); E(+)",
        "#Data: 4F10.3",
        *("".join(f"{value:10.3f}" for value in (i * 0.02, *values[:, i])) for i in range(N)),
    ]
    path.write_text("\n".join(lines) + "\n")
    start = "2018-02-06T15:50:29.000000Z"
    return Built(path, "CWA", values, 0.02, "cm/s2", "ECU", start, ("U", "N", "E"), 1e-9)


def plain_two_columns(folder: Path) -> Built:
    path, values = folder / "plain.txt", wave(28, 0.3, 5)
    path.write_text("".join(f"{i * 0.02:.7e}   {v:.7e}\n" for i, v in enumerate(values)))
    return Built(path, "PLAINTEXT", values[None, :], 0.02, "")


def plain_csv(folder: Path) -> Built:
    path, values = folder / "plain.csv", wave(29, 0.3, 5)
    head = "Time (s),Acceleration (m/s^2)\r\n"
    path.write_bytes(
        (head + "".join(f"{i / 100},{v!r}\r\n" for i, v in enumerate(values.tolist()))).encode()
    )
    return Built(path, "PLAINTEXT", values[None, :], 0.01, "m/s2")


def plain_count_then_columns(folder: Path) -> Built:
    """``npts dt`` above two columns whose time starts at dt."""
    path, values = folder / "count.txt", wave(31, 0.3, 5)
    body = "".join(f" {(i + 1) * 0.005:.6g}   {v!r}\n" for i, v in enumerate(values.tolist()))
    path.write_text(f" {N}  0.005\n" + body)
    return Built(path, "PLAINTEXT", values[None, :], 0.005, "")


def plain_one_column(folder: Path) -> Built:
    path, values = folder / "eqsig.txt", wave(32, 0.3, 5)
    path.write_text(f"test-motion\n{N} 0.0100\n" + "".join(f"{v!r}\n" for v in values.tolist()))
    return Built(path, "PLAINTEXT", values[None, :], 0.01, "")


def afad(folder: Path) -> Built:
    """In the network's own ISO 8859-9."""
    path = folder / "20170720223109_4806.txt"
    values = np.array([wave(seed, 40.0, 6) for seed in (40, 41, 42)])
    lines = [
        "STRONG GROUND MOTION RECORDS OF TURKIYE",
        "PLACE                   : MUĞLA MİLAS",
        "EARTHQUAKE DATE         : 2017/07/20 22:31:09 (GMT)",
        "EARTHQUAKE MAGNITUDE    : 6.5 Mw",
        "STATION ID              : 4806",
        "STATION COORDINATES     : 37.30253N-27.78054E",
        "RECORD TIME             : 20/07/2017 22:30:59.000000 (GMT)",
        f"NUMBER OF DATA          : {N}",
        "SAMPLING INTERVAL (sec) : 0.01",
        "RAW PGA VALUES (gal)    : (N-S) 58.542232 (E-W) 59.994425 (U-D) 25.542791",
        "       N-S          E-W          U-D",
        *("".join(f"{value:13.6f}" for value in values[:, i]) for i in range(N)),
    ]
    path.write_bytes(("\r\n".join(lines) + "\r\n").encode("iso8859-9"))
    start = "2017-07-20T22:30:59.000000Z"
    return Built(path, "AFAD", values, 0.01, "cm/s2", "4806", start, ("N-S", "E-W", "U-D"), 1e-9)


def bhrc(folder: Path) -> Built:
    """Three components; header lines are cut after 70 columns."""
    path, text, kept = folder / "5526-1.V1", "", []
    for seed, name in ((43, "L"), (44, "V"), (45, "T")):
        values = wave(seed, 0.05, 7)
        kept.append(values)
        words = [
            "* VOL1DS FILE:  5526/01",
            "Inst Type = SSA-2",
            "Origin Time : 2012/08/11   12:23:16",
            "",
            name,
            "",
            f"COMP {name}1",
            "Avin                      Station   37.734 N 47.801 E   Altitude 2026m   Azimuth L 50    T 140",
            "Epicenter 38.520 N 46.860 E   FD 12 Km mb      Ms      Mw6.1   M        ML   (BHRC)",
            "INSTR PERIOD =  .020 SEC   DAMPING =  .640",
            f"NO. OF POINTS =   {N}      DURATION =  {N * 0.005:.3f}",
            "UNITS ARE SECONDS AND G/10",
            "",
        ]
        whole = rows(np.zeros(100), 16, lambda value: f"{int(value):5d}")
        real = np.zeros(50)
        real[8] = 200.0
        numbers = rows(real, 8, fortran_e(13, 6))
        cut = "".join(line[:70] + "\n" for line in (whole + numbers).splitlines())
        text += "\n".join(words) + "\n" + cut + rows(values, 10, fortran_e(13, 6)) + "/&\n"
    path.write_text(text)
    names = ("L", "V", "T")
    return Built(path, "BHRC", np.array(kept), 0.005, "g/10", "Avin", None, names, 1e-7)


def unam(folder: Path) -> Built:
    """Two samples more than the nominal duration has; the record begins after midnight."""
    path = folder / "CUP50401.012"
    values = np.array([wave(seed, 40.0, 3) for seed in (46, 47, 48)])
    ruler = "---------+---------+---------+"
    lines = [
        "ARCHIVO ESTANDAR DE ACELERACION:",
        "NOMBRE DE LA ESTACION                  : IDEI PATIO 5",
        "CLAVE DE LA ESTACION                   : CUP5",
        "LOCALIZACION DE LA ESTACION            : Ingeniería,",
        "                                       : México",
        "COORDENADAS DE LA ESTACION             : 19.33024 LAT. N",
        "                                       : 99.181076 LONG. W",
        "ORIENTACION C1-C6 (rumbo;orientacion)  : /V/N90E/N00E",
        "INTERVALO DE MUESTREO, C1-C6 (s)       : /0.004/0.004/0.004",
        "FECHA DEL SISMO [GMT]                  : 2004/01/01",
        "HORA EPICENTRO (GMT)                   : 23:58:02.7",
        "MAGNITUD(ES)                           : /Mb=5.2/Ms=5.8",
        "HORA DE LA PRIMERA MUESTRA (GMT)       : 00:00:01",
        f"NUM. TOTAL DE MUESTRAS, C1-C6          : /{N - 2}/{N - 2}/{N - 2}",
        "UNIDADES DE LOS DATOS                  : Gal (cm/s/s)",
        "FORMATO DATOS (FORTRAN,10 campos/dato) : 3F10.3",
        "DATOS DE ACELERACION:",
        ruler,
        "   CANAL-1   CANAL-2   CANAL-3",
        "         V      N90E      N00E",
        ruler,
        *("".join(f"{value:10.3f}" for value in values[:, i]) for i in range(N)),
    ]
    path.write_bytes(("\n".join(lines) + "\n").encode("latin-1"))
    start, names = "2004-01-02T00:00:01.000000Z", ("V", "N90E", "N00E")
    return Built(path, "UNAM", values, 0.004, "cm/s2", "CUP5", start, names, 1e-9)


def csmnc(folder: Path) -> Built:
    path, values = folder / "ua0004.dat", wave(49, 3.0, 6)
    lines = [
        "065SBY120103153901",
        "0120103153957 2012-01-03 15:39:57 BTM",
        "ATUSHI EARTHQUAKE, ATUSHI,CHN",
        "EPICENTER  39.939N 77.339E DEPTH 9 KM",
        "MAGNITUDE  4.0(Ms)",
        "STATION: 65SBY 39.299N 77.800E",
        "SITE CONDITION: SOIL",
        "INSTRUMENT TYPE: ETNA/ES-T",
        "OBSERVING POINT: GROUND",
        "COMP. EW",
        "UNCORRECTED ACCELERATION          UNIT: CM/SEC/SEC",
        f"NO. OF POINTS:  {N}  EQUALLY SPACED INTERVALS OF:  0.005  SEC",
        "PEAK VALUE:    3.262   AT   22.89 SEC    DURATION:  44 SEC",
        "PRE-EARTHQUAKE TIME:  20  SEC  RECORDER TIME:  2012-01-3 15:40:00.000 BTM",
        "CSMNC",
        "",
    ]
    path.write_text("\n".join(lines) + "\n" + rows(values, 8, lambda v: f"{float(v)!r:>14}"))
    return Built(path, "CSMNC", values[None, :], 0.005, "cm/s2", "65SBY", None, ("EW",))


def usc_volume_2(folder: Path) -> Built:
    path, values = folder / "017m30bt.s0a", wave(50, 200.0, 3)
    words = [
        "CORRECTED ACCELEROGRAM  IIBB127  94.610.0 COMP N08W   FILE   0  CORRESPONDING T",
        "FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:",
        "NORTHRIDGE EARTHQUAKE",
        "JAN 17, 1994 -1230 GMT",
        "IBB127  94.610.0 N",
        "STATION USC# 0061   34 17 11N, 118 13 31W",
        "BIG TUJUNGA STATION, ANGELES NATIONAL FOREST, CA",
        "COMP N08W",
        f"  {N}  INSTRUMENT AND BASELINE CORRECTED DATA",
        f"PEAK ACCELERATION =  {np.abs(values).max():.5f}  CMS/SEC/SEC AT    4.580   SEC.",
    ]
    text = "\n".join(words) + "\n" + rows(np.zeros(100), 16, lambda value: f"{int(value):5d}")
    text += rows(np.zeros(100), 8, fixed(10, 3))
    text += f"  {N} POINTS OF ACC DATA EQUALLY SPACED AT   .020 SEC.\n"
    path.write_text(text + rows(values, 8, fixed(10, 3)))
    return Built(path, "USC2", values[None, :], 0.02, "cm/s2", "0061", None, ("N08W",), 1e-9)


def agram(folder: Path) -> Built:
    path, text, kept = folder / "usaca40.044", "", []
    for kind, seed in (("AC", 51), ("VL", 52), ("DP", 53)):
        # -1234.56 and more fill the columns, so that neighbours touch
        values = wave(seed, 200.0, 2) - 2000.0
        kept.append(values)
        text += (
            " WHITTIER, 7215 BRIGHT AVE, 10TH FLOOR\n 090 DEGREES\n EARTHQUAKE OF OCTOBER 1, 1987 1442 GMT\n "
            "BUTTERWORTH AT .25 HZ, ORDER 4\n YEAR=1987 JULIAN DAY=274 HOUR=14 MINUTE=42 SECOND= 0 COMPONENT=  "
            f"90\n SAMPLES/SEC=200 FILTER TYPE=BUTTERWORTH  CORNER= 0.25 ORDER=4 DATA TYPE={kind}\n NO OF "
            f"POINTS=  {N}, UNITS=CM/SEC**2, CM/SEC, AND CM\n"
        )
        text += rows(values, 10, fixed(8, 2))
    path.write_text(text)
    station, start = "WHITTIER, 7215 BRIGHT AVE, 10TH FLOOR", "1987-10-01T14:42:00.000000Z"
    return Built(path, "AGRAM", np.array(kept[:1]), 0.005, "cm/s2", station, start, ("090",), 1e-9)


def columns(folder: Path) -> Built:
    path = folder / "three.csv"
    values = np.array([wave(seed, 40.0, 8) for seed in (54, 55, 56)])
    lines = ["time,acc_NS(gal),acc_EW(gal),acc_UD(gal)"]
    lines += [",".join([f"{i * 0.01:.2f}", *map(repr, values[:, i].tolist())]) for i in range(N)]
    path.write_text("\n".join(lines) + "\n")
    return Built(path, "PLAINTEXT", values, 0.01, "cm/s2", components=("NS", "EW", "UD"))


def columns_of_quantities(folder: Path) -> Built:
    """Behind a byte-order mark, with decimal commas, and velocity and displacement beside."""
    path, values = folder / "avd.csv", wave(57, 0.3, 6)
    lines = ["\ufeffTime [s];Acceleration [g];Velocity [m/s];Displacement [m]"]
    lines += [f"{i * 0.01:.2f};{v!r};{2 * v:.6f};0.5" for i, v in enumerate(values.tolist())]
    path.write_text("\n".join([lines[0], *(line.replace(".", ",") for line in lines[1:])]))
    return Built(path, "PLAINTEXT", values[None, :], 0.01, "g")


def rows_of_numbers(folder: Path) -> Built:
    path, values = folder / "ARL360.g3", wave(58, 0.3, 5)
    path.write_text(rows(values, 5, fortran_e(15, 7)) + " *** End data ***\n")
    return Built(path, "PLAINTEXT", values[None, :], 0.02, "", tolerance=1e-7, stated_dt=False)


def opensees(folder: Path) -> Built:
    path, values = folder / "series.tcl", wave(59, 0.3, 5)
    body = rows(values, 6, fixed(10, 5))
    path.write_text(
        f"# acceleration in m/s2\nset g 9.81\ntimeSeries Path 7 -dt 0.02 -values {{\n{body}}} "
        "-factor 2.0\npattern UniformExcitation 1 1 -accel 7\n"
    )
    return Built(path, "OPENSEES", 2 * values[None, :], 0.02, "m/s2", components=("7",))


def cwa_1999(folder: Path) -> Built:
    """As the CWB wrote the Chi-Chi earthquake: from the station's code on, in UTC."""

    def change(content: bytes) -> bytes:
        text = content[content.index(b"#StationCode") :].replace(b"#StationName: Chulu\n", b"")
        return text.replace(b"(GMT+08): 2018/02/06-23:50:29", b": 1999/09/20-17:47:04")

    return variant(cwa(folder), "cx921.txt", change, start_time="1999-09-20T17:47:04.000000Z")


def unam_senses(folder: Path) -> Built:
    """Orientations with their sense behind them, in another order of channels."""
    names = b": /V/N90E/N00E", b": /N90E;/N00E;/V;+"
    components = ("N90E", "N00E", "V")
    name = "RAC_04042010222544.dat"
    return variant(unam(folder), name, lambda text: text.replace(*names), components=components)


def smc_surplus(folder: Path) -> Built:
    """A line of scattered points below the last pair that the header counts, which fills no whole line."""
    line = b" 3.0000E-1 1.0000E+1 4.0000E-1 2.0000E+1\r\n"
    return variant(smc_uneven(folder), "surplus.smc", lambda content: content + line)


def eerl_volume_2(folder: Path) -> Built:
    """Caltech's own volume 2: count, interval and unit in words alone, three sections without titles."""
    path, values = folder / "iia001.v2", wave(60, 200.0, 3)
    words = [
        "CORRECTED ACCELEROGRAM IIA001    40.001.0",
        "COMP S00E   FILE   1  CORRESPONDING TO",
        "FILE   1 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I-A, EERL 70-20",
        "SOME VALLEY EARTHQUAKE",
        "MAY 18, 1940 - 2037 PST",
        "STATION NO. 117   32 47 43N, 115 32 55W",
        "SITE OF THE STATION",
        "COMP S00E",
        f"  {N}  INSTRUMENT AND BASELINE CORRECTED DATA",
        "AT EQUALLY-SPACED INTERVALS OF    .020  SEC.",
        f"PEAK ACCELERATION =  {np.abs(values).max():.5f}  CMS/SEC/SEC AT    2.120   SEC.",
    ]
    text = "\n".join(words) + "\n" + rows(np.zeros(100), 16, lambda value: f"{int(value):5d}")
    text += rows(np.zeros(100), 8, fixed(10, 3))
    text += "".join(rows(factor * values, 8, fixed(10, 3)) for factor in (1.0, 0.1, 0.01))
    path.write_text(text)
    return Built(path, "USC2", values[None, :], 0.02, "cm/s2", "117", None, ("S00E",), 1e-9)


BUILDERS: dict[str, Callable[[Path], Built]] = {
    name: made
    for name, made in list(globals().items())
    if getattr(made, "__annotations__", None) == {"folder": Path, "return": Built}
}
"""Every function above that makes a record in a folder."""


def pack(path: Path, members: Mapping[str, bytes], packing: int = zipfile.ZIP_STORED) -> Path:
    """Pack files into a zip archive."""
    with zipfile.ZipFile(path, "w", packing) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


def pack_tar(path: Path, members: Mapping[str, bytes]) -> Path:
    """Pack files into a tar archive, compressed if its name says so."""
    with tarfile.open(path, "w:gz" if path.suffix == ".gz" else "w") as archive:
        for name, content in members.items():
            info = tarfile.TarInfo(name)
            info.size = len(content)
            archive.addfile(info, io.BytesIO(content))
    return path


def knet_text() -> str:
    """Return four seconds of K-NET at 100 Hz, which ObsPy reads."""
    lines = [
        "Origin Time       2018/01/24 19:51:00", "Lat.              41.0", "Long.             142.5",
        "Depth. (km)       34", "Mag.              6.3", "Station Code      AOM001",
        "Station Lat.      41.5", "Station Long.     140.9", "Station Height(m) 10",
        "Record Time       2018/01/24 19:51:43", "Sampling Freq(Hz) 100Hz", "Duration Time(s)  4",
        "Dir.              E-W", "Scale Factor      7845(gal)/8223790", "Max. Acc. (gal)   4.1",
        "Last Correction   2018/01/24 19:51:27", "Memo.",
    ]  # fmt: skip
    samples = np.round(1e4 * np.sin(np.arange(400) * 0.1))
    return "\n".join([*lines, rows(samples, 8, lambda v: f"{int(v):9d}")])


def search_results(count: int) -> str:
    """Return the ``_SearchResults.csv`` of a download of ``count`` records of PEER's database."""
    lines = [
        "PEER Ground Motion Database Search Results",
        "",
        " -- Summary of PEER Ground Motion Database Search Criteria --",
        "Target Spectrum,No Scaling",
        "",
        " -- Summary of Metadata of Selected Records --",
        "Result ID, Spectral Ordinate, Record Sequence Number, MSE, Scale Factor, Tp(s), 5-75% Duration(sec), "
        "5-95% Duration (sec), Arias Intensity (m/sec), Earthquake Name, Year, Station Name, Magnitude, "
        "Mechanism, Rjb (km), Rrup (km), Vs30 (m/sec), Lowest Useable Frequency (Hz), Horizontal-1 Acc. "
        "Filename, Horizontal-2 Acc. Filename, Vertical Acc. Filename",
    ]
    for i in range(count):
        number = 700 + i
        stem = f"RSN{number}_LOMAP_S{i:02d}"
        vertical = f"{stem}-UP.AT2" if i % 4 else "---------------------"
        lines.append(
            f"{i + 1}, SRSS, {number}, -----, {1 + i / 10:.4f}, -----, 7.0, 12.0, 2.1,"
            f' "Loma Prieta", 1989, "Station {i}", 6.93, Reverse Oblique, {3.0 + i:.2f},'
            f" {4.0 + i:.2f}, 462.2, 0.25, {stem}000.AT2, {stem}090.AT2, {vertical}"
        )
    return "\n".join(
        [*lines, "", " -- Unscaled Horizontal & Vertical Spectra", "T (s), pSa (g)", ""]
    )


def peer_download(folder: Path, count: int) -> Path:
    """Make the folder that a download of ``count`` records unpacks to; samples are of ``wave``."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "_SearchResults.csv").write_text(search_results(count))
    for i in range(count):
        stem = f"RSN{700 + i}_LOMAP_S{i:02d}"
        for number, component in enumerate(("000", "090", "-UP")):
            if component == "-UP" and i % 4 == 0:
                continue
            name = component.strip("-")
            for ending, words in (("AT2", "ACCELERATION TIME SERIES IN UNITS OF G"),
                                  ("VT2", "VELOCITY TIME SERIES IN UNITS OF CM/S")):  # fmt: skip
                header = (
                    f"PEER NGA STRONG MOTION DATABASE RECORD\nLoma Prieta, 10/18/1989, Station {i}, "
                    f"{name}\n{words}\nNPTS=     {N}, DT=   .0050 SEC,\n"
                )
                values = wave(100 * i + number, 0.3, 5)
                text = header + rows(values, 5, fortran_e(15, 7))
                (folder / f"{stem}{component}.{ending}").write_text(text)
    return folder
