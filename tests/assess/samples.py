"""Hazard files as their makers document them, made here of one power law."""

import json
from math import expm1
from pathlib import Path

LEVELS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0]
"""Levels of PGA [g]."""


def rate(level: float, at_a_tenth: float = 0.01) -> float:
    """Annual rate of exceedance: a power law with the exponent 2.5."""
    return at_a_tenth * (level / 0.1) ** -2.5


def poe(level: float, years: float = 50.0, at_a_tenth: float = 0.01) -> float:
    """Probability of exceedance in some years."""
    return -expm1(-years * rate(level, at_a_tenth))


def openquake_csv(
    imt: str = "PGA", kind: str = "mean", at_a_tenth: float = 0.01, years: float = 50.0
) -> str:
    """OpenQuake's export of one site."""
    comment = (
        f"generated_by='OpenQuake engine 3.20.1', start_date='2024-07-01T10:00:00', checksum=1, kind='{kind}', "
        f"investigation_time={years}, imt='{imt}'"
    )
    blanks = "," * (len(LEVELS) + 2)
    header = "lon,lat,depth," + ",".join(f"poe-{level:.7f}" for level in LEVELS)
    row = "16.37000,48.21000,0.00000," + ",".join(
        f"{poe(level, years, at_a_tenth):.6E}" for level in LEVELS
    )
    return f'#{blanks},"{comment}"\n{header}\n{row}\n'


QUANTILES = {"mean": 0.01, "quantile-0.16": 0.006, "quantile-0.84": 0.015}


def quantile_files(folder: Path, imt: str) -> list[str]:
    """Write OpenQuake's files of a mean and of two quantiles."""
    paths = {kind: folder / f"hazard_curve-{kind}-{imt}_1.csv" for kind in QUANTILES}
    for kind, path in paths.items():
        path.write_text(openquake_csv(imt, kind, QUANTILES[kind]))
    return list(map(str, paths.values()))


def usgs_json(imt: str = "PGA") -> str:
    """Answer of the USGS's service since 2021."""
    values = {"xs": LEVELS, "ys": [rate(level) for level in LEVELS]}
    curve = {
        "imt": {"value": imt, "display": imt},
        "data": [
            {"component": "Fault", "values": {"xs": LEVELS, "ys": [0.0] * len(LEVELS)}},
            {"component": "Total", "values": values},
        ],
    }
    answer = {"name": "Hazard Curves", "status": "success", "response": {"hazardCurves": [curve]}}
    return json.dumps(answer)


def usgs_old_json() -> str:
    """Answer of the USGS's service before 2021."""
    curve = {
        "metadata": {"imt": {"value": "SA0P2", "display": "0.20 s"}, "xvalues": LEVELS},
        "data": [{"component": "Total", "yvalues": [rate(level) for level in LEVELS]}],
    }
    return json.dumps({"status": "success", "response": [curve]})


def efehr_xml(statistics: str = 'statistics="mean"', at_a_tenth: float = 0.01) -> str:
    """EFEHR's answer, NRML 0.3."""
    levels = " ".join(f"{level}" for level in LEVELS)
    poes = " ".join(f"{poe(level, 50, at_a_tenth):.8g}" for level in LEVELS)
    return f"""<?xml version="1.0" encoding="UTF-8" standalone="yes"?>
<ns2:nrml xmlns:ns2="http://openquake.org/xmlns/nrml/0.3" xmlns:ns1="http://www.opengis.net/gml">
  <ns2:hazardResult ns1:id="a">
    <ns2:config><ns2:hazardProcessing saDamping="0.05" saPeriod="0.1" investigationTimeSpan="50.0"/></ns2:config>
    <ns2:hazardCurveField {statistics} ns1:id="b">
      <ns2:IML IMT="PGA">{levels}</ns2:IML>
      <ns2:HCNode ns1:id="c">
        <ns2:site><ns1:Point srsName="4326"><ns1:pos>16.37 48.21</ns1:pos></ns1:Point></ns2:site>
        <ns2:hazardCurve><ns2:poE>{poes}</ns2:poE></ns2:hazardCurve>
      </ns2:HCNode>
    </ns2:hazardCurveField>
  </ns2:hazardResult>
</ns2:nrml>
"""


def nrml_xml() -> str:
    """OpenQuake's NRML 0.5 of a spectral acceleration."""
    levels = " ".join(f"{level}" for level in LEVELS)
    poes = " ".join(f"{poe(level):.8g}" for level in LEVELS)
    return f"""<?xml version="1.0" encoding="utf-8"?>
<nrml xmlns:gml="http://www.opengis.net/gml" xmlns="http://openquake.org/xmlns/nrml/0.5">
  <hazardCurves IMT="SA" saPeriod="0.3" saDamping="5.0" investigationTime="50.0" statistics="mean">
    <IMLs>{levels}</IMLs>
    <hazardCurve><gml:Point><gml:pos>16.37 48.21</gml:pos></gml:Point><poEs>{poes}</poEs></hazardCurve>
  </hazardCurves>
</nrml>
"""


def table_csv(title: str = "pga_g", rates: str = "annual_rate") -> str:
    """A table written by hand."""
    values = {
        "annual_rate": rate,
        "return_period_years": lambda level: 1 / rate(level),
        "poe_50_years": poe,
    }[rates]
    rows = [f"{level},{values(level):.10g}" for level in LEVELS]
    return "\n".join(["# a site", f"{title},{rates}", *rows]) + "\n"


def italian_csv() -> str:
    """A table of return periods with decimal commas, as Italian authorities print them."""
    rows = (f"{level};{1 / rate(level):.10g}".replace(".", ",") for level in LEVELS)
    return "\n".join(["PGA (g);Tr (anni)", *rows]) + "\n"


SAMPLES = {
    "italian.csv": italian_csv(),
    "hazard_curve-mean-PGA_12.csv": openquake_csv(),
    "hazard_curve-quantile.csv": openquake_csv(kind="quantile-0.5"),
    "usgs.json": usgs_json(),
    "usgs-old.json": usgs_old_json(),
    "efehr.xml": efehr_xml(),
    "nrml.xml": nrml_xml(),
    "table.csv": table_csv(),
    "periods.csv": table_csv(rates="return_period_years"),
    "probabilities.csv": table_csv("sa_0_5s_g", "poe_50_years"),
}
