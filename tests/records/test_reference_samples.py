"""Real records of every format, with the facts that notes or an independent reading of them give."""

import numpy as np
import obspy
import pytest
from obspy import UTCDateTime

from rockfrag.errors import InputError
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import FORMATS, choose_channel, motion_of, read_motion, read_record
from rockfrag.units import GRAVITY

SYLMAR = "world/archives/24514_Sylmar_OliveView_MedicalCenterFF.zip"
SMC_OF_ONE_LINE_MORE = "world/smc/891018_1.sma-1.0444a.smc"

# file, unit to give, format, station, start time, samples, dt [s], unit stored, PGA [g] of each
# channel about its mean
# fmt: off
# ruff: noqa: E501
SAMPLES = [
    ("peer_at2/RSN763_LOMAP_GIL067.AT2", None, "AT2", "Gilroy - Gavilan Coll.", None, 7999, 0.005, "g", [0.359]),
    ("peer_at2/RSN1_HELENA.A_A-HMC180.AT2", None, "AT2", "Carroll College", None, 5093, 0.01, "g", [0.161]),
    ("peer_at2/IELC180.AT2", None, "AT2", "EL CENTRO ARRAY #9", None, 4000, 0.01, "g", [0.313]),
    ("peer_at2/ANLA196.AT2", None, "AT2", "ANL-767 REACTOR PLANT (BASEMENT)", None, 1451, 0.02, "g", [0.040]),
    ("peer_at2/elCentro.AT2", None, "AT2", "", None, 1559, 0.02, "g", [0.319]),
    ("peer_at2/RSN1044_DirRot2.AT2", None, "AT2", "", None, 2000, 0.02, "g", [0.697]),
    ("peer_at2/Oak_2_50_5_FN.AT2", None, "AT2", "EC MELOLAND OVERP FF", None, 7997, 0.005, "g", [0.910]),
    ("../more/peer_at2/A-BEN360.AT2", None, "AT2", "BENTON", None, 7996, 0.005, "g", [0.177]),
    ("../more/peer_at2/ISE-WE.AT2", None, "AT2", "ISERNIA-SANT'AGAPITO", None, 6557, 0.00244, "g", [0.068]),
    ("../more/peer_at2/RIO270.AT2", None, "AT2", "RIO DELL OVERPASS FF", None, 1800, 0.02, "g", [0.385]),
    ("../more/peer_at2/WGK-N.AT2", None, "AT2", "WGK", None, 11800, 0.005, "g", [0.484]),
    ("../more/peer_at2/RSN753_LOMAP_CLS000.AT2", None, "AT2", "Corralitos", None, 7995, 0.005, "g", [0.645]),
    ("cosmos/Cosmos12TimeSeriesTest.v1", None, "COSMOS", "J2236", "2005-06-16T20:53:04.4", 7000, 0.01, "cm/s2", [0.165]),
    ("csmip_dmg/ce36456p_CE36456.V2", None, "CSMIP", "36456", "1983-05-02T23:42:48.2", 3251, 0.02, "cm/s2", [0.273, None, None]),
    ("csmip_dmg/CE89146.V1", None, "CSMIP", "89146", "2012-02-13T21:06:45", 13200, 0.005, "g", [0.079, None, None]),
    ("csmip_dmg/CHAN01.V2", None, "CSMIP", "1336", None, 1138, 0.02, "cm/s2", [0.175]),
    ("smc/0111a.smc", None, "SMC", "SAF0", "1989-10-18T00:04:00", 6001, 0.005, "cm/s2", [0.1064]),
    ("smc/0165a_u.smc", None, "SMC", "0482", "1987-10-01T14:42:00", 6012, 0.005, "cm/s2", [None]),
    ("esm/HL.DLFA..HNN.D.20190728.160908.C.ACC.ASC", None, "ESM", "DLFA", "2019-07-28T16:09:05.7", 13876, 0.005, "cm/s2", [0.0002]),
    ("esm/20101114230825_3104_ap_RawAcc_E.asc", None, "ESM", "3104", "2010-11-14T23:09:19.3", 5600, 0.01, "cm/s2", [0.0017]),
    ("knet_kiknet/AOM0011801241951.EW", None, "KNET", "AOM001", "2018-01-24T10:51:28", 10200, 0.01, "m/s2", [0.0042]),
    ("knet_kiknet/NGNH311106302345.EW1", None, "KNET", "NGNH31", "2011-06-30T14:45:33", 12000, 0.01, "m/s2", [0.0002]),
    ("knet_kiknet/NGNH311106302345.EW2", None, "KNET", "NGNH31", "2011-06-30T14:45:33", 12000, 0.01, "m/s2", [0.0007]),
    ("knet_kiknet/test.knet", None, "KNET", "AKT013", "1996-08-10T18:12:24", 5900, 0.01, "m/s2", [0.0045]),
    ("miniseed_stationxml/BK.CMB.00.HNE__20140824T102014Z__20140824T102244Z.mseed", None, "MSEED", "CMB", "2014-08-24T10:20:14.078393", 15000, 0.01, "m/s2", [0.0005]),
    ("sac/20190706031952.CJ.T001230.HNE.sac", "g", "SAC", "T001230", "2019-07-06T03:19:52", 15001, 0.02, "g", [0.021]),
    ("sac/20190706031952.CJ.T001230.HNN.sac", "g", "SAC", "T001230", "2019-07-06T03:19:52", 15001, 0.02, "g", [0.019]),
    ("geonet/20161113_110300_HSES_20.V1A", None, "GEONET", "HSES", "2016-11-13T11:02:20", 65536, 0.005, "mm/s2", [0.244, 0.264, 0.162]),
    ("plain/elcentro.csv", "g", "PLAINTEXT", "", None, 1560, 0.02, "g", [0.319]),
    ("plain/Northridge_Sylmar_County.dat", "m/s2", "PLAINTEXT", "", None, 3000, 0.02, "m/s2", [0.843]),
    ("plain/ChiChi.txt", "g", "PLAINTEXT", "", None, 11800, 0.005, "g", [0.183]),
    ("plain/test_motion_dt0p01.txt", "m/s2", "PLAINTEXT", "", None, 4684, 0.01, "m/s2", [0.144]),
    ("other/017m30cc.y0a", None, "USC", "0057", None, 6206, 0.005, "g/10", [0.406]),
    ("other/altohospicio0911131.v1", None, "RENADIC", "altohospicio", "2009-11-12T23:10:03", 3500, 0.01, "g/10", [0.05, None, None]),
    ("other/STNA.20020722.044649.evt.gz", None, "KINEMETRICS_EVT", "STN", "2002-07-22T04:46:49", 8250, 0.004, "m/s2", [0.0075, None, None]),
]
# fmt: on


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: sample[0].split("/")[-1])
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
def test_peaks_that_headers_state_are_those_of_the_motions(shared, file, channel, pga, within):
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
        ours = [candidate.name for candidate in FORMATS if candidate.is_format(str(path))]
        assert len(ours) == (0 if path.suffix in by_obspy else 1), (path, ours)


# file, interval and unit to give, format, samples, interval [s], unit, peaks of some channels as stored
# fmt: off
OF_THE_WORLD = [
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


@pytest.mark.parametrize("sample", OF_THE_WORLD, ids=lambda sample: sample[0].split("/")[-1])
def test_a_record_of_the_world_gives_the_values_read_independently(shared, sample):
    file, dt, name, npts, step, unit, peaks = sample
    record = read_record(shared / "records/world" / file, dt)
    assert record.format == name
    for wanted, peak in peaks.items():
        channel = choose_channel(record, wanted)
        samples = channel.samples()
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
        ("formats/peer_at2/IELC180.DT2", r"IELC180\.DT2.*displacement.*not acceleration"),
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
    motion = read_motion(shared / "records/world/at2/RSN10590_ComalTX11-10-20_IU.CCM.BH1.00.AT2")
    facts = motion.metadata
    assert facts["earthquake"] == "ComalTX11-10-20, 10/20/2011"
    assert (facts["station"], facts["component"]) == ("CCM", "BH100")


def test_a_sensitivity_without_stages_divides_the_counts(shared):
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
