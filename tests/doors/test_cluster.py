"""README's way to a cluster: dask calls the same function part by part, and the bits stay."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import impact88
from impact88.mechanics.accuracy.populations import BENCHMARK, scenes

dask = pytest.importorskip("dask")
distributed = pytest.importorskip("distributed")
pytest.importorskip("pyarrow")
pandas = pytest.importorskip("pandas")

PARTS, ROWS = 4, 500


def test_partitions_written_by_two_processes_are_the_bits_of_one(tmp_path: Path) -> None:
    columns = {
        name: np.broadcast_to(np.asarray(column, float), (PARTS * ROWS,))
        for name, column in scenes(BENCHMARK[0], PARTS * ROWS, 8).items()
    }
    whole = pandas.DataFrame(columns)
    for part in range(PARTS):
        whole[part * ROWS : (part + 1) * ROWS].to_parquet(tmp_path / f"draws-{part}.parquet")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
        ) as cluster,
        distributed.Client(cluster),
    ):
        import dask.dataframe

        frame = dask.dataframe.read_parquet(sorted(map(str, tmp_path.glob("draws-*.parquet"))))
        solved = frame.map_partitions(impact88.solve_frame, "DVA,LOSS,STATUS", threads=1)
        solved.to_parquet(tmp_path / "solved")
    assert len(list((tmp_path / "solved").glob("*.parquet"))) == PARTS
    solved = pandas.read_parquet(tmp_path / "solved")
    expected = impact88.solve(columns, "DVA,LOSS,STATUS")
    for name, column in expected.items():
        assert np.array_equal(solved[name].to_numpy(), column, equal_nan=True)
