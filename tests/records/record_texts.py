"""Texts of small records of every format, a function each, written from the formats' definitions.

A recipe says of each its file, its samples, and what must be read of it; ``rows("8F10.3", …)`` writes numbers by a
Fortran format, several columns side by side, ``lines("{}\t{}", …)`` an instant a line.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .fields import N, Samples, largest, lines, numbers, rows


@dataclass(frozen=True)
class Made:
    """The samples that a record is to hold."""

    times: Samples  # shape (N,) [s]
    waves: Samples  # a row a channel, in the unit of the file

    @property
    def peak(self) -> str:
        """Largest size of all, as headers state it."""
        return f"{np.abs(self.waves).max():.5f}"


Text = Callable[[Made], str]


@dataclass(frozen=True)
class Recipe:
    """How a record is built, and what must be read of it."""

    text: Text
    file: str
    # seeds of the channels; scale, form and shift of their samples, or the points of a straight line
    seeds: Sequence[int]
    made: Mapping[str, Any]
    line: Mapping[str, Any] | None
    read: Mapping[str, Any]
    encoding: str = "utf-8"
    newline: str = "\n"
    factor: float = 1.0  # of the samples read to the numbers written


RECORDS: dict[str, Recipe] = {}


def record(
    file: str,
    read: Mapping[str, Any],
    *,
    seeds: Sequence[int] = (),
    made: Mapping[str, Any] | None = None,
    line: Mapping[str, Any] | None = None,
    **how: Any,
) -> Callable[[Text], Text]:
    """Register the text of a record under its function's name."""

    def register(text: Text) -> Text:
        RECORDS[text.__name__] = Recipe(
            text, file, seeds, made or {}, line, read, **how
        )
        return text

    return register


CRLF = {"newline": "\r\n"}
AT2 = {"format": "AT2", "unit": "g"}
COSMOS = {
    **{"format": "COSMOS", "dt": 0.01, "unit": "cm/s2", "station": "J2236"},
    **{"start_time": "2005-06-16T20:53:04.400000Z", "tolerance": 1e-9},
}
CSMIP = {
    **{"format": "CSMIP", "dt": 0.02, "unit": "cm/s2", "station": "36456"},
    **{"start_time": "1983-05-02T23:42:48.200000Z", "tolerance": 1e-9},
}
SMC = {
    **{"format": "SMC", "dt": 0.005, "unit": "cm/s2", "station": "SAF0"},
    **{"start_time": "1989-10-18T00:04:15.250000Z", "components": ("360",)},
    "tolerance": 1e-12,
}
ESM = {
    **{"format": "ESM", "dt": 0.005, "unit": "cm/s2", "station": "DLFA"},
    **{"start_time": "2019-07-28T16:09:05.700000Z", "components": ("HNN",)},
}
GEONET = {
    **{"format": "GEONET", "dt": 0.005, "unit": "mm/s2", "station": "HSES"},
    **{"start_time": "2016-11-13T11:02:20.500000Z", "tolerance": 1e-6},
    "components": ("N10E", "N80W", "Up"),
}
CWA = {
    **{"format": "CWA", "dt": 0.02, "unit": "cm/s2", "station": "ECU"},
    **{"start_time": "2018-02-06T15:50:29.000000Z", "components": ("U", "N", "E")},
    "tolerance": 1e-9,
}
UNAM = {
    **{"format": "UNAM", "dt": 0.004, "unit": "cm/s2", "station": "CUP5"},
    **{"start_time": "2004-01-02T00:00:01.000000Z", "tolerance": 1e-9},
}
USC2 = {"format": "USC2", "dt": 0.02, "unit": "cm/s2", "tolerance": 1e-9}
PLAIN = {"format": "PLAINTEXT", "unit": ""}
UNEVEN = {"steps": (0.004, 0.006), "start": 5.0, "slope": 20.0}


@record(
    "peer.AT2",
    AT2 | {"dt": 0.005, "station": "GILROY ARRAY #3", "components": ("090",), "tolerance": 1e-7},
    seeds=[1],
)  # fmt: skip
def at2_peer(made: Made) -> str:
    return f"""\
PEER STRONG MOTION DATABASE RECORD. PROCESSING BY PACIFIC ENGINEERING.
LOMA PRIETA 10/18/89 00:05, GILROY ARRAY #3, 090 (CDMG STATION 47381)
ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz
NPTS=  {N}, DT= .00500 SEC
{rows("5E15.7", *made.waves)}
"""


@record(
    "touching.AT2",
    AT2 | {"dt": 0.01, "tolerance": 1e-8},
    seeds=[2],
    made={"scale": 0.1, "form": ".9f", "shift": -0.5},
)
def at2_touching(made: Made) -> str:
    """Negative numbers that fill their columns, below a header of two lines."""
    return f"""\
ACCELERATION IN UNITS OF G
NPTS= {N}, DT= .01
{rows("5ES15.8", *made.waves)}
"""


@record(
    "soft.dat",
    {"format": "SEISMOSOFT", "dt": 0.01, "unit": "g", "station": "TOLMEZZO", "components": ("000",)},
    seeds=[5],
    made={"scale": 0.2, "form": ".4f"},
    newline="\r\n",
)  # fmt: skip
def seismosoft(made: Made) -> str:
    table = lines("{:.4f}\t{:.4f}", made.times, *made.waves)
    return f"""\
The Friuli (Italy) earthquake of May 06, 1976.
Source: PEER Strong Motion Database
Recording station: TOLMEZZO(000)
Frequency range: 0.1-30.0 Hz
Time[s] Accel[g]
{table}"""


def cosmos_header(
    wave: Samples, azimuth: int, comments: int, unit: str = "cm/sec2"
) -> str:
    """Text, numbers and comments above the samples of COSMOS 1.20."""
    integers = numbers(100, -999, {39: [2005, 167, 6, 16, 20, 53], 53: [azimuth]})
    reals = numbers(100, -999, {0: [34.046, -117.035], 29: [4.4], 61: [10.0]})
    said = f"| {N} acceleration pts, a comment, units=g\n" * comments
    return f"""\
Corrected acceleration    (Format v01.20 with 13 text lines) Src: none
Somewhere in Los Angeles, CA            June 16,2005 13:53 PDT
Hypocenter: 34.0580  -117.0110  H= 12km(SCSN) ML=4.9
Origin: 06/16/2005, 20:53:26.1 UTC (SCSN)
Statn No: 01-23075  Code:CE-J2236  CDMG Yucaipa - Bryant & Oak Glen
Coords: 34.0460 -117.0350  Site Geology:  none
Recorder: SSA-2  s/n 1238 ( 1 Chns of 12  at Sta) Sensor:FBA-11  s/n 1889
Rcrd start time:06/16/2005, 20:53:04.400 UTC (Q=2) RcrdId: none
Sta Chan  1: {azimuth} deg (Rcrdr Chan  1) Location: free field
Processed: 06/17/2005, 12:01:00 PDT      Max = {largest(wave):.3f} {unit}
Values used when parameter or data value is unknown/unspecified:   -999, -999.0
 100 Integer-header values follow on  10 lines, Format= (10I8)
{rows("10I8", integers)}
 100 Real-header values follow on  20 lines, Format= (5F15.6)
{rows("5F15.6", reals)}
  {comments} Comment line(s) follow, each starting with a "|":
{said}"""


@record(
    "cosmos.v1",
    COSMOS | {"components": ("340",)},
    seeds=[6],
    made={"scale": 90.0},
)
def cosmos_v1(made: Made) -> str:
    return f"""\
{cosmos_header(made.waves[0], 340, comments=2)}\
   {N}  acceleration pts, approx   1 secs, units=cm/sec2(04),Format=(8F10.5)
{rows("8F10.5", *made.waves)}
/&  ------  End of data for channel  1  ------
"""


@record(
    "touching.V2c",
    COSMOS | {"unit": "g", "components": ("90",)},
    seeds=[7],
    made={"scale": 0.1, "shift": -1.5},
)
def cosmos_touching(made: Made) -> str:
    """Fields that fill their columns, in g, and the last header line of another writer."""
    return f"""\
{cosmos_header(made.waves[0], 90, comments=0, unit="g")}\
{N} acceleration pts, approx 1 secs, units=g (02),Format=(10F8.5)
{rows("10F8.5", *made.waves)}
End-of-data for Chan  1 acceleration
"""


@record(
    "cosmos.V2",
    COSMOS | {"components": ("90", "180")},
    seeds=[8, 9],
    made={"scale": 50.0, "form": ".3f"},
)
def cosmos_v2(made: Made) -> str:
    """Two channels, each with acceleration, velocity and displacement."""
    text = ""
    for azimuth, wave in zip((90, 180), made.waves, strict=True):
        text += cosmos_header(wave, azimuth, comments=1)
        for quantity, unit in (
            ("acceleration", "cm/sec2 (04)"),
            ("velocity", "cm/sec (05)"),
            ("displacement", "cm (06)"),
        ):
            text += f"""\
 {N} {quantity} pts, approx 1 secs, units={unit},Format=(1E15.6)
{rows("1ES15.6", wave)}
"""
        text += "/&  ------  End of data  ------\n"
    return text


TRIGGER = "TRIGGER TIME: 05/02/83, 16:42:48.2 PDT"


def csmip_header(chan: str, when: str, above: str, below: str, reals: int) -> str:
    """Text and numbers above the samples of a CSMIP file; ``below`` are its last lines of words."""
    return f"""\
{above}\
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
{below}\
{rows("16I5", numbers(100))}
{rows("8F10.3", numbers(reals))}
"""


def csmip_header_2(wave: Samples, chan: str, when: str = TRIGGER) -> str:
    """Header of volume 2."""
    above = f"CORRECTED ACCELEROGRAM   36456-S4384       CHAN  1:  {chan}     FROM\n"
    below = f"""\
                                     UNCOR MAX  =  -9.975 G, AT  10.947 SEC.
PEAK ACCELERATION = {largest(wave):.3f}    CM/SEC/SEC  AT    3.140   SEC.
"""
    return csmip_header(chan, when, above, below, reals=100)


def csmip_header_1(largest_g: float, chan: str, when: str, units: str) -> str:
    """Header of volume 1."""
    below = f"""\
NO. OF POINTS =  {N}  RECORD LENGTH = 1.000 SEC
{units}.     MAX  = {largest_g:.3f} G, AT   3.910 SEC.
RMS ACCEL OF COMPLETE RECORD = 0.010 G
"""
    return csmip_header(chan, when, "", below, reals=50)


@record(
    "csmip.V2",
    CSMIP | {"components": ("90", "UP")},
    seeds=[10, 11],
    made={"scale": 80.0, "form": ".3f"},
    newline="\r\n",
)
def csmip_v2(made: Made) -> str:
    text = ""
    for number, chan, wave in zip((10, 11), ("90 DEG", "UP"), made.waves, strict=True):
        text += csmip_header_2(wave, chan)
        for quantity, unit in (
            ("ACCEL", "CM/SEC/SEC"),
            ("VELOC", "CM/SEC"),
            ("DISPL", "CM"),
        ):
            text += f"""\
 {N} POINTS OF {quantity} DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: {unit})
{rows("8F10.3", wave)}
"""
        text += f"/&  ----------  END OF DATA FOR CHANNEL  {number}  ----------\n"
    return text + "\x1a" * 40


@record(
    "modern.v2",
    CSMIP
    | {"dt": 0.005, "start_time": "2012-02-13T21:06:45.000000Z", "components": ("360",)},
    seeds=[12],
    made={"scale": 80.0, "form": ".6f"},
)  # fmt: skip
def csmip_v2_modern(made: Made) -> str:
    when = "Start time:  2/13/12, 21:06:45.0 UTC (GPS)"
    return f"""\
{csmip_header_2(made.waves[0], "360 Deg", when)}\
 {N} points of accel data equally spaced at  .005 sec, in cm/sec2. (8f10.6)
{rows("8F10.6", *made.waves)}
/&  ------  End of data  ------
"""


@record(
    "csmip.V1",
    CSMIP | {"dt": 0.005, "unit": "g", "start_time": None, "components": ("360",)},
    seeds=[13],
    made={"scale": 0.02, "form": ".6f"},
)
def csmip_v1(made: Made) -> str:
    return f"""\
{csmip_header_1(largest(made.waves[0]), "360 Deg", "", "UNITS")}\
 {N} Accelerogram points at 200 pts/sec in units of g .      Format: (8f9.6)
{rows("8F9.6", *made.waves)}
/&  ------  End of Data  ------
"""


@record(
    "old.V1",
    CSMIP | {"unit": "g/10", "components": ("90",)},
    seeds=[14],
    made={"scale": 0.8, "form": ".3f"},
)
def csmip_v1_pairs(made: Made) -> str:
    units = "UNITS OF UNCOR ACCEL ARE SEC AND G/10"
    return f"""\
{csmip_header_1(largest(made.waves[0]) / 10, "90 DEG", TRIGGER, units)}\
{rows("10F7.3", made.times + 990, *made.waves)}
/&  END
"""


@record(
    "altohospicio0911131.v1",
    {
        **{"format": "RENADIC", "dt": 0.01, "unit": "g/10", "station": "altohospicio"},
        **{"start_time": "2009-11-12T23:10:03.000000Z", "tolerance": 1e-9},
        "components": ("EW", "NS", "V"),
    },
    seeds=[15, 16, 17],
    made={"scale": 0.8, "form": ".3f"},
)
def renadic(made: Made) -> str:
    text = ""
    for chan, wave in zip(("EW", "NS", "V"), made.waves, strict=True):
        text += f"""\
UNCORRECTED ACCELEROGRAM DATA              PROCESSED:  6/06/83, CDMG
0911131
MAY 2, 1983 16:42 PDT                   (ORIGIN(BRK): 05/02/83, 23:42:38.5 UTC)
36456-S4384-83123.01               TRIGGER TIME: 11/12/2009 23:10:03.000 GMT
PARKFIELD FAULT ZONE 14
CHAN  1:  {chan}
UNIVERSIDAD DE CHILE - RENADIC
HYPOCENTER(BRK): 36.25N,120.28W, H=9KM.
INSTR PERIOD =  .0407 SEC,  DAMPING =  .630,  SENSITIVITY = 1.87 CM/G.
NO. OF POINTS =  {N}  RECORD LENGTH = 1.000 SEC
UNITS OF UNCOR ACCEL ARE SEC AND G/10.     MAX  = {largest(wave) / 10:.3f} G, AT   3.910 SEC.
RMS ACCEL OF COMPLETE RECORD = 0.010 G
{rows("16I5", numbers(100))}
{rows("8F10.3", numbers(50))}
{rows("10F7.3", made.times, wave)}
/&  END
"""
    return text


@record(
    "usc.v1",
    {
        **{"format": "USC", "dt": 0.005, "unit": "g/10", "station": "0057"},
        **{"components": ("N00W",), "tolerance": 1e-9},
    },
    line={"steps": (0.004, 0.005, 0.004), "start": 0.1, "slope": 2.0},
)
def usc(made: Made) -> str:
    """Each line of words with its length behind it."""
    words = f"""\
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
RMS ACCLN. OF COMPLETE RECORD =     .638 G/10"""
    with_lengths = "\n".join(f"{line:<72}{len(line)}" for line in words.split("\n"))
    pairs = rows("10F7.3", made.times, *made.waves).replace("\n", "\n ")
    return f"""\
FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:
{with_lengths}
{rows("16I5", numbers(100))}
{rows("8F10.3", numbers(50))}
 {pairs}
"""


def smc_header(
    peak: str, comments: int, count: int, rate: float, precision: int = 6
) -> str:
    """Header of an SMC file below its first line."""
    facts = {
        **{1: [1989, 291, 0, 4, 15, 250], 12: [90, 360]},
        **{15: [comments, count], 46: [precision]},
    }
    reals = numbers(50, 1.7e38, {1: [rate], 10: [37.728, -122.385]})
    said = "".join(f"|comment {i} 1.0 2.0\n" for i in range(comments))
    return f"""\
*
SAF0A
     1989  10  18    0004 Loma Prieta, CA
Moment Mag=      7.1 Ms=      7.1 Ml=      7.0
station = San Francisco, 1295 Shafter, F component=    360
epicentral dist =     89.0       pk     = {peak}
inst type=SMA-1      data source = USGS
*
*
*
{rows("8I10", numbers(48, -32768, facts))}
{rows("5ES15.7", reals)}
{said}"""


@record(
    "corrected.smc",
    SMC,
    seeds=[18],
    made={"scale": 30.0, "form": ".4e"},
    newline="\r\n",
)
def smc(made: Made) -> str:
    return f"""\
2 CORRECTED ACCELEROGRAM
{smc_header(made.peak, comments=3, count=N, rate=200.0)}\
{rows("8ES10.4E1", *made.waves)}
"""


@record(
    "raw.smc",
    SMC,
    seeds=[19],
    made={"scale": 30.0, "form": ".7e"},
    newline="\r\n",
)
def smc_precise(made: Made) -> str:
    return f"""\
1 UNCORRECTED ACCELEROGRAM
{smc_header(made.peak, comments=0, count=N, rate=200.0, precision=8)}\
{rows("5ES14.7", *made.waves)}
"""


@record("uneven.smc", SMC | {"tolerance": 1e-3}, line=UNEVEN, newline="\r\n")
def smc_uneven(made: Made) -> str:
    """Pairs of time and acceleration, at uneven times; the count is of all values."""
    return f"""\
1 UNCORRECTED ACCELEROGRAM
{smc_header(made.peak, comments=2, count=2 * N, rate=1.7e38)}\
{rows("8ES10.4E1", made.times, *made.waves)}
"""


@record("surplus.smc", SMC | {"tolerance": 1e-3}, line=UNEVEN, newline="\r\n")
def smc_surplus(made: Made) -> str:
    """Below the last pair a line of scattered points that the header does not count."""
    return f"{smc_uneven(made)} 3.0000E-1 1.0000E+1 4.0000E-1 2.0000E+1\n"


def esm_text(
    wave: Samples,
    location: str = "",
    kind: str = "ACCELERATION",
    first: str = "20190728_160905.700",
) -> str:
    """Header and samples of ESM's DYNA format."""
    return f"""\
EVENT_NAME: GREECE
EVENT_ID: EMSC-20190728_0000106
EVENT_DATE_YYYYMMDD: 20190728
EVENT_TIME_HHMMSS: 160908
MAGNITUDE_W:{" "}
MAGNITUDE_L: 4.6
NETWORK: HL
STATION_CODE: DLFA
STATION_NAME: Delfoi, Ελλάς
LOCATION: {location}
DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS: {first}
SAMPLING_INTERVAL_S: 0.005000
NDATA: {N}
STREAM: HNN
UNITS: cm/s^2
INSTRUMENT: sensor = CMG_5 [Unknown] | digitizer = Unknown [Unknown]
HEADER_FORMAT: DYNA 1.2
PGA_CM/S^2: {largest(wave)}
DATA_TYPE: {kind}
USER5:{" "}
{rows("1F0.6", wave)}
"""


@record("esm.ASC", ESM, seeds=[20], made={"scale": 3.0, "form": ".6f"})
def esm(made: Made) -> str:
    return esm_text(made.waves[0])


@record(
    "20230206011732_0118_ap_AAD_Acc_E.asc",
    ESM | {"start_time": "2010-11-14T23:09:19.300000Z"},
    seeds=[21],
    made={"scale": 3.0, "form": ".6f"},
)
def esm_tadas(made: Made) -> str:
    """As AFAD's TADAS delivers: a first line without a key, the kind and the day in another way."""
    text = esm_text(
        made.waves[0], "HATAY_HASSA", "Acceleration", "14/11/2010 23:09:19.300"
    )
    return f"""\
AAD_Filtered_TADAS_FILE
AAD_FILTER_TYPE: BUTTERWORTH
AAD_LOW_CUT_FREQUENCY_HZ: 0.025
{text}"""


@dataclass(frozen=True)
class GeonetHeader:
    """What differs between the headers of GeoNet's volumes."""

    component: str
    step: str  # words of the sampling interval
    digitised: int
    counts: Sequence[int]  # of acceleration, velocity and displacement
    dt: float
    facts: Mapping[int, Sequence[float]] = field(default_factory=dict)

    def above(self, wave: Samples) -> str:
        """Return the header below its first line."""
        facts = {
            **{8: [2016, 11], 18: [13, 11], 30: [self.digitised]},
            **{33: self.counts, 38: [2, 20500]},
        }
        reals = {10: [42.523, 172.830], 14: [7.82], 24: [0.005, self.dt]}
        return f"""\
Site HSES      42 31 24S  172 49 50E     Basalt file:  20161113_110300_HSES
Hanmer Springs Emergency Centre
Instrument Basalt_2430
Resolution: 24-bit   Instr Period: 0.0050 s   Damping: 0.700
Accelerogram 20161113_110256_HSES_20                 Processed 2016 December 09
5 km south-west of Waiau
2016 November 13         11:02:56 UT
Epicentre  42 41 33S 173 01 19E  Bearing S40E  Dist   25km  Depth   15km Mw 7.82
Number of points  {N}    Duration 0.86 s
{self.step}
Data is unfiltered
Component {self.component}
Acceleration:  Peak {largest(wave):8.1f} mm/s/s at  48.13 s     RMS   209.89 mm/s/s
Velocity record unevaluated
Displacement record unevaluated
{rows("10I8", numbers(40, 0, facts))}
{rows("10F8.3", numbers(60, 0, reals))}
"""


GEONET_WAVES = {"scale": 12000.0, "form": ".1f", "shift": -20000.0}


@record("hses.V1A", GEONET, seeds=[22, 23, 24], made=GEONET_WAVES)
def geonet_v1a(made: Made) -> str:
    """-1234.5 and more fill the columns, so that neighbours touch."""
    step = "Raw readings in units of 1.00 mm/s/s  at intervals of 0.005 s"
    text = ""
    for component, wave in zip(GEONET["components"], made.waves, strict=True):
        header = GeonetHeader(component, step, N, [N, 0, 0], 0.005)
        text += f"""\
Uncorrected accelerogram 20161113_110256_HSES_20 GNS Science
{header.above(wave)}\
{rows("10F8.1", wave)}
"""
    return text


@record("hses.V2A", GEONET | {"dt": 0.02}, seeds=[22, 23, 24], made=GEONET_WAVES)
def geonet_v2a(made: Made) -> str:
    step = "Instrument corrected data at 0.020 sec intervals"
    text = ""
    for component, wave in zip(GEONET["components"], made.waves, strict=True):
        header = GeonetHeader(component, step, 4 * N, [N, N, N], 0.02)
        text += f"""\
Corrected accelerogram 20161113_110256_HSES_20 GNS Science
{header.above(wave)}\
{rows("10F8.1", wave)}
{rows("10F8.2", wave / 10)}
{rows("10F8.3", wave / 100)}
"""
    return text


def cwa_data(made: Made) -> str:
    """Rows of a file of the CWA with what stands directly above them."""
    largest_ones = "".join(
        f"#AmplitudeMAX. {axis}:{wave.max():8.3f}~{wave.min():8.3f}\n"
        for axis, wave in zip("UNE", made.waves, strict=True)
    )
    return f"""\
#RecordLength(sec): 1
#SampleRate(Hz): 50
#AmplitudeUnit:  gal. DCoffset(corr)
{largest_ones}\
#DataSequence: Time U(+); N(+); E(+)
#Data: 4F10.3
{rows("4F10.3", made.times, *made.waves)}
"""


CWA_WAVES = {"scale": 40.0, "form": ".3f"}


@record("cwa.txt", CWA, seeds=[25, 26, 27], made=CWA_WAVES)
def cwa(made: Made) -> str:
    return f"""\
#Earthquake Information
#Origin Time(GMT+08): 2018/02/06-23:50:42
#Magnitude(Ml): 6.0
#StationCode: ECU
#StationName: Chulu
#StartTime(GMT+08): 2018/02/06-23:50:29.000
{cwa_data(made)}"""


@record(
    "cx921.txt",
    CWA | {"start_time": "1999-09-20T17:47:04.000000Z"},
    seeds=[25, 26, 27],
    made=CWA_WAVES,
)
def cwa_1999(made: Made) -> str:
    """As the CWB wrote the Chi-Chi earthquake: from the station's code on, in UTC."""
    return f"""\
#StationCode: ECU
#StartTime: 1999/09/20-17:47:04.000
{cwa_data(made)}"""


@record("plain.txt", PLAIN | {"dt": 0.02}, seeds=[28])
def plain_two_columns(made: Made) -> str:
    return lines("{:.7e}   {:.7e}", made.times, *made.waves) + "\n"


@record("plain.csv", PLAIN | {"dt": 0.01, "unit": "m/s2"}, seeds=[29], newline="\r\n")
def plain_csv(made: Made) -> str:
    return f"""\
Time (s),Acceleration (m/s^2)
{lines("{:g},{}", made.times, *made.waves)}
"""


@record("count.txt", PLAIN | {"dt": 0.005}, seeds=[31])
def plain_count_then_columns(made: Made) -> str:
    """Count and interval above two columns whose time starts at the interval."""
    return f"""\
 {N}  0.005
{lines(" {:.6g}   {}", made.times + 0.005, *made.waves)}
"""


@record("eqsig.txt", PLAIN | {"dt": 0.01}, seeds=[32])
def plain_one_column(made: Made) -> str:
    return f"""\
test-motion
{N} 0.0100
{lines("{}", *made.waves)}
"""


@record(
    "20170720223109_4806.txt",
    {
        **{"format": "AFAD", "dt": 0.01, "unit": "cm/s2", "station": "4806"},
        **{"start_time": "2017-07-20T22:30:59.000000Z", "tolerance": 1e-9},
        "components": ("N-S", "E-W", "U-D"),
    },
    seeds=[40, 41, 42],
    made={"scale": 40.0, "form": ".6f"},
    newline="\r\n",
    encoding="iso8859-9",
)
def afad(made: Made) -> str:
    """In the network's own ISO 8859-9."""
    first, second, third = map(largest, made.waves)
    return f"""\
STRONG GROUND MOTION RECORDS OF TURKIYE
PLACE                   : MUĞLA MİLAS
EARTHQUAKE DATE         : 2017/07/20 22:31:09 (GMT)
EARTHQUAKE MAGNITUDE    : 6.5 Mw
STATION ID              : 4806
STATION COORDINATES     : 37.30253N-27.78054E
RECORD TIME             : 20/07/2017 22:30:59.000000 (GMT)
NUMBER OF DATA          : {N}
SAMPLING INTERVAL (sec) : 0.01
RAW PGA VALUES (gal)    : (N-S) {first:.6f} (E-W) {second:.6f} (U-D) {third:.6f}
       N-S          E-W          U-D
{rows("3F13.6", *made.waves)}
"""


@record(
    "5526-1.V1",
    {
        **{"format": "BHRC", "dt": 0.005, "unit": "g/10", "station": "Avin"},
        **{"components": ("L", "V", "T"), "tolerance": 1e-7},
    },
    seeds=[43, 44, 45],
    made={"scale": 0.05, "form": ".7f"},
)
def bhrc(made: Made) -> str:
    """Lines of numbers in the header are cut after 70 columns."""
    header = (
        f"{rows('16I5', numbers(100))}\n{rows('8E13.6', numbers(50, 0, {8: [200]}))}"
    )
    cut = "\n".join(line[:70] for line in header.split("\n"))
    text = ""
    for name, wave in zip("LVT", made.waves, strict=True):
        text += f"""\
* VOL1DS FILE:  5526/01
Inst Type = SSA-2
Origin Time : 2012/08/11   12:23:16

{name}

COMP {name}1
Avin                      Station   37.734 N 47.801 E   Altitude 2026m   Azimuth L 50    T 140
Epicenter 38.520 N 46.860 E   FD 12 Km mb      Ms      Mw6.1   M        ML   (BHRC)
INSTR PERIOD =  .020 SEC   DAMPING =  .640
NO. OF POINTS =   {N}      DURATION =  0.215
UNITS ARE SECONDS AND G/10

{cut}
{rows("10E13.6", wave)}
/&
"""
    return text


def unam_text(waves: Samples, channels: str) -> str:
    """Two samples more than the nominal duration has; the record begins after midnight."""
    peaks = "".join(f"/{largest(wave)}" for wave in waves)
    return f"""\
ARCHIVO ESTANDAR DE ACELERACION:
NOMBRE DE LA ESTACION                  : IDEI PATIO 5
CLAVE DE LA ESTACION                   : CUP5
LOCALIZACION DE LA ESTACION            : Ingeniería,
                                       : México
COORDENADAS DE LA ESTACION             : 19.33024 LAT. N
                                       : 99.181076 LONG. W
ORIENTACION C1-C6 (rumbo;orientacion)  : {channels}
INTERVALO DE MUESTREO, C1-C6 (s)       : /0.004/0.004/0.004
FECHA DEL SISMO [GMT]                  : 2004/01/01
HORA EPICENTRO (GMT)                   : 23:58:02.7
MAGNITUD(ES)                           : /Mb=5.2/Ms=5.8
HORA DE LA PRIMERA MUESTRA (GMT)       : 00:00:01
NUM. TOTAL DE MUESTRAS, C1-C6          : /{N - 2}/{N - 2}/{N - 2}
ACEL. MAX.(Gal), C1-C6                 : {peaks}
ACEL. MAX., C1-C6, EN LA MUESTRA       : /7/8/9
UNIDADES DE LOS DATOS                  : Gal (cm/s/s)
FORMATO DATOS (FORTRAN,10 campos/dato) : 3F10.3
DATOS DE ACELERACION:
---------+---------+---------+
   CANAL-1   CANAL-2   CANAL-3
         V      N90E      N00E
---------+---------+---------+
{rows("3F10.3", *waves)}
"""


@record(
    "CUP50401.012",
    UNAM | {"components": ("V", "N90E", "N00E")},
    seeds=[46, 47, 48],
    made={"scale": 40.0, "form": ".3f"},
    encoding="latin-1",
)
def unam(made: Made) -> str:
    return unam_text(made.waves, "/V/N90E/N00E")


@record(
    "RAC_04042010222544.dat",
    UNAM | {"components": ("N90E", "N00E", "V")},
    seeds=[46, 47, 48],
    made={"scale": 40.0, "form": ".3f"},
    encoding="latin-1",
)
def unam_senses(made: Made) -> str:
    """Orientations with their sense behind them, in another order of channels."""
    return unam_text(made.waves, "/N90E;/N00E;/V;+")


@record(
    "ua0004.dat",
    {
        **{"format": "CSMNC", "dt": 0.005, "unit": "cm/s2", "station": "65SBY"},
        "components": ("EW",),
    },
    seeds=[49],
    made={"scale": 3.0, "form": ".6f"},
)
def csmnc(made: Made) -> str:
    return f"""\
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
PEAK VALUE:  {largest(made.waves[0]):7.3f}   AT   22.89 SEC    DURATION:  44 SEC
PRE-EARTHQUAKE TIME:  20  SEC  RECORDER TIME:  2012-01-3 15:40:00.000 BTM
CSMNC

{rows("8F14.6", *made.waves)}
"""


@record(
    "017m30bt.s0a",
    USC2 | {"station": "0061", "components": ("N08W",)},
    seeds=[50],
    made={"scale": 200.0, "form": ".3f"},
)
def usc_volume_2(made: Made) -> str:
    return f"""\
CORRECTED ACCELEROGRAM  IIBB127  94.610.0 COMP N08W   FILE   0  CORRESPONDING T
FILE     0 OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I:
NORTHRIDGE EARTHQUAKE
JAN 17, 1994 -1230 GMT
IBB127  94.610.0 N
STATION USC# 0061   34 17 11N, 118 13 31W
BIG TUJUNGA STATION, ANGELES NATIONAL FOREST, CA
COMP N08W
  {N}  INSTRUMENT AND BASELINE CORRECTED DATA
PEAK ACCELERATION =  {made.peak}  CMS/SEC/SEC AT    4.580   SEC.
{rows("16I5", numbers(100))}
{rows("8F10.3", numbers(100))}
  {N} POINTS OF ACC DATA EQUALLY SPACED AT   .020 SEC.
{rows("8F10.3", *made.waves)}
"""


@record(
    "iia001.v2",
    USC2 | {"station": "117", "components": ("S00E",)},
    seeds=[60],
    made={"scale": 200.0, "form": ".3f"},
)
def eerl_volume_2(made: Made) -> str:
    """Count, interval and unit in words alone, three sections without titles."""
    sections = "\n".join(
        rows("8F10.3", factor * made.waves[0]) for factor in (1.0, 0.1, 0.01)
    )
    return f"""\
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
PEAK ACCELERATION =  {made.peak}  CMS/SEC/SEC AT    2.120   SEC.
{rows("16I5", numbers(100))}
{rows("8F10.3", numbers(100))}
{sections}
"""


@record(
    "usaca40.044",
    {
        **{"format": "AGRAM", "dt": 0.005, "unit": "cm/s2", "components": ("090",)},
        **{"station": "WHITTIER, 7215 BRIGHT AVE, 10TH FLOOR", "tolerance": 1e-9},
        "start_time": "1987-10-01T14:42:00.000000Z",
    },
    seeds=[51, 52, 53],
    made={"scale": 200.0, "form": ".2f", "shift": -2000.0},
)
def agram(made: Made) -> str:
    """-1234.56 and more fill the columns, so that neighbours touch."""
    text = ""
    for kind, section in zip(("AC", "VL", "DP"), made.waves, strict=True):
        text += f"""\
 WHITTIER, 7215 BRIGHT AVE, 10TH FLOOR
 090 DEGREES
 EARTHQUAKE OF OCTOBER 1, 1987 1442 GMT
 BUTTERWORTH AT .25 HZ, ORDER 4
 YEAR=1987 JULIAN DAY=274 HOUR=14 MINUTE=42 SECOND= 0 COMPONENT=  90
 SAMPLES/SEC=200 FILTER TYPE=BUTTERWORTH  CORNER= 0.25 ORDER=4 DATA TYPE={kind}
 NO OF POINTS=  {N}, UNITS=CM/SEC**2, CM/SEC, AND CM
{rows("10F8.2", section)}
"""
    return text


@record(
    "three.csv",
    PLAIN | {"dt": 0.01, "unit": "cm/s2", "components": ("NS", "EW", "UD")},
    seeds=[54, 55, 56],
    made={"scale": 40.0, "form": ".8f"},
)
def columns(made: Made) -> str:
    return f"""\
time,acc_NS(gal),acc_EW(gal),acc_UD(gal)
{lines("{:.2f},{},{},{}", made.times, *made.waves)}
"""


@record(
    "avd.csv",
    PLAIN | {"dt": 0.01, "unit": "g"},
    seeds=[57],
    made={"form": ".6f"},
    encoding="utf-8-sig",
)
def columns_of_quantities(made: Made) -> str:
    """Behind a byte-order mark, with decimal commas, and velocity and displacement beside."""
    table = lines("{:.2f};{};{:.6f};0.5", made.times, made.waves[0], 2 * made.waves[0])
    titles = "Time [s];Acceleration [g];Velocity [m/s];Displacement [m]"
    return f"{titles}\n{table.replace('.', ',')}"


@record(
    "ARL360.g3",
    PLAIN | {"dt": 0.02, "tolerance": 1e-7, "stated_dt": False},
    seeds=[58],
)
def rows_of_numbers(made: Made) -> str:
    return f"""\
{rows("5E15.7", *made.waves)}
 *** End data ***
"""


@record(
    "series.tcl",
    {"format": "OPENSEES", "dt": 0.02, "unit": "m/s2", "components": ("7",)},
    seeds=[59],
    factor=2.0,
)
def opensees(made: Made) -> str:
    return f"""\
# acceleration in m/s2
set g 9.81
timeSeries Path 7 -dt 0.02 -values {{
{rows("6F10.5", *made.waves)}
}} -factor 2.0
pattern UniformExcitation 1 1 -accel 7
"""


def knet_text() -> str:
    """Return four seconds of K-NET at 100 Hz, which ObsPy reads."""
    samples = np.round(1e4 * np.sin(np.arange(400) * 0.1))
    peak = abs(largest(samples - samples.mean())) * 7845 / 8223790
    return f"""\
Origin Time       2018/01/24 19:51:00
Lat.              41.0
Long.             142.5
Depth. (km)       34
Mag.              6.3
Station Code      AOM001
Station Lat.      41.5
Station Long.     140.9
Station Height(m) 10
Record Time       2018/01/24 19:51:43
Sampling Freq(Hz) 100Hz
Duration Time(s)  4
Dir.              E-W
Scale Factor      7845(gal)/8223790
Max. Acc. (gal)   {peak:.3f}
Last Correction   2018/01/24 19:51:27
Memo.
{rows("8F9.0", samples)}
"""


def search_results(count: int) -> str:
    """Return what PEER's database says of ``count`` records of a download."""
    listed = ""
    for i in range(count):
        stem = f"RSN{700 + i}_LOMAP_S{i:02d}"
        # every fourth record has no vertical component
        upright = f"{stem}-UP.AT2" if i % 4 else "-" * 21
        listed += (
            f"{i + 1}, SRSS, {700 + i}, -----, {1 + i / 10:.4f}, -----, 7.0, 12.0, 2.1, "
            f'"Loma Prieta", 1989, "Station {i}", 6.93, Reverse Oblique, {3 + i:.2f}, {4 + i:.2f}, '
            f"462.2, 0.25, {stem}000.AT2, {stem}090.AT2, {upright}\n"
        )
    return f"""\
PEER Ground Motion Database Search Results

 -- Summary of PEER Ground Motion Database Search Criteria --
Target Spectrum,No Scaling

 -- Summary of Metadata of Selected Records --
Result ID, Spectral Ordinate, Record Sequence Number, MSE, Scale Factor, Tp(s), 5-75% Duration(sec), \
5-95% Duration (sec), Arias Intensity (m/sec), Earthquake Name, Year, Station Name, Magnitude, \
Mechanism, Rjb (km), Rrup (km), Vs30 (m/sec), Lowest Useable Frequency (Hz), Horizontal-1 Acc. \
Filename, Horizontal-2 Acc. Filename, Vertical Acc. Filename
{listed}
 -- Unscaled Horizontal & Vertical Spectra
T (s), pSa (g)
"""


def peer_file(second_line: str, words: str, samples: Samples) -> str:
    """Return a file of PEER's database whose header says so."""
    return f"""\
PEER NGA STRONG MOTION DATABASE RECORD
{second_line}
{words}
NPTS=     {N}, DT=   .0050 SEC,
{rows("5E15.7", samples)}
"""
