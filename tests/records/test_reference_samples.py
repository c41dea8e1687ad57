"""Real records of every format, with the facts that notes or an independent reading of them give."""

import numpy as np
import obspy
import pytest
from obspy import UTCDateTime

from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import (
    FORMATS,
    choose_channel,
    motion_of,
    read_motion,
    read_record,
)

from ..case_tables import case_tables

SYLMAR = "world/archives/24514_Sylmar_OliveView_MedicalCenterFF.zip"
SMC_OF_ONE_LINE_MORE = "world/smc/891018_1.sma-1.0444a.smc"
CASES = case_tables(__file__)


@pytest.mark.parametrize(
    "sample", CASES["samples"], ids=lambda sample: sample[0].split("/")[-1]
)
def test_a_sample_is_read_with_its_facts(shared, sample):
    file, unit, name, station, start, npts, dt, stored, peaks = sample
    path = shared / "records" / "formats" / file
    record = read_record(path)
    assert record.format == name
    assert len(record.channels) == len(peaks)
    for channel, peak in zip(record.channels, peaks, strict=True):
        motion = read_motion(path, unit=unit, channel=channel.label or None)
        assert motion.metadata["station"] == station
        assert motion.metadata["unit"] == stored
        assert motion.dt == dt
        if start is None:
            assert motion.metadata["start_time"] is None
        else:
            assert UTCDateTime(motion.metadata["start_time"]) == UTCDateTime(start)
        if peak is not None:
            assert motion.acceleration.size == npts
            about_mean = np.abs(motion.acceleration - motion.acceleration.mean()).max()
            digits = len(str(peak).split(".")[1])
            assert about_mean / GRAVITY == pytest.approx(peak, abs=0.6 * 10.0**-digits)


@pytest.mark.parametrize(
    ("file", "channel", "pga", "within"),
    [
        ("formats/smc/0165a_u.smc", None, 2.634864, 2e-5),
        ("formats/csmip_dmg/ce36456p_CE36456.V2", "90", 2.67957, 1e-9),
        ("world/usc/017m30bt.s0a", None, 2.4239450, 1e-5),
        (SYLMAR, "90", 0.50298, 1e-12),
        (SYLMAR, "0", 0.55792, 1e-12),
        (SMC_OF_ONE_LINE_MORE, None, 0.80191, 1e-6),
    ],
)
def test_peaks_that_headers_state_are_those_of_the_motions(
    shared, file, channel, pga, within
):
    motion = read_motion(shared / "records" / file, channel=channel)
    assert motion.pga == pytest.approx(pga, rel=within)
    left_out = {"step": "leave out values beyond the count of the header", "values": 8}
    assert (left_out in motion.provenance) == (file == SMC_OF_ONE_LINE_MORE)


def test_every_file_of_the_collection_is_claimed_by_exactly_one_plugin(shared):
    by_obspy = {".mseed", ".sac", ".EW", ".EW1", ".EW2", ".NS2", ".UD2", ".knet", ".gz"}
    files = [
        path
        for path in sorted((shared / "records").rglob("*"))
        if path.is_file() and path.suffix not in {".md", ".xml", ".zip"}
    ]
    assert len(files) > 60
    for path in files:
        ours = [
            candidate.name for candidate in FORMATS if candidate.is_format(str(path))
        ]
        assert len(ours) == (0 if path.suffix in by_obspy else 1), (path, ours)


@pytest.mark.parametrize(
    "sample", CASES["of_the_world"], ids=lambda sample: sample[0].split("/")[-1]
)
def test_a_record_of_the_world_gives_the_values_read_independently(shared, sample):
    file, dt, name, npts, step, unit, peaks = sample
    record = read_record(shared / "records/world" / file, dt)
    assert record.format == name
    for wanted, peak in peaks.items():
        channel = choose_channel(record, wanted)
        samples = channel.samples
        assert (samples.size, channel.dt, channel.unit) == (npts, step, unit)
        assert np.abs(samples).max() == pytest.approx(peak, rel=1e-9)


def test_an_archive_of_a_data_centre_keeps_its_unit_and_leaves_out_spectra(shared):
    path = shared / "records" / SYLMAR
    record = read_record(path)
    assert [channel.label for channel in record.channels] == ["90", "UP", "0"]
    assert [(name, type(error)) for name, error in record.left_out] == [
        ("SYLMOVFF.V3", NotAcceleration)
    ]
    with pytest.raises(InputError, match="states its unit as cm/s2"):
        read_motion(path, unit="g", channel="90")
    with pytest.raises(NotAcceleration, match=r"\.zip#SYLMOVFF\.V3.*response spectra"):
        read_motion(f"{path}#SYLMOVFF.V3")


@pytest.mark.parametrize(
    ("file", "words"),
    [
        (
            "formats/peer_at2/IELC180.DT2",
            r"IELC180\.DT2.*displacement.*not acceleration",
        ),
        ("world/cosmos/NP8040-n.1000hyfh.HNE.01.V0c", "raw counts"),
        ("world/csmip/CE89146.V3", "response spectra"),
    ],
)
def test_what_is_not_acceleration_is_refused_as_that(shared, file, words):
    for read in (read_motion, obspy.read):
        with pytest.raises(NotAcceleration, match=words):
            read(shared / "records" / file)


def test_earthquake_station_and_component_of_peers_records_of_eastern_north_america_are_kept(
    shared,
):
    motion = read_motion(
        shared / "records/world/at2/RSN10590_ComalTX11-10-20_IU.CCM.BH1.00.AT2"
    )
    facts = motion.metadata
    assert facts["earthquake"] == "ComalTX11-10-20, 10/20/2011"
    assert (facts["station"], facts["component"]) == ("CCM", "BH100")


def test_a_sensitivity_without_stages_divides_the_counts(shared):
    path = shared / "records/world/stationxml/CI.MIKB..BNE.mseed"
    record = read_record(path)
    counts = obspy.read(path)[0].data
    samples = record.channels[0].samples
    np.testing.assert_allclose(samples * 427685.0769343, counts, rtol=1e-12)
    motion = motion_of(record, record.channels[0])
    assert motion.metadata["unit"] == "m/s2"
    assert [step["step"] for step in motion.provenance] == [
        "read",
        "divide by sensitivity",
        "remove zero level",
    ]
