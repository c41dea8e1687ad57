"""The peak that a header states is held against the samples, in every network's format."""

import re

import pytest

from rockfrag.base.errors import InputError
from rockfrag.records.quality_flags import quality_flags
from rockfrag.records.read import motion_of, read_motion, read_record

from .built_records import build
from .record_texts import knet_text

STATED = {
    "afad": r"RAW PGA VALUES \(gal\)    : \(N-S\) ",
    "cosmos_v1": r"(?<!Uncor) Max = ",
    "cosmos_touching": r"(?<!Uncor) Max = ",
    "csmip_v1": r"MAX  = ",
    "csmip_v1_pairs": r"MAX  = ",
    "csmip_v2": r"PEAK ACCELERATION = ",
    "csmnc": r"PEAK VALUE: ",
    "cwa": r"#AmplitudeMAX\. U:",
    "esm": r"PGA_CM/S\^2: ",
    "geonet_v1a": r"Acceleration:  Peak ",
    "geonet_v2a": r"Acceleration:  Peak ",
    "renadic": r"MAX  = ",
    "smc": r"pk     = ",
    "unam": r"ACEL\. MAX\.\(Gal\), C1-C6                 : /",
}
"""What stands before the peak of the first channel, in the built record of each kind."""


def with_peak(kind, folder, factor):
    """Write a built record whose header states the peak of its first channel times a factor."""
    path = build(kind, folder).path
    text = path.read_bytes().decode("latin-1")
    match = re.search(rf"{STATED[kind]}.*", text)
    changed = re.sub(r"-?\d+\.\d+", lambda found: _times(found[0], factor), match[0])
    text = text[: match.start()] + changed + text[match.end() :]
    path.write_bytes(text.encode("latin-1"))
    return path


def _times(words, factor):
    return f"{float(words) * factor:.{len(words.partition('.')[2])}f}"


@pytest.mark.parametrize("kind", STATED)
def test_another_peak_than_that_of_the_samples_is_refused(tmp_path, kind):
    for factor in (0.25, 4.0, 980.665):
        path = with_peak(kind, tmp_path, factor)
        with pytest.raises(InputError, match=r"header states a peak of .*samples have"):
            read_record(path)
    assert read_record(with_peak(kind, tmp_path, 1.0)).channels


@pytest.mark.parametrize("kind", STATED)
def test_a_small_difference_as_of_a_correction_is_said(tmp_path, kind):
    flags = {}
    for factor in (1.0, 0.85, 1.15):
        record = read_record(with_peak(kind, tmp_path, factor))
        motion = motion_of(record, record.channels[0])
        flags[factor] = [f for f in quality_flags(motion) if "that of its header" in f]
    assert flags[1.0] == []
    # one of the two may be the peak about the mean
    assert len(flags[0.85] + flags[1.15]) in (1, 2)


def test_the_peak_of_knet_is_about_the_mean(tmp_path):
    text = knet_text()
    path = tmp_path / "AOM0011801241951.EW"
    path.write_text(text)
    peak = read_motion(path).pga
    assert f"Max. Acc. (gal)   {100 * peak:.3f}" in text
    path.write_text(re.sub(r"(Max\. Acc\. \(gal\)   )", r"\g<1>9", text))
    with pytest.raises(InputError, match="header states a peak"):
        read_motion(path)


def test_a_file_that_is_cut_short_may_lack_its_peak_but_not_exceed_it(tmp_path):
    path = with_peak("geonet_v1a", tmp_path, 3.0)
    text = path.read_text()
    path.write_text(text[: text.rindex("\n", 0, len(text) - 10) - 200])
    assert read_record(path, cut_short=True).channels[0].npts > 0
    path = with_peak("geonet_v1a", tmp_path, 0.2)
    with pytest.raises(InputError, match="header states a peak"):
        read_record(path, cut_short=True)
