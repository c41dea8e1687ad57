"""Real records of every format, with the facts that their collection's notes give."""

import numpy as np
import obspy
import pytest
from obspy import UTCDateTime

from rockfrag.errors import InputError
from rockfrag.motions import intensity
from rockfrag.records.read import FORMATS, read_motion, read_record
from rockfrag.units import GRAVITY

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


def test_uncorrected_smc_peak_is_the_one_of_its_header(shared):
    motion = read_motion(shared / "records/formats/smc/0165a_u.smc")
    assert motion.pga == pytest.approx(2.634864, rel=2e-5)


def test_the_peaks_that_a_csmip_file_states_are_those_of_its_samples(shared):
    path = shared / "records/formats/csmip_dmg/ce36456p_CE36456.V2"
    assert read_motion(path, channel="90").pga == pytest.approx(2.67957, rel=1e-9)


def test_the_displacement_file_is_refused(shared):
    path = shared / "records/formats/peer_at2/IELC180.DT2"
    for read in (read_motion, obspy.read):
        with pytest.raises(InputError, match=r"IELC180\.DT2.*displacement.*not acceleration"):
            read(path)


def test_the_wrong_time_column_is_reported(shared):
    path = shared / "records/formats/plain/coolwater_wrong_time_column.txt"
    with pytest.raises(InputError, match=r"steps by 0\.003 s.*0\.0025 and 0\.0035.*dt="):
        read_motion(path, unit="g")
    assert read_motion(path, unit="g", dt=0.0025).dt == 0.0025


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


def test_the_wider_ensemble_of_peer_records_has_the_listed_peaks(shared):
    peaks = {
        "A-BEN360": 0.177,
        "ISE-WE": 0.068,
        "RIO270": 0.385,
        "WGK-N": 0.484,
        "RSN753_LOMAP_CLS000": 0.645,
    }
    for name, peak in peaks.items():
        motion = read_motion(shared / f"records/more/peer_at2/{name}.AT2")
        assert motion.pga / GRAVITY == pytest.approx(peak, abs=6e-4)
    assert read_motion(shared / "records/more/peer_at2/ISE-WE.AT2").dt == 0.00244


@pytest.mark.parametrize(
    ("name", "npts", "pga", "pgv", "pgd"),
    [
        ("Friuli", 3633, 0.35, 22.02, 4.07),
        ("Kobe", 4091, 0.34, 27.68, 9.69),
        ("Loma_Prieta", 3991, 0.37, 44.70, 19.61),
        ("Northridge", 3989, 0.57, 52.01, 9.03),
    ],
)
def test_table_3_3_of_the_thesis_to_the_printed_digit(four_records, name, npts, pga, pgv, pgd):
    motion = four_records[name]
    assert motion.acceleration.size == npts
    assert round(motion.pga / GRAVITY, 2) == pga
    assert 100 * intensity.pgv(motion) == pytest.approx(pgv, abs=0.006)
    assert 100 * intensity.pgd(motion) == pytest.approx(pgd, abs=0.006)
