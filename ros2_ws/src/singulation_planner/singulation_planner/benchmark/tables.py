"""Tables I and II of the paper from the results of a run, beside the paper's figures."""

from pathlib import Path

import pandas as pd

from singulation_core.polygon import FloatArray
from singulation_planner.benchmark.markdown import table
from singulation_planner.benchmark.paper import AUTHORS_CODE, CASES, TABLE_ONE, TABLE_TWO, in_order, label
from singulation_planner.benchmark.run import BRUTE_FORCE
from singulation_planner.benchmark.statistics import Estimate, gains, share

_POINT = ("single_point", "contact_mode")


def table_one(results: pd.DataFrame, setting_text: str) -> str:
    """Table I: single-point pushes of all policies in easy, hard and all scenes.

    Each share is the ratio of the means of s' - s over the scenes that Brute Force worked on, with its standard error;
    no unit of length changes it. The paper's column (s' - s)/s is given as the ratio of means.
    """
    single = results[(results["contact_mode"] == _POINT[0]) & (results["fits"] == _POINT[1])]
    gain = gains(single)
    start = single.groupby("scenario")["before"].first()
    times = single.groupby("policy")[["planning", "simulating"]].median() * 1e3
    policies = in_order(set(single["policy"]))
    rows = []
    for name in policies:
        row = [label(name), f"{times['planning'][name]:.3g}", f"{times.sum(axis=1)[name]:.3g}", _paper_time(name)]
        for case, query in CASES.items():
            cell = gain.query(query)
            row += [_absolute(cell, name, start), _of_brute_force(cell, name).percent(), _paper_share(name, case)]
        rows.append(row)
    header = ["policy", "plan [ms]", "plan + one push [ms]", "paper [ms]"]
    header += [text for case in CASES for text in (f"{case}: s'-s ; (s'-s)/s", "% of BF", "paper")]
    return _heading(gain, results, setting_text) + table(header, rows)


def _heading(gain: pd.DataFrame, results: pd.DataFrame, setting_text: str) -> str:
    brute = int(gain[(BRUTE_FORCE, *_POINT)].notna().sum()) if (BRUTE_FORCE, *_POINT) in gain else 0
    unit = results["unit"].iloc[0]
    refused = results.groupby("policy")["code"].apply(lambda codes: (codes != "OK").mean())
    without = ", ".join(f"{label(str(name))} {part:.1%}" for name, part in refused.items() if part > 0.0) or "none"
    return (
        f"Setting: {setting_text}.\n\n{len(gain)} scenes (Brute Force: {brute}), n = {_range(gain)}, groups 0 to 3. "
        f"s in units of one nominal bounding radius ({unit * 1e3:.0f} mm). Easy: n = 3, groups 0 and 1; hard: n = 15, "
        f"groups 2 and 3. Errors: one standard error (bootstrap over scenes). Scenes without a push: {without}.\n\n"
    )


def _range(gain: pd.DataFrame) -> str:
    counts = gain.index.get_level_values("n")
    return f"{counts.min()} to {counts.max()}"


def _absolute(cell: pd.DataFrame, name: str, start: "pd.Series[float]") -> str:
    values = cell[(name, *_POINT)].dropna()
    if values.empty:
        return "-"
    begin = start.loc[values.index.get_level_values("scenario")].mean()
    return f"{values.mean():.4f} ; {values.mean() / begin:.3f}"


def _of_brute_force(cell: pd.DataFrame, name: str) -> Estimate:
    if (BRUTE_FORCE, *_POINT) not in cell:
        return Estimate(float("nan"), float("nan"))
    return share(_column(cell, name, *_POINT), _column(cell, BRUTE_FORCE, *_POINT))


def _column(cell: pd.DataFrame, *key: str) -> FloatArray:
    values: FloatArray = cell[key].to_numpy(dtype=float)
    return values


def _paper_time(name: str) -> str:
    return f"{TABLE_ONE[name].runtime:.3f}" if name in TABLE_ONE else "-"


def _paper_share(name: str, case: str) -> str:
    if name not in TABLE_ONE:
        return "-"
    value, percent = getattr(TABLE_ONE[name], case)
    return f"{value:.3f} ({percent:.1f})"


def authors_table(results: pd.DataFrame) -> str:
    """Our policies in the authors' setting beside the authors' code in the authors' simulator."""
    gain = gains(results[(results["contact_mode"] == _POINT[0]) & (results["fits"] == _POINT[1])])
    rows = []
    for name in in_order(set(results["policy"])):
        if name in AUTHORS_CODE:
            shares = [_of_brute_force(gain.query(CASES[case]), name).percent() for case in ("average", "easy", "hard")]
            rows.append([label(name), *[text for pair in zip(shares, _texts(name), strict=True) for text in pair]])
    header = ["policy (% of BF)", "average", "authors' code", "easy", "authors' code", "hard", "authors' code"]
    return table(header, rows)


def judged_table(results: pd.DataFrame) -> str:
    """The same pushes simulated once more by the judge of the setting, Brute Force's too."""
    single = results[(results["contact_mode"] == _POINT[0]) & (results["fits"] == _POINT[1])]
    gain = gains(single.assign(after=single["judged"]))
    rows = [
        [label(name), *[_of_brute_force(gain.query(query), name).percent() for query in CASES.values()]]
        for name in in_order(set(single["policy"]))
    ]
    return table(["policy (% of BF, judged)", *CASES], rows)


def _texts(name: str) -> list[str]:
    return [f"{value:.1f}" for value in AUTHORS_CODE[name]]


def table_two(results: pd.DataFrame, setting_text: str) -> str:
    """Table II: edge and two-point pushes in percent of the same policy's single-point pushes, 10 to 15 objects.

    Counted twice. As the paper counts: every mode performs the same plan, for which the jaws of all modes are free.
    Honestly: each mode plans for itself and takes only starts at which its own jaws are free.
    """
    gain = gains(results[results["n"] >= 10])
    rows = []
    for name in in_order({str(policy) for policy in results["policy"]}):
        row = [label(name)]
        for fits in ("every_mode", "contact_mode"):
            row += [_of_single(gain, name, mode, fits) for mode in ("edge", "two_point")]
        row.append(_of_single(gain, name, "best", "contact_mode"))
        paper = TABLE_TWO.get(name)
        rows.append([*row, *([f"{paper[1]:.1f}", f"{paper[2]:.1f}"] if paper else ["-", "-"])])
    header = ["policy (% of single point)", "equal pushes: edge", "two-point", "own plans: edge", "two-point"]
    header += ["best of three", "paper: edge", "two-point"]
    return f"Setting: {setting_text}.\n\n{len(gain)} scenes, n = {_range(gain)}.\n\n" + table(header, rows)


def _of_single(gain: pd.DataFrame, name: str, mode: str, fits: str) -> str:
    ours, point = (name, mode, fits), (name, "single_point", fits)
    if ours not in gain or point not in gain:
        return "-"
    return share(_column(gain, *ours), _column(gain, *point)).percent()


def write(folder: Path, name: str, text: str) -> None:
    """Write a Markdown file."""
    (folder / f"{name}.md").write_text(text, encoding="utf-8")
