"""Text files of records by a generator that knows the truth: what is read must be it, or nothing is read.

Unit × factor × titles × language × times × header, as networks, laboratories and telephones write them. The tables
here are the generator's own; nothing of the package's tables is used. A motion that comes out must be one of the
components, in m/s², with its interval; velocities, forces, magnitudes and verticals are no horizontal motions.
"""

import random
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.errors import InputError
from rockfrag.records.parsing.directions import is_vertical
from rockfrag.records.read import motion_of, read_record

from .damage import Attempt

G = 9.81
UNITS = {
    **dict.fromkeys(("g", "G", "g's", "gn"), G),
    **dict.fromkeys(("m/s2", "m/s²", "m/s^2", "m/s/s", "m/sec2", "m/sec/sec"), 1.0),
    **dict.fromkeys(
        ("m·s⁻²", "m.s-2", "m s-2", "m/s**2", "м/с²", "м/с2", "m/seg2"), 1.0
    ),
    **dict.fromkeys(
        ("cm/s2", "cm/s²", "cm/s/s", "CM/SEC/SEC", "cm/sec^2", "см/с²"), 0.01
    ),
    **dict.fromkeys(("gal", "Gal", "gals", "cm s^-2", "cm/seg^2", "ガル"), 0.01),
    **dict.fromkeys(("mm/s2", "mm/s^2", "mm/s/s"), 1e-3),
    **{"%g": G / 100, "g/10": G / 10, "mg": G / 1e3, "milli-g": G / 1e3},
    **{"µg": G / 1e6, "ug": G / 1e6, "mGal": 1e-5, "µm/s²": 1e-6, "nm/s2": 1e-9},
    **{"ft/s2": 0.3048, "ft/s²": 0.3048, "ft/s/s": 0.3048, "in/s2": 0.0254},
    **{"dm/s2": 0.1, "dm/s²": 0.1, "in/sec/sec": 0.0254, "inch/s2": 0.0254},
}
"""Writings of units of acceleration, and m/s² of each."""

TAILS = {"g": G, "m_s2": 1.0, "ms2": 1.0, "m/s2": 1.0, "cm_s2": 0.01, "cms2": 0.01}
TAILS |= {"gal": 0.01, "mg": G / 1e3, "milli_g": G / 1e3, "ft_s2": 0.3048, "mps2": 1.0}
"""The same behind an underscore of a title."""

UNKNOWN = {
    "kyd/s2": 914.4,
    "furlong/s²": 201.168,
    "V": 3.3,
    "LSB": 6e-4,
    "yd/s^2": 0.9144,
}
UNKNOWN |= {"mV": 1e-3, "counts": 1e-5, "widgets/s2": 2.5, "N": 4.0, "kN": 40.0}
"""Units of which nothing is known, and m/s² that each may be."""

# numbers in a unit with the factor are as many times those in the unit
FACTORS = {
    "10-3 {}": 1e3,
    "10^-3 {}": 1e3,
    "1e-3 {}": 1e3,
    "0.001 {}": 1e3,
    "10⁻² {}": 1e2,
}
FACTORS |= {"{} x1000": 1e3, "{} x 100": 1e2, "{}*1000": 1e3, "1000*{}": 1e3}
FACTORS |= {"{} × 10": 10.0, "x9.81 {}": 1 / 9.81, "{} x 10-3": 1e3, "{}/1000": 1e3}
WORDS_OF_FACTORS = {
    "multiply by 0.001": 1e3,
    "multiplier: 0.001": 1e3,
    "Scale factor: 0.01": 1e2,
    "scale = 0.5": 2.0,
    "Conversion factor 0.001": 1e3,
    "values multiplied by 100": 1e2,
    "Factor de escala: 0.001": 1e3,
    "Skalierungsfaktor: 0.001": 1e3,
    "facteur d'échelle = 0.1": 10.0,
    "(x1000)": 1e3,
}


@dataclass(frozen=True)
class Language:
    """Words of a language."""

    time: str
    acceleration: str
    velocity: str
    directions: tuple[tuple[str, str, str], ...]  # two horizontal, a vertical
    interval: str
    rate: str
    count: str
    unit: str
    encodings: tuple[str, ...] = ("utf-8",)


WESTERN = ("utf-8", "latin-1")
EN = Language(
    "Time",
    "Acceleration",
    "Velocity",
    (
        *(("NS", "EW", "UD"), ("EW", "NS", "VER"), ("N00E", "N90E", "UPDO")),
        *(("LONG", "TRAN", "VERT"), ("H1", "H2", "V"), ("S00E", "N90E", "UP")),
        *(("x", "y", "z"), ("Longitudinal", "Transversal", "Vertical"), ("HNN", "HNE", "HNZ")),
        *(("HN1", "HN2", "HN3"), ("North", "East", "Up"), ("N", "E", "Z"), ("L", "T", "V")),
        *(("X-axis", "Y-axis", "Z-axis"), ("S90W", "S00E", "DOWN"), ("R", "T", "Z")),
    ),
    *("Sampling interval", "Sampling rate", "Number of points", "Units"),
)  # fmt: skip
LANGUAGES = (
    *(EN,) * 6,
    Language(
        "Tiempo", "Aceleración", "Velocidad", (("NS", "EO", "Vertical"), ("Norte", "Este", "Vertical")),
        *("INTERVALO DE MUESTREO", "Tasa de muestreo", "NUMERO DE DATOS", "UNIDADES"), WESTERN,
    ),
    Language(
        "Temps", "Accélération", "Vitesse", (("Nord", "Est", "Vertical"),),
        *("Pas de temps", "Fréquence d'échantillonnage", "Nombre de points", "Unité"), WESTERN,
    ),
    Language(
        "Zeit", "Beschleunigung", "Geschwindigkeit", (("Nord", "Ost", "Vertikal"), ("NS", "OW", "Z")),
        *("Abtastintervall", "Abtastrate", "Anzahl der Werte", "Einheit"), WESTERN,
    ),
    Language(
        "Tempo", "Accelerazione", "Velocità", (("NS", "EO", "Verticale"),),
        *("Passo di campionamento", "Frequenza di campionamento", "Numero di punti", "Unità di misura"), WESTERN,
    ),
    Language(
        "Zaman", "İvme", "Hız", (("Kuzey", "Doğu", "Düşey"), ("KG", "DB", "Düşey")),
        *("Örnekleme aralığı", "Örnekleme frekansı", "Veri sayısı", "Birim"), ("utf-8", "cp1254"),
    ),
    Language(
        "Время", "Ускорение", "Скорость", (("С-Ю", "В-З", "Верт"), ("Север", "Восток", "Вертикаль")),
        *("Шаг дискретизации", "Частота дискретизации", "Число точек", "Единицы"), ("utf-8", "cp1251"),
    ),
    Language(
        "时间", "加速度", "速度", (("南北", "东西", "垂直"), ("NS", "EW", "上下")),
        *("采样间隔", "采样率", "数据点数", "单位"), ("utf-8", "gbk"),
    ),
    Language(
        "時間", "加速度", "速度", (("南北", "東西", "上下"), ("NS", "EW", "UD")),
        *("サンプリング間隔", "サンプリング周波数", "データ数", "単位"), ("utf-8", "cp932"),
    ),
    Language(
        "Χρόνος", "Επιτάχυνση", "Ταχύτητα", (("N", "E", "Z"),),
        *("Βήμα χρόνου", "Συχνότητα δειγματοληψίας", "Αριθμός σημείων", "Μονάδα"), ("utf-8", "cp1253"),
    ),
)  # fmt: skip
# a language that nobody here knows
UNHEARD = Language(
    *("Aika", "Kiihtyvyys", "Nopeus", (("x", "y", "z"),)),
    *("Askel", "Taajuus", "Määrä", "Yksikkö"),
)
LANGUAGES = (*LANGUAGES, UNHEARD)

OTHERS = (("Force (kN)", "kN"), ("Temperature (C)", "C"), ("Displacement (mm)", "mm"))
OTHERS += (("Foo", "mm"), ("LVDT (mm)", "mm"), ("Strain (µε)", "µε"), ("Laser", "mm"))
OTHERS += (("Fuerza (kN)", "kN"), ("Voltage (V)", "V"), ("Angle (deg)", "deg"))
CLOCKS = ("2023-05-09T10:00:{:07.4f}", "2023-05-09 10:00:{:07.4f}", "10:00:{:07.4f}")
# of telephones and loggers
MAGNITUDES = (
    "Absolute acceleration",
    "Magnitude",
    "Total",
    "TgF",
    "aT",
    "Resultant",
    "Foo",
)
PEAKS = (
    *("PGA = {} {}", "Peak acceleration: {} {}", "Max. acc. {} {} at 0.2 s"),
    *("Aceleración máxima: {} {}", "最大加速度: {} {}", "Maximum value ({1}): {0}"),
)
INTERVALS = (0.005, 0.01, 0.02, 0.004, 0.0025, 0.002)


@dataclass
class Draft:
    """A file while it is drawn, and what is true of it."""

    rng: random.Random
    language: Language
    truth: NDArray[np.float64]  # components [m/s²], shape (k, n)
    dt: float
    header: list[str] = field(default_factory=list)
    titles: list[str] = field(default_factory=list)
    units: list[str] = field(default_factory=list)  # of a line of units
    cells: list[list[str]] = field(default_factory=list)  # of each column
    asked: dict[str, Any] = field(default_factory=dict)
    # whether all that must be known stands there, in words that are known and meant one way
    is_plain: bool = True
    has_another: bool = False  # whether a column is no acceleration
    contradiction: str = ""  # what is stated in two ways that exclude each other

    def column(
        self, title: str, unit: str, numbers: Iterable[float], form: str
    ) -> None:
        """Add a column."""
        self.titles.append(title)
        self.units.append(unit or "-")
        self.cells.append([form.format(number) for number in numbers])


@dataclass(frozen=True)
class Scale:
    """The unit of the numbers: where it is stated, how, and how many of it are 1 m/s²."""

    place: str  # ``title``, ``tail``, ``below``, ``words``, ``nowhere``
    writing: str
    per_m_s2: float

    def title(self, words: str, rng: random.Random) -> str:
        """Return a title with the unit, if it stands there."""
        if self.place == "tail":
            return f"{words}_{self.writing}"
        bracket = rng.choice(("({})", "[{}]", "({})")).format(self.writing)
        return f"{words} {bracket}" if self.place == "title" else words


def draw(rng: random.Random) -> tuple[bytes, Draft]:
    """Return a file that states what it holds in some way, or fails to, and what is true of it."""
    language = rng.choice(LANGUAGES)
    k, count = rng.choice((1, 1, 2, 3, 3)), rng.randint(30, 70)
    draft = Draft(rng, language, _waves(rng, k, count), rng.choice(INTERVALS))
    draft.is_plain = language is not UNHEARD
    scale = _scale(draft)
    _add_times(draft)
    directions = ("", "", "") if k == 1 else rng.choice(language.directions)
    for name, wave in zip(directions, draft.truth, strict=False):
        forms = ("{a} {n}", "{n}", "{n} {a}") if name else ("{a}",)
        words = rng.choice(forms).format(a=language.acceleration, n=name)
        title = scale.title(words, rng)
        form = rng.choice(("{:.7e}", "{:.9g}"))
        draft.column(title, scale.writing, wave * scale.per_m_s2, form)
    if rng.random() < 0.15:
        _add_peak(draft)
    if k == 3 and rng.random() < 0.3:
        title = scale.title(rng.choice(MAGNITUDES), rng)
        length = np.sqrt(((draft.truth * scale.per_m_s2) ** 2).sum(axis=0))
        draft.column(title, scale.writing, length, "{:.9e}")
    elif rng.random() < 0.3:
        _add_another(draft)
    return _written(draft, scale), draft


def _add_peak(draft: Draft) -> None:
    """Say the largest peak in words, in a unit of its own, or another one."""
    rng, unit = draft.rng, draft.rng.choice(("g", "gal", "m/s2", "cm/s/s"))
    peak = float(np.abs(draft.truth).max()) / UNITS[unit]
    is_true = rng.random() < 0.6
    words = rng.choice(PEAKS).format(f"{peak if is_true else 3 * peak:.6g}", unit)
    draft.header.append(words)
    # the unit of the samples is not always known, and of several channels it may be another's
    if not is_true:
        draft.is_plain = False
        if len(draft.truth) == 1:
            draft.contradiction = "another peak"


def _waves(rng: random.Random, k: int, count: int) -> NDArray[np.float64]:
    """Return components [m/s²] that look like motions, with peaks below 3 g; the vertical may have gravity."""
    noise = np.random.default_rng(rng.getrandbits(32)).normal(size=(k, count + 4))
    waves = sum(noise[:, i : i + count] for i in range(5)) * rng.choice((0.1, 0.2, 0.8))
    if k == 3 and rng.random() < 0.2:
        waves[2] += G
    return np.asarray(waves)


def _scale(draft: Draft) -> Scale:
    """Draw the unit of the numbers, a factor beside it, and what the user says of it."""
    rng = draft.rng
    place = rng.choice(("title", "title", "title", "tail", "below", "words", "nowhere"))
    known = TAILS if place == "tail" else UNITS
    if place not in ("tail", "nowhere") and rng.random() < 0.12:
        known, draft.is_plain = UNKNOWN, False
    writing = rng.choice(list(known))
    per_m_s2 = 1 / known[writing]
    if place == "nowhere":
        if rng.random() < 0.6:
            writing, draft.asked = "g", {"unit": "g"}
            per_m_s2 = 1 / G
        else:
            draft.is_plain = False
    elif rng.random() < 0.2 and not (place == "words" and draft.language is UNHEARD):
        draft.asked["unit"] = rng.choice(("g", "m/s2", "gal"))
        draft.is_plain = False
    if place in ("title", "words") and rng.random() < 0.2:
        form = rng.choice(list(FACTORS))
        writing, per_m_s2 = form.format(writing), per_m_s2 * FACTORS[form]
        draft.is_plain = False
    elif rng.random() < 0.1:
        words = rng.choice(list(WORDS_OF_FACTORS))
        draft.header.append(words)
        per_m_s2 *= WORDS_OF_FACTORS[words]
        draft.is_plain = False
    if place == "words":
        draft.header.append(f"{draft.language.unit}: {writing}")
    return Scale(place, writing, per_m_s2)


def _add_times(draft: Draft) -> None:
    """Draw how the interval is known: times, a clock, words, the user, or not at all."""
    rng, words, dt = draft.rng, draft.language, draft.dt
    numbers = np.arange(draft.truth.shape[1])
    kind = rng.choice(
        ("s", "s", "ms", "clock", "index", "words", "words", "user", "no")
    )
    if kind in ("s", "ms"):
        unit = kind if kind == "ms" or rng.random() < 0.7 else ""
        title = f"{words.time} ({unit})" if unit else words.time
        times = numbers * dt * (1e3 if kind == "ms" else 1.0)
        draft.column(title, kind, times, rng.choice(("{:.4f}", "{:.8g}")))
    elif kind == "clock":
        form = rng.choice(CLOCKS)
        draft.column("timestamp", "", numbers, "{}")
        draft.cells[-1] = [form.format(10 + n * dt) for n in numbers]
    elif kind == "index":
        draft.column(rng.choice(("No", "Sample", "#")), "", numbers + 1, "{:.0f}")
    elif kind == "no":
        draft.is_plain = False
    if kind in ("words", "index"):
        lines = f"{words.interval} (s): {dt:g}", f"{words.rate}: {1 / dt:g} Hz"
        draft.header.append(rng.choice(lines))
    if kind == "user" or (words is UNHEARD and kind in ("words", "index")):
        draft.asked["dt"] = dt
    elif kind not in ("clock", "no") and rng.random() < 0.2:
        # the user says something else
        draft.asked["dt"] = rng.choice((2 * dt, dt / 2))
        draft.is_plain = False
        if words is not UNHEARD:
            draft.contradiction = "another interval of the user"
    if rng.random() < 0.2:
        off = rng.choice((0, 0, 7))
        draft.header.append(f"{words.count}: {numbers.size + off}")
        draft.is_plain = draft.is_plain and not off
        if off and words is not UNHEARD:
            draft.contradiction = "another count"


def _add_another(draft: Draft) -> None:
    """Add a column that is no acceleration; where no other says so, nothing tells that it is none."""
    rng, wave = draft.rng, draft.truth[0]
    if rng.random() < 0.5 and draft.language is not UNHEARD:
        title, unit = draft.language.velocity, rng.choice(("m/s", "cm/s"))
        draft.column(f"{title} ({unit})", unit, np.cumsum(wave) * 0.37 + 0.01, "{:.6e}")
    else:
        # nobody can tell two titles that say nothing
        known = [other for other in OTHERS if "(" in other[0]]
        title, unit = rng.choice(known if draft.language is UNHEARD else OTHERS)
        draft.column(title, unit, np.cumsum(np.cumsum(wave)) * 0.11 + 0.7, "{:.6e}")
    draft.is_plain, draft.has_another = False, True


def _written(draft: Draft, scale: Scale) -> bytes:
    """Return the bytes of the file."""
    rng, count = draft.rng, len(draft.cells)
    comma = rng.random() < 0.15
    mark = rng.choice((";", "\t") if comma else (",", ",", ";", "\t", "   "))
    rows = [mark.join(cells) for cells in zip(*draft.cells, strict=True)]
    if comma:
        rows = [row.replace(".", ",") for row in rows]
    elif mark == "," and rng.random() < 0.2:
        rows = [",".join(f'"{cell}"' for cell in row.split(",")) for row in rows]
    lines = list(draft.header)
    if rng.random() < 0.3:
        lines.append(f"Record of {rng.choice(('a test', 'Station A', 'table 3'))}")
    rng.shuffle(lines)
    # what a column without a title holds that is no acceleration, nobody can know
    must = scale.place in ("title", "tail", "below") or draft.has_another
    titled = must or rng.random() < 0.8
    if (titled and count > 1) or scale.place in ("title", "tail"):
        lines.append(mark.join(draft.titles))
    if scale.place == "below" and count == 1:
        # its unit is not stated, and whatever the user says is believed
        draft.asked.pop("unit", None)
    if scale.place == "below" and count > 1:
        lines.append(mark.join(draft.units))
    if count == 1 or not titled:
        # nothing tells columns from a series that goes on row after row
        draft.is_plain = False
    if rng.random() < 0.2:
        lines = [f"# {line}" for line in lines]
    text = "\n".join([*lines, *rows]) + "\n"
    encoding = rng.choice(draft.language.encodings)
    if "м" in scale.writing and "cp1251" not in draft.language.encodings:
        encoding = "utf-8"  # nobody writes a Russian unit in a Japanese encoding
    try:
        return text.encode(encoding)
    except UnicodeEncodeError:
        return text.encode()


def wrong_in(path: Path, draft: Draft) -> str:
    """Read a file, and return what is wrong of what comes out; an :class:`InputError` if it is refused."""
    record = read_record(path, draft.asked.get("dt"))
    for channel in record.channels:
        motion = motion_of(record, channel, draft.asked.get("unit"))
        if abs(motion.dt - draft.dt) > 1e-5 * draft.dt:
            return f"an interval of {motion.dt:g} s, not {draft.dt:g} s"
        mean = motion.acceleration.mean()
        if motion.acceleration.size != draft.truth.shape[1]:
            return f"{motion.acceleration.size} samples"
        off = [
            float(np.abs(motion.acceleration - mean - (wave - wave.mean())).max())
            for wave in draft.truth
        ]
        if min(off) > 1e-4 * np.abs(draft.truth).max():
            return f"{channel.component!r} is none of the components"
        if draft.contradiction:
            return f"{draft.contradiction} is passed over"
        is_third = len(draft.truth) == 3 and int(np.argmin(off)) == 2
        if is_named(channel.component) and is_vertical(channel.component) != is_third:
            return f"{channel.component!r} is taken for another direction"
    return ""


def is_named(component: str) -> bool:
    """Tell whether a component has the name that the file gives it, and no number."""
    return bool(component) and not component.startswith("column")


def texts(folder: Path) -> Callable[[random.Random], Attempt]:
    """Return what makes files for the harness."""
    path = folder / "text.txt"

    def make(rng: random.Random) -> Attempt:
        content, draft = draw(rng)
        path.write_bytes(content)

        def attempt() -> None:
            try:
                wrong = wrong_in(path, draft)
            except InputError:
                assert not draft.is_plain, "a plain file is refused"
                raise
            assert not wrong, wrong

        return path, attempt

    return make
