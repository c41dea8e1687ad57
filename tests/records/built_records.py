"""Small records of every format, written here from the formats' definitions."""

import io
import tarfile
import zipfile
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

N = 43
"""Samples of a built record: no multiple of any row length, so that last rows are short."""

Samples = NDArray[np.float64]
Writer = Callable[[Samples], str | tuple[str, Samples]]


@dataclass(frozen=True)
class Built:
    """A built file and what must be read from it, samples in the unit of the file."""

    path: Path
    format: str
    samples: Samples
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


BUILDERS: dict[str, Callable[[Path], Built]] = {}
"""What makes each record in a folder."""


def wave(seed: int, scale: float, digits: int) -> Samples:
    """Return samples that a field with so many decimals holds exactly."""
    t = np.arange(N) * 0.2
    noise = np.random.default_rng(seed).normal(size=N)
    return np.round(scale * (np.sin(t) + 0.3 * noise), digits)


def record(
    file: str, format: str, dt: float, unit: str, seeds: Iterable[int], scale: float, digits: int,
    newline: str = "\n", encoding: str = "utf-8", **facts: Any,
) -> Callable[[Writer], Writer]:  # fmt: skip
    """Enter what writes a file of waves, one a component, and other samples where they are not what it holds."""

    def enter(write: Writer) -> Writer:
        def build(folder: Path) -> Built:
            samples = np.array([wave(seed, scale, digits) for seed in seeds])
            text = write(samples)
            if isinstance(text, tuple):
                text, samples = text
            path = folder / file
            path.write_bytes(text.replace("\n", newline).encode(encoding))
            return Built(path, format, samples, dt, unit, **facts)

        BUILDERS[write.__name__] = build
        return write

    return enter


def rows(values: Iterable[float], per_line: int, form: Callable[[float], str]) -> str:
    fields = [form(value) for value in values]
    return "".join(
        "".join(fields[i : i + per_line]) + "\n" for i in range(0, len(fields), per_line)
    )


def beside(columns: Samples, form: Callable[[float], str]) -> str:
    """Components side by side, an instant a line."""
    return rows(columns.T.ravel(), len(columns), form)


INTEGERS, REALS = "{:8d}".format, "{:10.3f}".format
ZEROS = rows([0] * 100, 16, "{:5d}".format)
"""Header of a hundred whole numbers as Caltech began it."""


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


@record("peer.AT2", "AT2", 0.005, "g", [1], 0.3, 5,
        station="GILROY ARRAY #3", components=("090",), tolerance=1e-7)  # fmt: skip
def at2_peer(values):
    header = f"""\
PEER STRONG MOTION DATABASE RECORD. PROCESSING BY PACIFIC ENGINEERING.
LOMA PRIETA 10/18/89 00:05, GILROY ARRAY #3, 090 (CDMG STATION 47381)
ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz
NPTS=  {N}, DT= .00500 SEC
"""
    return header + rows(values[0], 5, fortran_e(15, 7))


@record("soft.dat", "SEISMOSOFT", 0.01, "g", [5], 0.2, 4, "\r\n",
        station="TOLMEZZO", components=("000",))  # fmt: skip
def seismosoft(values):
    header = """\
The Friuli (Italy) earthquake of May 06, 1976.
Source: PEER Strong Motion Database
Recording station: TOLMEZZO(000)
Frequency range: 0.1-30.0 Hz
Time[s] Accel[g]
"""
    return header + "\n".join(f"{i * 0.01:.4f}\t{value:.4f}" for i, value in enumerate(values[0]))


COSMOS = {"station": "J2236", "start_time": "2005-06-16T20:53:04.400000Z", "tolerance": 1e-9}


def cosmos_header(azimuth: int, comments: int) -> str:
    whole = [-999] * 100
    whole[39:45] = [2005, 167, 6, 16, 20, 53]
    whole[53] = azimuth
    real = [-999.0] * 100
    real[0:2] = [34.046, -117.035]
    real[29] = 4.4
    real[61] = 10.0
    words = f"""\
Corrected acceleration    (Format v01.20 with 13 text lines) Src: none
Somewhere in Los Angeles, CA            June 16,2005 13:53 PDT
Hypocenter: 34.0580  -117.0110  H= 12km(SCSN) ML=4.9
Origin: 06/16/2005, 20:53:26.1 UTC (SCSN)
Statn No: 01-23075  Code:CE-J2236  CDMG Yucaipa - Bryant & Oak Glen
Coords: 34.0460 -117.0350  Site Geology:  none
Recorder: SSA-2  s/n 1238 ( 1 Chns of 12  at Sta) Sensor:FBA-11  s/n 1889
Rcrd start time:06/16/2005, 20:53:04.400 UTC (Q=2) RcrdId: none
Sta Chan  1: {azimuth} deg (Rcrdr Chan  1) Location: free field
Processed: 06/17/2005, 12:01:00 PDT      Max =  -161.962 cm/sec2
Values used when parameter or data value is unknown/unspecified:   -999, -999.0
 100 Integer-header values follow on  10 lines, Format= (10I8)
"""
    text = words + rows(whole, 10, INTEGERS)
    text += " 100 Real-header values follow on  20 lines, Format= (5F15.6)\n"
    text += rows(real, 5, "{:15.6f}".format)
    text += f'  {comments} Comment line(s) follow, each starting with a "|":\n'
    return text + f"| {N} acceleration pts, a comment, units=g\n" * comments


@record("cosmos.v1", "COSMOS", 0.01, "cm/s2", [6], 90.0, 5, components=("340",), **COSMOS)
def cosmos_v1(values):
    text = cosmos_header(340, 2)
    text += f"   {N}  acceleration pts, approx   1 secs, units=cm/sec2(04),Format=(8F10.5)\n"
    text += rows(values[0], 8, "{:10.5f}".format)
    return text + "/&  ------  End of data for channel  1  ------\n"


@record("touching.V2c", "COSMOS", 0.01, "g", [7], 1.0, 5, components=("90",), **COSMOS)
def cosmos_touching(values):
    """Fields that fill their columns, in g, and the last header line of another writer."""
    values = np.round(-1.5 - 0.1 * np.abs(values), 5)
    text = cosmos_header(90, 0)
    text += f"{N} acceleration pts, approx 1 secs, units=g (02),Format=(10F8.5)\n"
    text += rows(values[0], 10, "{:8.5f}".format)
    return text + "End-of-data for Chan  1 acceleration\n", values


@record("cosmos.V2", "COSMOS", 0.01, "cm/s2", [8, 9], 50.0, 3, components=("90", "180"), **COSMOS)
def cosmos_v2(values):
    """Two channels, each with acceleration, velocity and displacement."""
    text = ""
    for channel, azimuth in zip(values, (90, 180), strict=True):
        text += cosmos_header(azimuth, 1)
        for quantity in ("acceleration", "velocity", "displacement"):
            unit = QUANTITIES[quantity]
            text += f" {N} {quantity} pts, approx 1 secs, units={unit},Format=(1E15.6)\n"
            text += rows(channel, 1, "{:15.6E}".format)
        text += "/&  ------  End of data  ------\n"
    return text


QUANTITIES = {
    **{"acceleration": "cm/sec2 (04)", "velocity": "cm/sec (05)", "displacement": "cm (06)"},
    **{"ACCEL": "CM/SEC/SEC", "VELOC": "CM/SEC", "DISPL": "CM"},
}
"""Units in the words of COSMOS and of CSMIP."""


def csmip_header(volume: int, chan: str, when: str) -> str:
    corrected = f"CORRECTED ACCELEROGRAM   36456-S4384       CHAN  1:  {chan}     FROM\n"
    words = f"""\
UNCORRECTED ACCELEROGRAM DATA              PROCESSED:  6/06/83, CDMG
COALINGA EARTHQUAKE
MAY 2, 1983 16:42 PDT                   (ORIGIN(BRK): 05/02/83, 23:42:38.5 UTC)
36456-S4384-83123.01               {when}
STATION NO. 36456   35.908N, 120.458W     SMA-1  S/N 4384
PARKFIELD FAULT ZONE 14
CHAN  1:  {chan}
COALINGA EARTHQUAKE     MAY 2, 1983 16:42 PDT
HYPOCENTER(BRK): 36.25N,120.28W, H=9KM.
INSTR PERIOD =  .0407 SEC,  DAMPING =  .630,  SENSITIVITY = 1.87 CM/G.
"""
    if volume == 2:
        return corrected + words + ZEROS + rows([0.0] * 100, 8, REALS)
    words += f"""\
NO. OF POINTS =  {N}  RECORD LENGTH = 1.000 SEC
UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = -0.051 G, AT   3.910 SEC.
RMS ACCEL OF COMPLETE RECORD = 0.010 G
"""
    return words + ZEROS + rows([0.0] * 50, 8, REALS)


TRIGGER = "TRIGGER TIME: 05/02/83, 16:42:48.2 PDT"
CSMIP = {"station": "36456", "tolerance": 1e-9}
TRIGGERED = {"start_time": "1983-05-02T23:42:48.200000Z", **CSMIP}


@record("csmip.V2", "CSMIP", 0.02, "cm/s2", [10, 11], 80.0, 3, "\r\n",
        components=("90", "UP"), **TRIGGERED)  # fmt: skip
def csmip_v2(values):
    text = ""
    for number, (channel, chan) in enumerate(zip(values, ("90 DEG", "UP"), strict=True), 10):
        text += csmip_header(2, chan, TRIGGER)
        for quantity in ("ACCEL", "VELOC", "DISPL"):
            text += f" {N} POINTS OF {quantity} DATA EQUALLY SPACED AT  .020 SEC.  "
            text += f"(UNITS: {QUANTITIES[quantity]})\n" + rows(channel, 8, REALS)
        text += f"/&  ----------  END OF DATA FOR CHANNEL  {number}  ----------\n"
    return text + "\x1a" * 40


@record("modern.v2", "CSMIP", 0.005, "cm/s2", [12], 80.0, 6,
        start_time="2012-02-13T21:06:45.000000Z", components=("360",), **CSMIP)  # fmt: skip
def csmip_v2_modern(values):
    text = csmip_header(2, "360 Deg", "Start time:  2/13/12, 21:06:45.0 UTC (GPS)")
    text += f" {N} points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)\n"
    return text + rows(values[0], 8, "{:10.6f}".format) + "/&  ------  End of data  ------\n"


@record("csmip.V1", "CSMIP", 0.005, "g", [13], 0.02, 6, components=("360",), **CSMIP)
def csmip_v1(values):
    text = csmip_header(1, "360 Deg", "").replace("UNITS OF UNCOR ACCEL ARE SEC AND G/10", "UNITS")
    text += f" {N} Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)\n"
    return text + rows(values[0], 8, "{:9.6f}".format) + "/&  ------  End of Data  ------\n"


def pair_rows(times: Samples, values: Samples, first: int) -> str:
    """Five pairs a line, 10F7.3, the first field ``first`` wide."""
    lines = rows(np.column_stack([times, values]).ravel(), 10, "{:7.3f}".format)
    return "".join(" " * (first - 7) + line for line in lines.splitlines(keepends=True))


@record("old.V1", "CSMIP", 0.02, "g/10", [14], 0.8, 3, components=("90",), **TRIGGERED)
def csmip_v1_pairs(values):
    pairs = pair_rows(990.0 + np.arange(N) * 0.02, values[0], 7)
    return csmip_header(1, "90 DEG", TRIGGER) + pairs + "/&  END\n"


@record("altohospicio0911131.v1", "RENADIC", 0.01, "g/10", [15, 16, 17], 0.8, 3,
        station="altohospicio", start_time="2009-11-12T23:10:03.000000Z",
        components=("EW", "NS", "V"), tolerance=1e-9)  # fmt: skip
def renadic(values):
    text = ""
    for channel, chan in zip(values, ("EW", "NS", "V"), strict=True):
        header = csmip_header(1, chan, "TRIGGER TIME: 11/12/2009 23:10:03.000 GMT").split("\n")
        header[1] = "0911131"
        header[7] = "UNIVERSIDAD DE CHILE - RENADIC"
        header = [line for line in header if "STATION NO" not in line]
        text += "\n".join(header) + pair_rows(np.arange(N) * 0.01, channel, 7) + "/&  END\n"
    return text


@record("usc.v1", "USC", 0.005, "g/10", [], 0, 0,
        station="0057", components=("N00W",), tolerance=1e-9)  # fmt: skip
def usc(_):
    """Points of a line a + b t at uneven times: interpolation to 200 Hz gives the line again."""
    times = np.round(np.cumsum(np.tile([0.004, 0.005, 0.004], 15)[:N]) - 0.004, 3)
    first, *words = f"""\
FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:
NORTHRIDGE EARTHQUAKE
JAN 17, 1994 -1230 GMT
IBB123  94.570.0 N
STATION USC# 0057   34 25 09N, 118 25 34W
16628 W. LOST CANYON RD., CANYON COUNTRY, CA
COMP N00W
NORTHRIDGE EARTHQUAKE   JAN 17, 1994 -1230 GMT
EPICENTER -   34 12 48N, 118 32 13W
INSTR PERIOD =  .039 SEC  DAMPING =   .577  SENSITIVITY =   1.86CM/G
NO. OF POINTS =   {N}      DURATION =   1.000 SEC
UNITS ARE SEC AND G/10
RMS ACCLN. OF COMPLETE RECORD =     .638 G/10
""".splitlines()
    text = first + "\n" + "".join(f"{word:72s}{len(word)}\n" for word in words) + ZEROS
    text += rows([0.0] * 50, 8, REALS) + pair_rows(times, np.round(0.1 + 2.0 * times, 3), 8)
    grid = np.arange(int(times[-1] / 0.005 + 1e-9) + 1) * 0.005
    return text, np.round(0.1 + 2.0 * grid, 6)[None, :]


SMC = {"station": "SAF0", "start_time": "1989-10-18T00:04:15.250000Z", "components": ("360",)}


def smc_text(values: Samples, comments: int, precise: bool, kind: str) -> str:
    whole = [-32768] * 48
    whole[1:7] = [1989, 291, 0, 4, 15, 250]
    whole[12], whole[13], whole[15], whole[16] = 90, 360, comments, N
    whole[46] = 8 if precise else 6
    real = [1.7e38] * 50
    real[1], real[10], real[11] = 200.0, 37.728, -122.385
    words = f"""\
{kind}
*
SAF0A
     1989  10  18    0004 Loma Prieta, CA
Moment Mag=      7.1 Ms=      7.1 Ml=      7.0
station = San Francisco, 1295 Shafter, F component=    360
epicentral dist =     89.0       pk     =    104.4
inst type=SMA-1      data source = USGS
*
*
*
"""
    text = words + rows(whole, 8, "{:10d}".format) + rows(real, 5, "{:15.7E}".format)
    text += "".join(f"|comment {i} 1.0 2.0\n" for i in range(comments))
    if precise:
        return text + rows(values, 5, "{:14.7E}".format)
    return text + rows(values, 8, one_digit_exponent)


def shown(values: Iterable[float], form: str) -> Samples:
    """The values that fields of a form hold."""
    return np.array([float(format(value, form)) for value in values])


@record("corrected.smc", "SMC", 0.005, "cm/s2", [18], 30.0, 9, "\r\n", tolerance=1e-12, **SMC)
def smc(values):
    values = shown(values[0], ".4e")
    return smc_text(values, 3, False, "2 CORRECTED ACCELEROGRAM"), values[None, :]


@record("raw.smc", "SMC", 0.005, "cm/s2", [19], 30.0, 12, "\r\n", tolerance=1e-12, **SMC)
def smc_precise(values):
    values = shown(values[0], ".7e")
    return smc_text(values, 0, True, "1 UNCORRECTED ACCELEROGRAM"), values[None, :]


@record("uneven.smc", "SMC", 0.005, "cm/s2", [], 0, 0, "\r\n", tolerance=1e-3, **SMC)
def smc_uneven(_):
    """Pairs of time and acceleration on a line, at uneven times; the count is of all values."""
    times = shown(np.cumsum(np.tile([0.004, 0.006], 21)) - 0.004, ".4e")
    both = shown(np.column_stack([times, 5 + 20 * times]).ravel(), ".4e")
    text = smc_text(both, 2, False, "1 UNCORRECTED ACCELEROGRAM").split("\n")
    text[13] = f"{both.size:10d}" + text[13][10:]
    text[17] = text[17][:15] + f"{1.7e38:15.7E}" + text[17][30:]
    line = 5 + 20 * np.arange(int(times[-1] / 0.005 + 1e-9) + 1) * 0.005
    return "\n".join(text), line[None, :]


@record("surplus.smc", "SMC", 0.005, "cm/s2", [], 0, 0, "\r\n", tolerance=1e-3, **SMC)
def smc_surplus(_):
    """A line of scattered points below the last pair that the header counts, which fills no whole line."""
    text, line = smc_uneven(_)
    return text + " 3.0000E-1 1.0000E+1 4.0000E-1 2.0000E+1\n", line


def esm_text(values: Samples, kind: str, first: str) -> str:
    header = f"""\
EVENT_NAME: GREECE
EVENT_ID: EMSC-20190728_0000106
EVENT_DATE_YYYYMMDD: 20190728
EVENT_TIME_HHMMSS: 160908
MAGNITUDE_W:{" "}
MAGNITUDE_L: 4.6
NETWORK: HL
STATION_CODE: DLFA
STATION_NAME: Delfoi, Ελλάς
LOCATION:{" "}
DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS: {first}
SAMPLING_INTERVAL_S: 0.005000
NDATA: {N}
STREAM: HNN
UNITS: cm/s^2
INSTRUMENT: sensor = CMG_5 [Unknown] | digitizer = Unknown [Unknown]
HEADER_FORMAT: DYNA 1.2
DATA_TYPE: {kind}
USER5:{" "}
"""
    return header + rows(values[0], 1, "{:.6f}".format)


@record("esm.ASC", "ESM", 0.005, "cm/s2", [20], 3.0, 6,
        station="DLFA", start_time="2019-07-28T16:09:05.700000Z", components=("HNN",))  # fmt: skip
def esm(values):
    return esm_text(values, "ACCELERATION", "20190728_160905.700")


@record("20230206011732_0118_ap_AAD_Acc_E.asc", "ESM", 0.005, "cm/s2", [21], 3.0, 6,
        station="DLFA", start_time="2010-11-14T23:09:19.300000Z", components=("HNN",))  # fmt: skip
def esm_tadas(values):
    """As AFAD's TADAS delivers: a first line without a key, the kind and the day in another way."""
    head = "AAD_Filtered_TADAS_FILE\nAAD_FILTER_TYPE: BUTTERWORTH\n"
    text = esm_text(values, "Acceleration", "14/11/2010 23:09:19.300")
    text = text.replace("LOCATION: ", "LOCATION: HATAY_HASSA")
    return head + "AAD_LOW_CUT_FREQUENCY_HZ: 0.025\n" + text


HSES = {
    "station": "HSES", "start_time": "2016-11-13T11:02:20.500000Z",
    "components": ("N10E", "N80W", "Up"), "tolerance": 1e-6,
}  # fmt: skip


def geonet_component(component: str, values: Samples, corrected: bool) -> str:
    whole = [0] * 40
    whole[8:10], whole[18:20], whole[38:40] = [2016, 11], [13, 11], [2, 20500]
    whole[30] = 4 * N if corrected else N
    whole[33:36] = [N, N, N] if corrected else [N, 0, 0]
    real = [0.0] * 60
    real[10:12], real[14], real[24:26] = [42.523, 172.830], 7.82, [0.005, 0.02]
    prefix, step = "C", "Instrument corrected data at 0.020 sec intervals"
    if not corrected:
        real[25] = 0.005
        prefix, step = "Unc", "Raw readings in units of 1.00 mm/s/s  at intervals of 0.005 s"
    words = f"""\
{prefix}orrected accelerogram 20161113_110256_HSES_20 GNS Science
Site HSES      42 31 24S  172 49 50E     Basalt file:  20161113_110300_HSES
Hanmer Springs Emergency Centre
Instrument Basalt_2430
Resolution: 24-bit   Instr Period: 0.0050 s   Damping: 0.700
Accelerogram 20161113_110256_HSES_20                 Processed 2016 December 09
5 km south-west of Waiau
2016 November 13         11:02:56 UT
Epicentre  42 41 33S 173 01 19E  Bearing S40E  Dist   25km  Depth   15km Mw 7.82
Number of points  {N}    Duration 0.86 s
{step}
Data is unfiltered
Component {component}
Acceleration:  Peak   2394.8 mm/s/s at  48.13 s     RMS   209.89 mm/s/s
Velocity record unevaluated
Displacement record unevaluated
"""
    text = words + rows(whole, 10, INTEGERS) + rows(real, 10, "{:8.3f}".format)
    text += rows(values, 10, "{:8.1f}".format)
    if corrected:
        text += rows(values / 10, 10, "{:8.2f}".format) + rows(values / 100, 10, "{:8.3f}".format)
    return text


@record("hses.V1A", "GEONET", 0.005, "mm/s2", [22, 23, 24], 12000.0, 1, **HSES)
def geonet_v1a(values, corrected=False):
    # -1234.5 and more fill the columns, so that neighbours touch
    values = values - 20000.0
    both = zip(HSES["components"], values, strict=True)
    return "".join(geonet_component(name, v, corrected) for name, v in both), values


@record("hses.V2A", "GEONET", 0.02, "mm/s2", [22, 23, 24], 12000.0, 1, **HSES)
def geonet_v2a(values):
    return geonet_v1a(values, corrected=True)


CWA = {"station": "ECU", "components": ("U", "N", "E"), "tolerance": 1e-9}


@record("cwa.txt", "CWA", 0.02, "cm/s2", [25, 26, 27], 40.0, 3,
        start_time="2018-02-06T15:50:29.000000Z", **CWA)  # fmt: skip
def cwa(values):
    header = """\
#Earthquake Information
#Origin Time(GMT+08): 2018/02/06-23:50:42
#Magnitude(Ml): 6.0
#StationCode: ECU
#StationName: Chulu
#StartTime(GMT+08): 2018/02/06-23:50:29.000
#RecordLength(sec): 1
#SampleRate(Hz): 50
#AmplitudeUnit:  gal. DCoffset(corr)
#DataSequence: Time U(+); N(+); E(+)
#Data: 4F10.3
"""
    return header + beside(np.vstack([np.arange(N) * 0.02, values]), REALS)


@record("cx921.txt", "CWA", 0.02, "cm/s2", [25, 26, 27], 40.0, 3,
        start_time="1999-09-20T17:47:04.000000Z", **CWA)  # fmt: skip
def cwa_1999(values):
    """As the CWB wrote the Chi-Chi earthquake: from the station's code on, in UTC."""
    text = cwa(values)
    text = text[text.index("#StationCode") :].replace("#StationName: Chulu\n", "")
    return text.replace("(GMT+08): 2018/02/06-23:50:29", ": 1999/09/20-17:47:04")


@record("plain.txt", "PLAINTEXT", 0.02, "", [28], 0.3, 5)
def plain_two_columns(values):
    return "".join(f"{i * 0.02:.7e}   {v:.7e}\n" for i, v in enumerate(values[0]))


@record("plain.csv", "PLAINTEXT", 0.01, "m/s2", [29], 0.3, 5, "\r\n")
def plain_csv(values):
    body = "".join(f"{i / 100},{v!r}\n" for i, v in enumerate(values[0].tolist()))
    return "Time (s),Acceleration (m/s^2)\n" + body


@record("count.txt", "PLAINTEXT", 0.005, "", [31], 0.3, 5)
def plain_count_then_columns(values):
    """``npts dt`` above two columns whose time starts at dt."""
    body = "".join(f" {(i + 1) * 0.005:.6g}   {v!r}\n" for i, v in enumerate(values[0].tolist()))
    return f" {N}  0.005\n" + body


@record("eqsig.txt", "PLAINTEXT", 0.01, "", [32], 0.3, 5)
def plain_one_column(values):
    return f"test-motion\n{N} 0.0100\n" + rows(values[0].tolist(), 1, repr)


@record("20170720223109_4806.txt", "AFAD", 0.01, "cm/s2", [40, 41, 42], 40.0, 6, "\r\n", "iso8859-9",
        station="4806", start_time="2017-07-20T22:30:59.000000Z",
        components=("N-S", "E-W", "U-D"), tolerance=1e-9)  # fmt: skip
def afad(values):
    """In the network's own ISO 8859-9."""
    header = f"""\
STRONG GROUND MOTION RECORDS OF TURKIYE
PLACE                   : MUĞLA MİLAS
EARTHQUAKE DATE         : 2017/07/20 22:31:09 (GMT)
EARTHQUAKE MAGNITUDE    : 6.5 Mw
STATION ID              : 4806
STATION COORDINATES     : 37.30253N-27.78054E
RECORD TIME             : 20/07/2017 22:30:59.000000 (GMT)
NUMBER OF DATA          : {N}
SAMPLING INTERVAL (sec) : 0.01
RAW PGA VALUES (gal)    : (N-S) 58.542232 (E-W) 59.994425 (U-D) 25.542791
       N-S          E-W          U-D
"""
    return header + beside(values, "{:13.6f}".format)


@record("5526-1.V1", "BHRC", 0.005, "g/10", [43, 44, 45], 0.05, 7,
        station="Avin", components=("L", "V", "T"), tolerance=1e-7)  # fmt: skip
def bhrc(values):
    """Three components; header lines are cut after 70 columns."""
    text, real = "", np.zeros(50)
    real[8] = 200.0
    numbers = (ZEROS + rows(real, 8, fortran_e(13, 6))).splitlines()
    for channel, name in zip(values, "LVT", strict=True):
        text += f"""\
* VOL1DS FILE:  5526/01
Inst Type = SSA-2
Origin Time : 2012/08/11   12:23:16

{name}

COMP {name}1
Avin                      Station   37.734 N 47.801 E   Altitude 2026m   Azimuth L 50    T 140
Epicenter 38.520 N 46.860 E   FD 12 Km mb      Ms      Mw6.1   M        ML   (BHRC)
INSTR PERIOD =  .020 SEC   DAMPING =  .640
NO. OF POINTS =   {N}      DURATION =  {N * 0.005:.3f}
UNITS ARE SECONDS AND G/10

"""
        text += "".join(line[:70] + "\n" for line in numbers)
        text += rows(channel, 10, fortran_e(13, 6)) + "/&\n"
    return text


UNAM = {"station": "CUP5", "start_time": "2004-01-02T00:00:01.000000Z", "tolerance": 1e-9}


@record("CUP50401.012", "UNAM", 0.004, "cm/s2", [46, 47, 48], 40.0, 3, encoding="latin-1",
        components=("V", "N90E", "N00E"), **UNAM)  # fmt: skip
def unam(values):
    """Two samples more than the nominal duration has; the record begins after midnight."""
    header = f"""\
ARCHIVO ESTANDAR DE ACELERACION:
NOMBRE DE LA ESTACION                  : IDEI PATIO 5
CLAVE DE LA ESTACION                   : CUP5
LOCALIZACION DE LA ESTACION            : Ingeniería,
                                       : México
COORDENADAS DE LA ESTACION             : 19.33024 LAT. N
                                       : 99.181076 LONG. W
ORIENTACION C1-C6 (rumbo;orientacion)  : /V/N90E/N00E
INTERVALO DE MUESTREO, C1-C6 (s)       : /0.004/0.004/0.004
FECHA DEL SISMO [GMT]                  : 2004/01/01
HORA EPICENTRO (GMT)                   : 23:58:02.7
MAGNITUD(ES)                           : /Mb=5.2/Ms=5.8
HORA DE LA PRIMERA MUESTRA (GMT)       : 00:00:01
NUM. TOTAL DE MUESTRAS, C1-C6          : /{N - 2}/{N - 2}/{N - 2}
UNIDADES DE LOS DATOS                  : Gal (cm/s/s)
FORMATO DATOS (FORTRAN,10 campos/dato) : 3F10.3
DATOS DE ACELERACION:
---------+---------+---------+
   CANAL-1   CANAL-2   CANAL-3
         V      N90E      N00E
---------+---------+---------+
"""
    return header + beside(values, REALS)


@record("RAC_04042010222544.dat", "UNAM", 0.004, "cm/s2", [46, 47, 48], 40.0, 3, encoding="latin-1",
        components=("N90E", "N00E", "V"), **UNAM)  # fmt: skip
def unam_senses(values):
    """Orientations with their sense behind them, in another order of channels."""
    return unam(values).replace(": /V/N90E/N00E", ": /N90E;/N00E;/V;+")


@record("ua0004.dat", "CSMNC", 0.005, "cm/s2", [49], 3.0, 6, station="65SBY", components=("EW",))
def csmnc(values):
    header = f"""\
065SBY120103153901
0120103153957 2012-01-03 15:39:57 BTM
ATUSHI EARTHQUAKE, ATUSHI,CHN
EPICENTER  39.939N 77.339E DEPTH 9 KM
MAGNITUDE  4.0(Ms)
STATION: 65SBY 39.299N 77.800E
SITE CONDITION: SOIL
INSTRUMENT TYPE: ETNA/ES-T
OBSERVING POINT: GROUND
COMP. EW
UNCORRECTED ACCELERATION          UNIT: CM/SEC/SEC
NO. OF POINTS:  {N}  EQUALLY SPACED INTERVALS OF:  0.005  SEC
PEAK VALUE:    3.262   AT   22.89 SEC    DURATION:  44 SEC
PRE-EARTHQUAKE TIME:  20  SEC  RECORDER TIME:  2012-01-3 15:40:00.000 BTM
CSMNC

"""
    return header + rows(values[0].tolist(), 8, "{!r:>14}".format)


@record("017m30bt.s0a", "USC2", 0.02, "cm/s2", [50], 200.0, 3,
        station="0061", components=("N08W",), tolerance=1e-9)  # fmt: skip
def usc_volume_2(values):
    words = f"""\
CORRECTED ACCELEROGRAM  IIBB127  94.610.0 COMP N08W   FILE   0  CORRESPONDING T
FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:
NORTHRIDGE EARTHQUAKE
JAN 17, 1994 -1230 GMT
IBB127  94.610.0 N
STATION USC# 0061   34 17 11N, 118 13 31W
BIG TUJUNGA STATION, ANGELES NATIONAL FOREST, CA
COMP N08W
  {N}  INSTRUMENT AND BASELINE CORRECTED DATA
PEAK ACCELERATION =  {np.abs(values).max():.5f}  CMS/SEC/SEC AT    4.580   SEC.
"""
    text = words + ZEROS + rows([0.0] * 100, 8, REALS)
    text += f"  {N} POINTS OF ACC DATA EQUALLY SPACED AT   .020 SEC.\n"
    return text + rows(values[0], 8, REALS)


@record("iia001.v2", "USC2", 0.02, "cm/s2", [60], 200.0, 3,
        station="117", components=("S00E",), tolerance=1e-9)  # fmt: skip
def eerl_volume_2(values):
    """Caltech's own volume 2: count, interval and unit in words alone, three sections without titles."""
    words = f"""\
CORRECTED ACCELEROGRAM IIA001    40.001.0
COMP S00E   FILE   1  CORRESPONDING TO
FILE   1 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I-A, EERL 70-20
SOME VALLEY EARTHQUAKE
MAY 18, 1940 - 2037 PST
STATION NO. 117   32 47 43N, 115 32 55W
SITE OF THE STATION
COMP S00E
  {N}  INSTRUMENT AND BASELINE CORRECTED DATA
AT EQUALLY-SPACED INTERVALS OF    .020  SEC.
PEAK ACCELERATION =  {np.abs(values).max():.5f}  CMS/SEC/SEC AT    2.120   SEC.
"""
    sections = (rows(factor * values[0], 8, REALS) for factor in (1.0, 0.1, 0.01))
    return words + ZEROS + rows([0.0] * 100, 8, REALS) + "".join(sections)


@record("usaca40.044", "AGRAM", 0.005, "cm/s2", [51, 52, 53], 200.0, 2,
        station="WHITTIER, 7215 BRIGHT AVE, 10TH FLOOR", start_time="1987-10-01T14:42:00.000000Z",
        components=("090",), tolerance=1e-9)  # fmt: skip
def agram(values):
    # -1234.56 and more fill the columns, so that neighbours touch
    text, values = "", values - 2000.0
    for kind, section in zip(("AC", "VL", "DP"), values, strict=True):
        text += f"""\
 WHITTIER, 7215 BRIGHT AVE, 10TH FLOOR
 090 DEGREES
 EARTHQUAKE OF OCTOBER 1, 1987 1442 GMT
 BUTTERWORTH AT .25 HZ, ORDER 4
 YEAR=1987 JULIAN DAY=274 HOUR=14 MINUTE=42 SECOND= 0 COMPONENT=  90
 SAMPLES/SEC=200 FILTER TYPE=BUTTERWORTH  CORNER= 0.25 ORDER=4 DATA TYPE={kind}
 NO OF POINTS=  {N}, UNITS=CM/SEC**2, CM/SEC, AND CM
"""
        text += rows(section, 10, "{:8.2f}".format)
    return text, values[:1]


@record(
    "three.csv", "PLAINTEXT", 0.01, "cm/s2", [54, 55, 56], 40.0, 8, components=("NS", "EW", "UD")
)
def columns(values):
    lines = ["time,acc_NS(gal),acc_EW(gal),acc_UD(gal)"]
    lines += [f"{i * 0.01:.2f},{','.join(map(repr, v))}" for i, v in enumerate(values.T.tolist())]
    return "\n".join(lines) + "\n"


@record("avd.csv", "PLAINTEXT", 0.01, "g", [57], 0.3, 6)
def columns_of_quantities(values):
    """Behind a byte-order mark, with decimal commas, and velocity and displacement beside."""
    lines = [f"{i * 0.01:.2f};{v!r};{2 * v:.6f};0.5" for i, v in enumerate(values[0].tolist())]
    titles = "\ufeffTime [s];Acceleration [g];Velocity [m/s];Displacement [m]\n"
    return titles + "\n".join(lines).replace(".", ",")


@record("ARL360.g3", "PLAINTEXT", 0.02, "", [58], 0.3, 5, tolerance=1e-7, stated_dt=False)
def rows_of_numbers(values):
    return rows(values[0], 5, fortran_e(15, 7)) + " *** End data ***\n"


@record("series.tcl", "OPENSEES", 0.02, "m/s2", [59], 0.3, 5, components=("7",))
def opensees(values):
    text = f"""\
# acceleration in m/s2
set g 9.81
timeSeries Path 7 -dt 0.02 -values {{
{rows(values[0], 6, "{:10.5f}".format)}}} -factor 2.0
pattern UniformExcitation 1 1 -accel 7
"""
    return text, 2 * values


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
    return "\n".join([*lines, rows(samples, 8, "{:9.0f}".format)])


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
