"""Records of networks of the world, with the values that an independent reading of them gave."""

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import choose_channel, motion_of, read_motion, read_record

# file, interval and unit to give, format, samples, interval [s], unit, peaks of some channels as stored
# fmt: off
# ruff: noqa: E501
SAMPLES = [
    ("bhrc/5526-1.V1", None, "BHRC", 9472, 0.005, "g/10", {"L": 0.0591538}),
    ("afad/20170720223109_0000_main.txt", None, "AFAD", 4094, 0.01, "cm/s2", {"N-S": 158.762353, "E-W": 102.007881, "U-D": 88.038613}),
    ("afad/20170720223109_4806.txt", None, "AFAD", 9166, 0.01, "cm/s2", {"N-S": 58.542232, "E-W": 59.994425, "U-D": 25.542791}),
    ("unam/CUP50401.012", None, "UNAM", 17502, 0.004, "cm/s2", {"V": 0.470, "N90E": 1.189, "N00E": 1.216}),
    ("csmnc/ua0004.dat", None, "CSMNC", 8800, 0.005, "cm/s2", {"EW": 3.262457}),
    ("usc/017m30bt.s0a", None, "USC2", 1887, 0.02, "cm/s2", {"N08W": 242.395}),
    ("usc/274o42pv.s0a", None, "USC2", 573, 0.02, "cm/s2", {"S58W": 6.869}),
    ("agram/usaca40.044", None, "AGRAM", 5983, 0.005, "cm/s2", {"090": 514.03}),
    ("columns/test_motion_avd.csv", None, "PLAINTEXT", 4684, 0.01, "g", {None: 0.143730887}),
    ("columns/sample_acc_3ch.csv", None, "PLAINTEXT", 3000, 0.01, "cm/s2", {"NS": 39.18634639, "EW": 33.45245702, "UD": 14.98976973}),
    ("columns/ARL360.g3", 0.02, "PLAINTEXT", 2000, 0.02, "", {None: 0.3080574}),
    ("columns/elCentro.at2", None, "AT2", 1559, 0.02, "g", {None: 0.31882}),
    ("at2/RSN10590_ComalTX11-10-20_IU.CCM.BH1.00.AT2", None, "AT2", 15306, 0.05, "g", {"BH100": 2.585321e-06}),
]
# fmt: on


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: sample[0].split("/")[-1])
def test_a_record_of_the_world_gives_the_values_read_independently(shared, sample):
    file, dt, name, npts, step, unit, peaks = sample
    record = read_record(shared / "records/world" / file, dt)
    assert record.format == name
    for wanted, peak in peaks.items():
        channel = choose_channel(record, wanted)
        samples = channel.samples()
        assert (samples.size, channel.dt, channel.unit) == (npts, step, unit)
        assert np.abs(samples).max() == pytest.approx(peak, rel=1e-9)


def test_peaks_that_headers_state_are_those_of_the_motions(shared):
    """The corrected USC record states -242.39450 cm/s², the CSMIP archive 50.298 and -55.792 cm/s²."""
    world = shared / "records/world"
    assert read_motion(world / "usc/017m30bt.s0a").pga == pytest.approx(2.4239450, rel=1e-5)
    archive = world / "archives/24514_Sylmar_OliveView_MedicalCenterFF.zip"
    assert read_motion(archive, channel="90").pga == pytest.approx(0.50298, rel=1e-12)
    assert read_motion(archive, channel="0").pga == pytest.approx(0.55792, rel=1e-12)


def test_the_line_of_an_smc_file_that_its_count_leaves_out_is_left_out(shared):
    path = shared / "records/world/smc/891018_1.sma-1.0444a.smc"
    motion = read_motion(path)
    assert motion.pga == pytest.approx(0.80191, rel=1e-6)
    assert motion.provenance[1] == {
        "step": "leave out values beyond the count of the header",
        "values": 8,
    }


def test_an_archive_of_a_data_centre_keeps_its_unit_and_leaves_out_spectra(shared):
    path = shared / "records/world/archives/24514_Sylmar_OliveView_MedicalCenterFF.zip"
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
        ("cosmos/NP8040-n.1000hyfh.HNE.01.V0c", "raw counts"),
        ("csmip/CE89146.V3", "response spectra"),
    ],
)
def test_what_is_not_acceleration_is_refused_as_that(shared, file, words):
    with pytest.raises(NotAcceleration, match=words):
        read_motion(shared / "records/world" / file)


def test_earthquake_station_and_component_of_peers_records_of_eastern_north_america_are_kept(
    shared,
):
    motion = read_motion(shared / "records/world/at2/RSN10590_ComalTX11-10-20_IU.CCM.BH1.00.AT2")
    facts = motion.metadata
    assert facts["earthquake"] == "ComalTX11-10-20, 10/20/2011"
    assert (facts["station"], facts["component"]) == ("CCM", "BH100")


def test_a_sensitivity_without_stages_divides_the_counts(shared):
    import obspy

    path = shared / "records/world/stationxml/CI.MIKB..BNE.mseed"
    record = read_record(path)
    counts = obspy.read(path)[0].data
    samples = record.channels[0].samples()
    np.testing.assert_allclose(samples * 427685.0769343, counts, rtol=1e-12)
    motion = motion_of(record, record.channels[0])
    assert motion.metadata["unit"] == "m/s2"
    assert [step["step"] for step in motion.provenance] == [
        "read",
        "divide by sensitivity",
        "remove zero level",
    ]
