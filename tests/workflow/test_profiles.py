"""Profiles of the workflow hold what Snakemake knows."""

import importlib.util
from pathlib import Path

import pytest

PROFILES = Path(__file__).resolve().parents[2] / "profiles"
PLUGINS = {
    "slurm": "snakemake-executor-plugin-slurm",
    "queue": "snakemake-executor-plugin-cluster-generic",
}


def parsed(folder: Path):
    """Options of Snakemake with a profile; ends the process where it does not know a key."""
    from snakemake.cli import parse_args

    return parse_args(["--profile", str(folder), "--workflow-profile", "none"])[1]


@pytest.mark.parametrize("profile", sorted(PROFILES.iterdir()), ids=lambda path: path.name)
def test_snakemake_knows_every_key_of_a_profile(profile: Path):
    plugin = PLUGINS.get(profile.name)
    if plugin and importlib.util.find_spec(plugin.replace("-", "_")) is None:
        pytest.skip(f"not installed: {plugin} (pip install '.[{profile.name}]')")
    assert parsed(profile).rerun_incomplete


def test_a_key_that_snakemake_does_not_know_ends_it(tmp_path, capsys):
    (tmp_path / "config.yaml").write_text("jobs: 2\nlatency-wat: 60\n")
    with pytest.raises(SystemExit):
        parsed(tmp_path)
    assert "latency-wat" in capsys.readouterr().err
