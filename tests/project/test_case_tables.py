"""A case of a table in YAML that fails names its line."""

import textwrap

import yaml

from ..case_tables import case_tables, lines_of

pytest_plugins = ["pytester"]


def test_a_failing_case_names_its_line(pytester):
    pytester.makeconftest("from tests.conftest import pytest_runtest_makereport")
    pytester.makefile(".yaml", test_made="sums:\n- [1 + 1, 2]\n- [1 + 2, 4]\n")
    pytester.makepyfile(
        test_made="""
        import pytest

        from tests.case_tables import case_tables

        @pytest.mark.parametrize(("sum", "is_"), case_tables(__file__)["sums"])
        def test_sum(sum, is_):
            assert eval(sum) == is_
        """
    )
    done = pytester.runpytest("-p", "no:randomly")
    done.assert_outcomes(passed=1, failed=1)
    done.stdout.fnmatch_lines(["*test_made.yaml, line 3*"])


def test_texts_know_their_lines_and_are_written_as_texts(tmp_path):
    table = "rows:\n- [a, {b: c}]\n- [1]\n"
    (tmp_path / "test_it.yaml").write_text(textwrap.dedent(table))
    first, second = case_tables(str(tmp_path / "test_it.py"))["rows"]
    assert list(lines_of(first)) == [2, 2, 2] and not list(lines_of(second))
    assert yaml.safe_load(yaml.safe_dump(first)) == ["a", {"b": "c"}]
