"""Every kind of value through every format and back, and what files of few bytes decode to."""

from __future__ import annotations

import csv
import gzip
import io
import json
import resource
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from longer import long_but

from impact88.collision.casescene import sample
from impact88.interface.commands.cli import main
from impact88.names import SCENE
from impact88.tables import csvtable
from impact88.tables.formats import FORMATS

VALUES = dict(sample(1)) | {"VX": "0", "VY": "0"}
decimals = st.decimals(0, 9, places=6).map(str)
KINDS = {
    "MU": st.one_of(decimals, st.integers(1, 120).map("{} %".format), st.just("1e-400")),
    "UX [mph]": st.one_of(
        st.floats(-90, 90).map(repr),
        decimals.map("-{} km/h".format),
        decimals.map("-{} ft/s".format),
        st.just("-1,029.5"),
    ),
    "MB [lb]": st.one_of(
        st.integers(1, 99_000).map(str), st.just("1500 kg"), st.just("2,500"), st.just("inf")
    ),
    "IB [slug·ft²]": st.just("inf"),
    "TA [deg]": st.one_of(st.floats(-180, 180).map(repr), st.just("1 rad"), st.just("10° 30'")),
    "M": st.sampled_from(["6", "4", ""]),
    "note": st.text(
        st.characters(codec="utf-8", exclude_categories=("Cc", "Cs", "Cn", "Zl", "Zp", "Co")),
        max_size=9,
    ).map(str.strip),
}
OUTPUTS = ["--outputs", "VAX,DVA,LOSS,STATUS"]


def written(path: Path, rows: list[dict[str, str]]) -> None:
    rest = {name: VALUES[name] for name in SCENE if name not in {k.split()[0] for k in KINDS}}
    units = {"VX": "mph", "VY": "mph", "UY": "mph", "MA": "lb", "IA": "slug·ft²", "DA": "ft"}
    units |= {"DB": "ft"}
    headings = [f"{name} [{units[name]}]" if name in units else name for name in rest]
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow([*headings, *KINDS])
        writer.writerows([*rest.values(), *(row[k] for k in KINDS)] for row in rows)


def results(path: Path) -> list[dict[str, object]]:
    back = path.with_suffix(".back.jsonl")
    assert main(["solve", str(path), "-o", str(back), "--errors", str(path) + ".e", *OUTPUTS]) < 2
    return [json.loads(line) for line in back.read_text("utf-8").splitlines()]


@pytest.mark.parametrize("form", long_but(FORMATS, kept=(1, 2, 3, 4)))
@settings(
    max_examples=12,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(rows=st.lists(st.fixed_dictionaries(KINDS), min_size=1, max_size=4))
def test_every_kind_of_value_goes_there_and_back(tmp_path, form, rows):
    pytest.importorskip("pyarrow")
    pytest.importorskip("openpyxl")
    first, there = tmp_path / "a.csv", tmp_path / f"b{FORMATS[form].endings[0]}"
    written(first, rows)
    expected = results(first)
    main(["solve", str(first), "-o", str(there), "--errors", str(tmp_path / "e"), *OUTPUTS])
    found = results(there)
    assert len(found) == len(expected)
    for one, two in zip(expected, found, strict=True):
        for name, value in one.items():
            if name == "note" and form == "xlsx":  # Excel has no empty text, and fewer characters
                continue
            if isinstance(value, float):
                # a number in its column's unit is rounded once more; openpyxl writes 16 digits
                assert two[name] == pytest.approx(value, rel=1e-9, abs=1e-12), name
            else:
                assert two[name] == value, name


LIMIT = 1_500_000_000
"""Bytes of address space that a reader may take beside its libraries."""


def limited(arguments: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """The command in a process that may use little memory and ten seconds."""
    return subprocess.run(
        [sys.executable, "-m", "impact88", *arguments],
        capture_output=True,
        text=True,
        cwd=folder,
        timeout=60,
        check=False,
        preexec_fn=lambda: (
            resource.setrlimit(resource.RLIMIT_DATA, (LIMIT, LIMIT)),
            resource.setrlimit(resource.RLIMIT_CPU, (12, 12)),
        ),
    )


def bomb(form: str, path: Path) -> None:
    """Write a file of a few thousand bytes that decodes to gigabytes."""
    header, row = ",".join(SCENE), ",".join(VALUES[n] for n in SCENE)
    if form == "parquet":
        pa = pytest.importorskip("pyarrow")
        from pyarrow import parquet

        columns = {n: pa.array([float(VALUES[n])] * 2000) for n in SCENE}
        columns["MA"] = pa.DictionaryArray.from_arrays([0] * 2000, ["9" * 1_000_000])
        parquet.write_table(pa.table(columns), path, compression="zstd")
    elif form == "xlsx":
        openpyxl = pytest.importorskip("openpyxl")
        book = openpyxl.Workbook()
        book.active.append(list(SCENE))
        book.active.append([float(VALUES[n]) for n in SCENE])
        book.active["XFD20000"] = 1
        book.save(path)
    elif form == "csv.gz":
        path.write_bytes(gzip.compress((f"{header}\n{row}\n" + "\n" * 5_000_000).encode()))
    elif form == "csv":
        path.write_text(",".join([header, *(f"n{i}" for i in range(4_000))]) + "\n1" * 60_000)
    elif form == "jsonl":
        rows = (json.dumps({f"n{i % 3000}": 1}) for i in range(60_000))
        path.write_text("\n".join([json.dumps(VALUES), *rows]))
    else:
        head = "{'descr': '|i1', 'fortran_order': False, 'shape': (260000000,), }"
        data = f"{head:<117}\n".encode()
        with (
            zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as archive,
            archive.open("UX.npy", "w") as member,
        ):
            member.write(b"\x93NUMPY\x01\x00" + len(data).to_bytes(2, "little") + data)
            for _ in range(26):
                member.write(bytes(10_000_000))


@pytest.mark.parametrize(
    "form", long_but(["parquet", "xlsx", "csv.gz", "csv", "jsonl", "npz"], kept=(0, 1, 4, 5))
)
def test_a_small_file_that_decodes_to_much_is_refused_soon(tmp_path, form):
    path = tmp_path / f"t.{form}"
    bomb(form, path)
    done = limited(["solve", path.name, "-o", "o.jsonl", "--outputs", "VAX"], tmp_path)
    last = done.stderr.splitlines()[-1]
    assert done.returncode == 2, done.stderr
    assert path.name in last
    assert ("unpack to" in last) or (form == "xlsx" and "no name" in last)


@pytest.mark.parametrize("block", [csvtable.BLOCK_BYTES, 1], ids=["lines", "pyarrow"])
def test_a_row_of_bare_commas_is_no_row_and_one_of_units_heads_its_columns(
    tmp_path, capsys, monkeypatch, block
):
    monkeypatch.setattr(csvtable, "BLOCK_BYTES", block)
    names = [*SCENE, "note"]
    cells = [{**VALUES, "note": "x"}[n] for n in names]
    units = {"UX": "mph", "UY": "mph", "VX": "mph", "VY": "mph", "DA": "ft", "DB": "ft"}
    units |= {"MA": "lb", "MB": "lb", "IA": "slug·ft²", "IB": "slug·ft²", "TA": "deg"}
    blank = "," * (len(names) - 1)
    plain, odd = tmp_path / "a.csv", tmp_path / "b.csv"
    written_names = [f"{n} [{units[n]}]" if n in units else n for n in names]
    plain.write_text(f"{','.join(written_names)}\n{','.join(cells)}\n")
    unit_row = ",".join(units.get(n, "") for n in names)
    odd.write_text(f"{','.join(names)}\n{unit_row}\n{blank}\n{','.join(cells)}\n{blank}\n{blank}\n")
    outputs = ["--outputs", "VAX,LOSS", "--results-only"]
    assert main(["solve", str(plain), *outputs]) == 0
    expected = capsys.readouterr().out
    assert main(["solve", str(odd), *outputs]) == 0
    out, err = capsys.readouterr()
    assert out == expected
    assert "line 2 is read as the units" in err


def test_what_a_sheet_hides_or_merges_is_told(tmp_path, capsys):
    openpyxl = pytest.importorskip("openpyxl")
    book, path = openpyxl.Workbook(), tmp_path / "a.xlsx"
    book.active.append(list(SCENE))
    for _ in range(3):
        book.active.append([float(VALUES[n]) for n in SCENE])
    book.active.row_dimensions[3].hidden = True
    book.active.merge_cells("A2:A4")
    book.save(path)
    assert main(["solve", str(path), "--outputs", "VAX", "-o", str(tmp_path / "o.csv")]) == 1
    err = capsys.readouterr().err
    assert "row 3 is hidden in the sheet" in err
    assert "row 2 (line 3), E: is empty, for it is merged with A2" in err
    assert "row 1 " not in err


def test_a_text_that_is_live_in_a_csv_is_told(tmp_path, capsys):
    pytest.importorskip("openpyxl")
    path = tmp_path / "a.csv"
    row = ",".join(VALUES[n] for n in SCENE)
    path.write_text(f"{','.join(SCENE)},note\n{row},=1+1\n")
    assert main(["solve", str(path), "--outputs", "VAX"]) == 0
    assert "column note: a text that begins with = or @" in capsys.readouterr().err
    assert main(["solve", str(path), "-o", str(tmp_path / "b.xlsx"), "--outputs", "VAX"]) == 0
    assert "begins with" not in capsys.readouterr().err


@pytest.mark.parametrize(("text", "told"), [("1e-400", True), ("0.000", False), ("0", False)])
def test_a_number_too_small_for_a_double_is_told(tmp_path, capsys, text, told):
    path = tmp_path / "a.csv"
    file = io.StringIO()
    csv.writer(file).writerows([SCENE, [{**VALUES, "MU": text}[n] for n in SCENE]])
    path.write_text(file.getvalue())
    assert main(["solve", str(path), "--outputs", "VAX"]) == 0
    assert ("smaller than any double" in capsys.readouterr().err) == told


def test_shares_of_the_critical_friction_are_swept(tmp_path, capsys):
    path = tmp_path / "s.toml"
    lines = [f'{n} = "{t}"' for n, t in {**sample(1), "MU": "85 %"}.items()]
    path.write_text("\n".join(['case = "24-117"', *lines]))
    assert main(["solve", str(path), "--sweep", "MU=80 %:100 %:3", "--outputs", "LOSS"]) == 0
    rows = list(csv.DictReader(io.StringIO(capsys.readouterr().out)))
    assert [(row["case"], row["MU"]) for row in rows] == [
        ("24-117", f"{share} %") for share in (80, 90, 100)
    ]
    for row in rows:
        assert main(["solve", str(path), "--set", f"MU={row['MU']}", "--outputs", "LOSS"]) == 0
        (one,) = csv.DictReader(io.StringIO(capsys.readouterr().out))
        assert one["LOSS"] == row["LOSS"]
