"""The report: whole in one file, true for runs that failed too, and its view is drawn and follows its slider in a
browser."""

import html
import json
import math
import re
import shutil
import subprocess
from types import SimpleNamespace

import imageio.v3 as imageio
import pytest
from test_restart import Cut, Reporter, load

from sdph import cli
from sdph.running import driver
from sdph.schema import CaseError
from sdph.show import view
from sdph.study import report
from sdph.study.report import bars, curves, shown

PROBE = """
<script>
const canvas = document.querySelector('canvas'), slider = document.querySelector('.viewer input');
const pixels = () => canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.buffer;
const colours = () => new Set(new Uint32Array(pixels())).size;
const seen = [];
for (const place of [slider.max, 0]) {
  slider.value = place;
  slider.dispatchEvent(new Event('input'));
  seen.push({colours: colours(), picture: canvas.toDataURL(), label: document.querySelector('output').value});
}
document.body.setAttribute('data-seen', JSON.stringify({
  colours: seen.map(s => s.colours), labels: seen.map(s => s.label), changed: seen[0].picture !== seen[1].picture
}));
</script>
"""


WIDTHS = """
<script>
addEventListener('load', () => parent.document.body.setAttribute('data-seen', JSON.stringify(
  [document.documentElement.clientWidth, document.documentElement.scrollWidth])));
</script>
"""


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Two whole runs and one that failed."""
    folder = tmp_path_factory.mktemp("runs")
    for name, more in (("paper", ("heat.closure='paper'",)), ("plain", ())):
        driver.run(load("disc_cluster", "embedded", *more), "disc_cluster", folder / name, None, Reporter())
    with pytest.raises(Cut):
        driver.run(load("disc_cluster", "embedded"), "disc_cluster", folder / "cut", None, Reporter(5))
    return folder


def test_runs_stand_side_by_side_in_one_file(runs):
    text = report.write([runs / "paper", runs / "plain"], runs / "both.html").read_text()
    assert not re.findall(r'(?:src|href)="(?!data:)', text)
    for part in (
        "At a glance",
        "Curves",
        "Fields",
        "Balances",
        "Where the time went",
        "Results",
        "Limiters: the largest of all windows",
        "What was run",
        "Settings",
        "Versions",
    ):
        assert f"<h2>{part}</h2>" in text
    row = re.search(r"<tr><td>heat.closure</td>(.*?)</tr>", text).group(1)
    assert re.findall(r"<td>(\w+)</td>", row) == ["paper", "geometric"]
    summary = json.loads((runs / "plain" / "summary.json").read_text())
    assert f"{summary['centre_temperature_K']:.6g}</td>" in text


def test_a_droplet_that_grows_tells_its_size_and_pressure_first():
    """Other columns of a gel droplet are many, and panels beyond the ninth are folded."""
    kinds = ["mass_kg", "force_x_N", "particle_7_x_m", "bubble_pressure_Pa", "bubble_2_pressure_Pa", "diameter_ratio"]
    run = SimpleNamespace(metrics={}, case=SimpleNamespace(probes={}))
    assert sorted(kinds, key=lambda kind: curves._rank(kind, [run])) == [*kinds[3:], "force_x_N", "mass_kg", kinds[2]]


def test_it_begins_with_what_the_run_shows(runs):
    """Picture, three numbers and verdicts come before anything else, and a miss is told as one."""
    checks = [
        {"name": "centre [K]", "value": 1.0, "reference": 2.0, "tolerance": 0.5, "ok": False},
        {"name": "rim [K]", "value": 1.0, "reference": 1.0, "tolerance": 0.5, "ok": True},
    ]
    (runs / "plain" / "compare_exact.json").write_text(json.dumps({"checks": checks}))
    text = report.write([runs / "plain"], runs / "first.html").read_text()
    (runs / "plain" / "compare_exact.json").unlink()
    glance = text.partition("<h2>")[2].partition("<h2>")[0]
    assert glance.startswith("At a glance")
    assert glance.count('class="card"') == 3 and 'class="first"' in glance
    summary = json.loads((runs / "plain" / "summary.json").read_text())
    assert f"<b>{summary['centre_temperature_K']:.3g} K</b><span>centre temperature</span>" in glance
    assert "against exact: 1 of 2 missed (centre [K])" in glance
    assert re.search(r"balances: all \d+ hold", glance)
    assert "-2.00" in text.partition("<h2>References")[2].partition("<h2>")[0]


def test_settings_are_last_and_those_that_differ_stand_open(runs):
    text = report.write([runs / "paper", runs / "plain"], runs / "differ.html").read_text()
    settings = text.partition("<h2>Settings")[2].partition("<h2>")[0]
    opened = settings.partition("<details>")[0]
    assert "heat.closure" in opened and "run.end_time_s" not in opened and "run.end_time_s" in settings
    assert text.index("<h2>Curves") < text.index("<h2>Balances") < text.index("<h2>Settings")


def test_curves_of_one_kind_share_a_panel_and_have_their_references():
    assert {curves._kind(f"wall_force_{a}_N") for a in "xyz"} == {"wall_force_N"}
    assert {curves._kind(name) for name in ("D32_m", "Dv50_m", "D10_m")} == {"sizes_m"}
    assert curves._kind("particle_645_u_m_s") == curves._kind("particle_645_v_m_s") != curves._kind("particle_645_x_m")
    checked = {"exact": [{"name": "sag [m] at 0.2 s", "value": 1.0, "reference": 3.0, "tolerance": 0.5, "ok": False}]}
    run = SimpleNamespace(comparisons=checked)
    assert curves._references(run, "sag_m") == [(0.2, 3.0, 0.5)] and not curves._references(run, "front_m")


@pytest.mark.parametrize(
    ("value", "unit", "text"), [(0.0123, "m", "12.3 mm"), (0.3456, "m", "0.346 m"), (101325.0, "Pa", "101 kPa")]
)
def test_key_numbers_have_three_digits_and_a_unit(value, unit, text):
    assert shown.measured(value, unit) == text


@pytest.mark.parametrize(("value", "place"), [(0.0, 0.0), (1e-20, 0.0), (1e-17, 0.0), (1.0, 100.0), (5.0, 100.0)])
def test_balances_lie_on_a_track_from_round_off_to_all(value, place):
    assert bars._place(value) == pytest.approx(place)


def test_runs_whose_folders_are_called_alike_have_names_that_differ(tmp_path):
    def at(*places):
        runs = [shown.Shown(tmp_path / place, None, {}, {}, {}) for place in places]
        return [run.name for run in shown.told_apart(runs)]

    assert at("a/run", "b/run") == ["a/run", "b/run"] and at("a/run") == ["run"]
    assert at("x/a/run", "y/a/run", "z") == ["x/a/run", "y/a/run", f"{tmp_path.parent.name}/{tmp_path.name}/z"]
    assert at("run", "run") == ["run", "run"]


def test_a_balance_that_is_no_number_is_drawn_as_missed(tmp_path):
    """All along the track, in red: the figure has what the verdict counts."""
    run = shown.Shown(tmp_path, None, {"energy_drift_rel": math.nan, "mass_drift_rel": 1e-16}, {}, {})
    text = bars.closures([run])
    assert "nan: missed" in text and text.count(bars.BAD) == 1


def test_limiters_have_a_section_of_their_own(runs):
    """Each with the largest value of each run, and not among the results."""
    path = runs / "plain" / "summary.json"
    before = path.read_text()
    path.write_text(json.dumps(json.loads(before) | {"largest_theta_at_least_share": 0.4321}))
    text = report.write([runs / "paper", runs / "plain"], runs / "limiters.html").read_text()
    path.write_text(before)
    results, limiters = (text.partition(f"<h2>{part}")[2].partition("<h2>")[0] for part in ("Results", "Limiters"))
    assert re.search(r"<td>theta_at_least_share</td><td></td><td[^>]*>0.4321</td>", limiters)
    assert "outside_mesh_particles" in limiters
    assert "theta_at_least_share" not in results and "outside_mesh_particles" not in results


def test_a_failed_run_says_what_went_wrong(runs, capsys):
    (runs / "cut" / "failure.json").write_text(
        json.dumps({"what": "the <gas> was killed", "kind": "GasError", "time_s": 1e-4})
    )
    assert cli.main(["report", str(runs / "cut")]) == 0
    text = (runs / "cut" / "report.html").read_text()
    assert capsys.readouterr().out.strip() == str(runs / "cut" / "report.html")
    assert "failed at t = 0.0001 s: the &lt;gas&gt; was killed" in text


def test_what_is_no_run_is_refused(tmp_path):
    with pytest.raises(CaseError, match="holds no run"):
        report.write([tmp_path], tmp_path / "report.html")


def browser(page, *options):
    """What Chromium says of a page."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if chromium is None:
        pytest.skip("no Chromium was found")
    command = [chromium, "--headless", "--no-sandbox", "--disable-gpu", *options, page.as_uri()]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True).stdout


def seen_by(dom):
    """What a script has put into the body's `data-seen`."""
    return json.loads(re.search(r'data-seen="(.*?)"', dom).group(1).replace("&quot;", '"'))


def test_the_report_fits_a_phone(runs):
    """In a frame as wide as a phone (Chromium's windows are no narrower than 500) nothing stands out at its side."""
    page, phone = report.write([runs / "paper", runs / "plain"], runs / "narrow.html"), runs / "phone.html"
    text = html.escape(page.read_text() + WIDTHS)
    phone.write_text(f'<body><iframe width="375" height="667" style="border: 0" srcdoc="{text}"></iframe></body>')
    width, content = seen_by(browser(phone, "--dump-dom"))  # 375 less a bar
    assert content == width <= 375


def test_the_report_prints(runs):
    page = report.write([runs / "plain"], runs / "printed.html")
    browser(page, f"--print-to-pdf={runs / 'printed.pdf'}", "--no-pdf-header-footer")
    pages = (runs / "printed.pdf").read_bytes().count(b"/Type /Page\n")
    assert 2 <= pages <= 12


@pytest.mark.parametrize("name", ["plain", "cut"])
def test_the_view_is_drawn_and_the_slider_works(runs, name):
    page = report.write([runs / name], runs / f"{name}.html")
    page.write_text(page.read_text().replace("</body>", PROBE + "</body>"))
    seen = seen_by(browser(page, "--dump-dom"))
    assert min(seen["colours"]) > 20  # not blank
    assert seen["labels"][1] == "t = 0.00000 s"
    if name == "plain":
        assert seen["changed"] and seen["labels"][0] == "t = 0.000400000 s"


@pytest.mark.parametrize("suffix", [".gif", ".mp4"])
def test_a_movie_has_every_time(runs, suffix):
    view.movie(runs / "plain", runs / f"movie{suffix}")
    pictures = imageio.imread(runs / f"movie{suffix}", index=None if suffix == ".mp4" else ...)
    assert len(pictures) == 3
    assert pictures[0].std() > 5.0


def test_an_unknown_kind_of_movie_is_refused(runs):
    with pytest.raises(CaseError, match="must end with .gif or .mp4"):
        view.movie(runs / "plain", runs / "movie.txt")
