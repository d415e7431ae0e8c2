"""Figures: what is drawn, where, and that every text can be read."""

from __future__ import annotations

import math
import os
import re
import subprocess
import sys
from itertools import combinations, permutations
from xml.etree import ElementTree

import numpy as np
import pytest

from impact88.casework.chapter.staged import collisions, experimental, forward, predict_delta_v
from impact88.casework.figures import canvas, charts, views
from impact88.casework.figures.canvas import svg
from impact88.casework.figures.drawing import (
    Box,
    Drawing,
    Label,
    Path,
    Text,
    arrow,
    pieces,
    place,
    text_box,
    text_runs,
    text_width,
    unit,
)
from impact88.casework.figures.scenegeometry import plan
from impact88.casework.figures.sceneview import scene_drawing, scene_svg
from impact88.casework.figures.views import configurations
from impact88.collision.casescene import Scene, sample
from impact88.errors import UserError
from impact88.interface.commands import figure_command as command
from impact88.interface.commands.cli import main
from impact88.interface.commands.figure_command import solve_scene
from impact88.mechanics.closedform.solve import solve
from impact88.names import RESULTS, SCENE, quantity

POINT = 25.4 / 72


def staged_scene(number: int) -> Scene:
    """A staged collision with Table 2's coefficients, as a scene."""
    found = next(item for item in collisions() if item.number == number)
    own = {**found.scene, "E": found.table2["e"], "EM": found.table2["em"]}
    own |= {"MU": abs(found.table2["mu"]), "M": 6}
    return Scene({name: f"{value:g}" for name, value in own.items()})


def random_scene(seed: int) -> Scene:
    """Any two vehicles, anywhere, however unlikely."""
    rng = np.random.default_rng(seed)
    low = {"E": 0, "MU": 0, "EM": -1, "DA": 0, "DB": 0, "MA": 50, "MB": 50, "IA": 500, "IB": 500}
    high = {"E": 1, "MU": 1.5, "EM": 0, "DA": 10, "DB": 10, "MA": 900, "MB": 300, "IA": 5e4}
    high |= {"IB": 5000}
    texts = {name: f"{rng.uniform(low[name], high[name]):.4g}" for name in low}
    texts |= {name: f"{rng.uniform(-180, 180):.1f}" for name in ("GA", "PA", "PB", "TA", "TB")}
    texts |= {name: f"{rng.uniform(-60, 60):.2f}" for name in ("UX", "UY", "VX", "VY")}
    texts |= {name: f"{rng.choice([0, 0, 1.5, -4])}" for name in ("WA", "WB")}
    return Scene(texts)


SWEEP = bool(os.environ.get("IMPACT88_SWEEP"))
STAGED = [item.number for item in collisions()] if SWEEP else [3, 8, 11]
SCENES = {
    **{f"sample {number}": sample(number) for number in (1, 2, 3)},
    **{f"collision {number}": staged_scene(number) for number in STAGED},
    **{f"random {seed}": random_scene(seed) for seed in range(200 if SWEEP else 3)},
    "pivot": sample(1).replaced({"MU": "-10"}),
    "M = 4 with distances": sample(1).replaced({"M": "4"}),
    "separating": sample(1).replaced({"GA": "150"}),
    "spins before": sample(3).replaced({"WA": "3", "WB": "-2"}),
    "nothing moves": sample(1).replaced(dict.fromkeys(("UX", "UY", "VX", "VY"), "0")),
    "wall": sample(1).replaced({"MB": "1E9", "IB": "1E12", "VX": "0", "VY": "0", "GA": "0"}),
    "tiny units": sample(1).replaced({"MA": "4E-3", "IA": "4E-8", "DA": "5E-3", "DB": "0"}),
    "slow": sample(1).replaced({"UX": "-2E-6", "VX": "1E-6", "VY": "1E-6"}),
}


@pytest.fixture(params=SCENES, scope="module")
def drawn(request):
    scene = SCENES[request.param]
    return scene, scene_drawing(scene, solve_scene(scene))


def overlaps(drawing: Drawing) -> list[tuple[str, str]]:
    boxes = [(text.text, text_box(text)) for text in drawing.texts()]
    return [(a[0], b[0]) for a, b in combinations(boxes, 2) if a[1].overlaps(b[1])]


def within(page: Box, box: Box) -> bool:
    return (
        page.left <= box.left and box.right <= page.right
        and page.bottom <= box.bottom and box.top <= page.top
    )  # fmt: skip


def off_page(drawing: Drawing) -> list[str]:
    page = Box(0, -drawing.height, drawing.width, 0)
    texts = [text.text for text in drawing.texts() if not within(page, text_box(text))]
    paths = [
        item.role
        for item in drawing.items
        if isinstance(item, Path)
        for point in item.points
        if not (0 <= point.real <= page.right and page.bottom <= point.imag <= 0)
    ]
    return texts + paths


def one(drawing: Drawing, role: str) -> Path:
    (path,) = [i for i in drawing.items if i.role == role and isinstance(i, Path)]
    return path


def direction(path: Path) -> complex:
    run = path.points[-1] - path.points[0]
    return run / abs(run)


class TestScene:
    def test_no_text_overlaps_another(self, drawn):
        assert overlaps(drawn[1]) == []

    def test_everything_is_on_the_page(self, drawn):
        assert off_page(drawn[1]) == []

    def test_one_column_wide_and_legible(self, drawn):
        assert drawn[1].width == 85
        assert drawn[1].height < 135
        assert min(text.size for text in drawn[1].texts()) >= 6

    def test_says_what_is_what(self, drawn):
        texts = {text.text for text in drawn[1].texts()}
        assert {"A", "B", "C", "n", "t", "x", "y", "velocity before", "ΔV"} <= texts

    def test_arrows_point_as_the_velocities_do(self, drawn):
        scene, drawing = drawn
        value = {name: float(scene[name]) for name in scene} | solve_scene(scene)
        roles = {path.role for path in drawing.paths()}
        velocities = {
            "A before": complex(value["UX"], value["UY"]),
            "B before": complex(value["VX"], value["VY"]),
            "A after": complex(value["VAX"], value["VAY"]),
            "B after": complex(value["VBX"], value["VBY"]),
        }
        fastest = max(abs(velocities["A before"]), abs(velocities["B before"]))
        for role, velocity in velocities.items():
            if role in roles:
                expected = velocity / abs(velocity)
                assert direction(one(drawing, role)) == pytest.approx(expected, abs=1e-6)
            elif not (role[0] == "B" and value["MB"] == 1e9):
                assert abs(velocity) <= 0.01 * fastest

    def test_impulse_is_what_the_solution_says(self, drawn):
        scene, drawing = drawn
        result = solve({name: float(scene[name]) for name in scene}, ["PN", "PT"])
        expected = complex(result["PN"], result["PT"]) * unit(float(scene["GA"]))
        if not expected:
            assert "impulse" not in {path.role for path in drawing.paths()}
            return
        shapes = plan(scene, solve_scene(scene))
        assert shapes.impulse == pytest.approx(expected, rel=1e-6)
        found = direction(one(drawing, "impulse"))
        assert found == pytest.approx(expected / abs(expected), abs=1e-5)


class TestPlan:
    def test_contact_point_is_where_line_330_has_it(self):
        for scene in (sample(1), sample(3), staged_scene(3)):
            value = {name: float(text) for name, text in scene.items()}
            rad = math.radians
            d1 = value["DB"] * math.sin(rad(value["TB"] + value["PB"]))
            d2 = value["DB"] * math.cos(rad(value["TB"] + value["PB"]))
            d3 = value["DA"] * math.sin(rad(value["TA"] + value["PA"]))
            d4 = value["DA"] * math.cos(rad(value["TA"] + value["PA"]))
            a, b = plan(scene).vehicles
            # the contact point is the origin
            assert a.center == pytest.approx(complex(d4, d3))
            assert b.center == pytest.approx(complex(-d2, -d1))

    def test_fronts_face_each_other_in_a_head_on(self):
        a, b = plan(staged_scene(11)).vehicles
        assert a.front == pytest.approx(-1)
        assert b.front.real > 0.98

    def test_struck_rear(self):
        """Collision 3: B stands with its back to A."""
        a, b = plan(staged_scene(3)).vehicles
        assert a.front.real < -0.98
        assert b.front.real < -0.98

    def test_outline_has_the_radius_of_gyration(self):
        a = plan(sample(1)).vehicles[0]
        assert a.length**2 + a.width**2 == pytest.approx(12 * 3728 / 143.5)
        assert a.length / a.width == pytest.approx(2.6)
        assert 14 < a.length < 19  # feet: a car of 1974

    def test_outline_reaches_the_contact_point(self):
        scene = sample(1).replaced({"DA": "12", "PA": "5"})
        a = plan(scene).vehicles[0]
        front = max(((p - a.center) / a.front).real for p in a.outline)
        assert front >= 12 * math.cos(math.radians(5)) - 1e-9

    def test_crush_of_both_is_visible(self):
        """Dashed lines lie over every ground."""
        items = scene_drawing(sample(1), solve_scene(sample(1))).items
        roles = [item.role for item in items]
        grounds = [at for at, role in enumerate(roles) if role == "body"]
        for vehicle in "AB":
            assert roles.index(f"{vehicle} whole") > max(grounds)

    def test_units_and_title_are_shown(self, tmp_path):
        path = tmp_path / "us.toml"
        text = sample(1).to_toml().replace('units = "chapter"', 'units = "us"', 1)
        path.write_text(text, encoding="utf-8")
        scene = Scene.from_toml(str(path))
        drawing = scene_drawing(scene, solve_scene(scene), title=scene.title)
        texts = [item.text for item in drawing.texts()]
        assert "Appendix, first sample run" in texts
        assert "10 mph" in texts
        assert any(text.endswith(" ft") for text in texts)
        assert "29.04" in texts  # mph, as typed
        assert any("lb-s" in text for text in texts)

    def test_crushed_part_is_cut_at_the_plane(self):
        a, b = plan(sample(1)).vehicles
        n = plan(sample(1)).normal
        assert min((p / n).real for p in a.kept) >= -1e-9
        assert max((p / n).real for p in b.kept) <= 1e-9
        assert len(b.kept) == 4
        assert b.kept != b.outline

    def test_point_masses_touch_at_the_plane(self):
        shapes = plan(sample(2))
        assert shapes.apart
        a, b = shapes.vehicles
        assert min((p / shapes.normal).real for p in a.outline) == pytest.approx(0, abs=1e-9)
        assert max((p / shapes.normal).real for p in b.outline) == pytest.approx(0, abs=1e-9)

    def test_wall(self):
        scene = SCENES["wall"]
        drawing = scene_drawing(scene, solve_scene(scene))
        assert plan(scene).vehicles[1].wall
        roles = [item.role for item in drawing.items if isinstance(item, Path)]
        assert "B wall" in roles
        assert "B outline" not in roles
        assert any("rigid barrier" in text.text for text in drawing.texts())

    def test_a_heavy_vehicle_that_moves_is_no_wall(self):
        assert not plan(SCENES["wall"].replaced({"VX": "1"})).vehicles[1].wall

    def test_before_ends_and_after_starts_at_the_center(self):
        drawing = scene_drawing(sample(1), solve_scene(sample(1)))
        center = np.mean(one(drawing, "A center").points)
        after = one(drawing, "A after").points
        assert after[0] == pytest.approx(center, abs=1e-6)
        head = one(drawing, "A before head").points[0]
        assert head == pytest.approx(center, abs=1e-6)

    def test_rebound_on_one_line_is_drawn_beside(self):
        scene = sample(2).replaced({"GA": "0", "MU": "0", "E": "1", "VX": "30", "VY": "0"})
        drawing = scene_drawing(scene, solve_scene(scene))
        before, after = one(drawing, "A before"), one(drawing, "A after")
        assert abs(before.points[0].imag - after.points[0].imag) > 0.5

    def test_scale_bar(self):
        drawing = scene_drawing(sample(1), solve_scene(sample(1)))
        bar = one(drawing, "speed scale")
        shaft, head = one(drawing, "A before"), one(drawing, "A before head")
        length = abs(shaft.points[0] - head.points[0])
        shown = abs(np.subtract(*bar.points))
        assert shown / length == pytest.approx(10 / 29.04)
        assert any(text.text == "10 ft/s" for text in drawing.texts())
        length = one(drawing, "length scale")
        side = np.subtract(*one(drawing, "A whole").points[1:3])
        shown = abs(np.subtract(*length.points) / side)
        scene = sample(1)
        drawn = plan(scene, units=scene.case.system).vehicles[0]
        assert shown == pytest.approx(5 / drawn.length)

    def test_spins_turn_the_way_they_do(self):
        scene = sample(1).replaced({"WA": "2"})
        drawing = scene_drawing(scene, solve_scene(scene))
        arcs = [i for i in drawing.items if isinstance(i, Path) and i.role == "A spin"]
        spins = [2.0, float(solve({n: float(scene[n]) for n in scene}, ["WAF"])["WAF"])]
        assert spins[1] < 0 or spins[1] > 0
        for arc, spin in zip(arcs, spins, strict=True):
            center = np.mean(one(drawing, "A center").points)
            first, second = (p - center for p in arc.points[:2])
            assert np.sign((second / first).imag) == np.sign(spin)

    def test_remarks_stand_under_the_drawing(self):
        scene = SCENES["separating"]
        notes = " ".join(
            text.text
            for text in scene_drawing(scene, solve_scene(scene)).texts()
            if text.role == "note"
        )
        assert "kinetic energy is gained" in notes

    def test_without_a_result(self):
        drawing = scene_drawing(sample(1))
        roles = {item.role for item in drawing.items if isinstance(item, Path)}
        assert "A before" in roles
        assert not {"A after", "impulse"} & roles
        assert overlaps(drawing) == []

    def test_table_has_the_numbers(self):
        texts = [t.text for t in scene_drawing(sample(1), solve_scene(sample(1))).texts()]
        for text in ("29.04", "13.7", "16.15", "24.19", "−1.745", "−0.8201"):
            assert text in texts

    @pytest.mark.parametrize("value", ["", "nan", "1e999", "x"])
    def test_refuses_what_is_no_number(self, value):
        with pytest.raises(UserError, match=r"MA: .* is not a finite number"):
            plan({**sample(1), "MA": value})
        with pytest.raises(UserError, match="GA"):
            plan({name: text for name, text in sample(1).items() if name != "GA"})


class TestSvg:
    def test_self_contained_and_whole(self, drawn):
        scene, drawing = drawn
        text = scene_svg(scene, solve_scene(scene))
        root = ElementTree.fromstring(text)
        name = "{http://www.w3.org/2000/svg}"
        assert root.tag == f"{name}svg"
        assert root.get("width") == "85mm"
        texts = [node for node in root.iter(f"{name}text") if node.get("class") != "halo"]
        shown = ["".join(node.itertext()) for node in texts]
        assert shown == [re.sub(r"_\{?|\}", "", item.text) for item in drawing.texts()]
        paths = [item for item in drawing.items if isinstance(item, Path)]
        assert len(list(root.iter(f"{name}path"))) == len(paths)
        assert not re.search(r"href|url\(|<script|nan|inf", text)
        assert "speed" in (root.find(f"{name}desc").text or "")

    def test_halo_is_a_text_of_its_own_behind(self):
        """Painted in order, white first: no renderer hides the text under its own outline."""
        root = ElementTree.fromstring(scene_svg(sample(1)))
        texts = [node for node in root.iter() if node.tag.endswith("}text")]
        assert len(texts) % 2 == 0
        for halo, text in zip(texts[::2], texts[1::2], strict=True):
            assert halo.get("class") == "halo"
            assert (halo.get("fill"), halo.get("stroke")) == ("#ffffff", "#ffffff")
            assert "".join(halo.itertext()) == "".join(text.itertext())
            assert text.get("stroke") is None
            assert text.get("fill") != "#ffffff"

    def test_dashes_are_drawn_piece_by_piece(self):
        text = svg(Drawing(20, "t", height=10, items=[Path((-5j, 10 - 5j), dash=(2.0, 1.0))]))
        assert 'd="M0 5 L2 5 M3 5 L5 5 M6 5 L8 5 M9 5 L10 5"' in text
        corner = svg(
            Drawing(20, "t", height=10, items=[Path((-5j, 3 - 5j, 3 - 10j), dash=(4.0, 1.0))])
        )
        assert 'd="M0 5 L3 5 L3 6 M3 7 L3 10"' in corner

    def test_y_points_down_in_svg(self):
        drawing = Drawing(10, "t", height=10, items=[Path((1 - 9j, 1 - 1j)), Text(1 - 1j, "top")])
        text = svg(drawing)
        assert "M1 9 L1 1" in text
        assert 'y="1"' in text

    def test_markup_is_escaped(self):
        text = svg(Drawing(10, "<&", height=10, items=[Text(1 - 1j, "a<b & c")]))
        assert "".join(ElementTree.fromstring(text).find(".//*[@x]").itertext()) == "a<b & c"

    def test_needs_no_matplotlib(self):
        code = (
            "import sys\nsys.modules['matplotlib'] = None\n"
            "from impact88.casework.figures.sceneview import scene_drawing, scene_svg\n"
            "from impact88.collision.casescene import sample\n"
            "assert '<svg' in scene_svg(sample(1), {'VAX': -13, 'VAY': 3, 'VBX': -9, 'VBY': 20})\n"
        )
        subprocess.run([sys.executable, "-c", code], check=True)


class TestText:
    def test_widths_are_those_of_the_font(self):
        from matplotlib.font_manager import FontProperties
        from matplotlib.textpath import TextPath

        for text in (
            "velocity before",
            "|V| after 0123456789",
            "ΔV Ω ω φ Γ",
            "Outlines I/m, L/W = 2.6",
        ):
            for bold in (False, True):
                font = FontProperties(family="DejaVu Sans", weight="bold" if bold else "normal")
                real = TextPath((0, 0), text, size=10, prop=font).get_extents().width * POINT
                assert real <= text_width(text, 10, bold) * 1.005
                assert real >= text_width(text, 10, bold) * 0.9

    def test_subscripts(self):
        assert pieces("v_a") == [("v", False), ("a", True)]
        assert pieces("v_{an}, v_{at}") == [
            ("v", False), ("an", True), (", v", False), ("at", True),
        ]  # fmt: skip
        (first, _, _), (second, _, size) = text_runs(Text(0j, "V_a", 10))
        assert size == 7
        assert second.imag < first.imag
        assert second.real == pytest.approx(text_width("V", 10))

    @pytest.mark.parametrize("name", [*RESULTS, *SCENE])
    def test_a_symbol_is_one_letter_with_its_whole_subscript(self, name):
        """v_ax is v with ax below, not v with a below and x beside."""
        symbol = quantity(name).symbol
        runs = pieces(symbol)
        if "_" in symbol and "/" not in symbol:
            assert [below for _, below in runs] == [False, True], runs
            assert runs[1][0] == symbol.partition("_")[2]

    def test_labels_keep_off_lines_and_texts(self):
        drawing = Drawing(60, "t", height=60)
        drawing.items += arrow(30 - 55j, 30 - 5j)
        drawing.add(*(Label(30 - 30j, 1, text) for text in "abcdef"))
        place(drawing, Box(0, -60, 60, 0))
        assert overlaps(drawing) == []
        assert not any(text_box(t).left < 30 < text_box(t).right for t in drawing.texts())


class TestCanvas:
    @pytest.mark.long
    def test_ink_of_texts_does_not_overlap(self, monkeypatch):
        """What matplotlib paints keeps to the boxes that the layout reckons with."""
        drawing = scene_drawing(sample(1), solve_scene(sample(1)))
        import matplotlib

        # as files are written
        monkeypatch.setitem(matplotlib.rcParams, "text.hinting", "no_hinting")
        figure = canvas.make_figure(drawing)
        assert figure.get_size_inches() * 25.4 == pytest.approx([85, drawing.height])
        figure.canvas.draw()
        boxes = [text_box(text) for text in drawing.texts()]
        for shown in figure.axes[0].texts:
            ink = shown.get_window_extent().transformed(figure.axes[0].transData.inverted())
            x, y = (ink.x0 + ink.x1) / 2, (ink.y0 + ink.y1) / 2
            around = [b for b in boxes if b.left < x < b.right and b.bottom < y < b.top]
            assert any(b.left - 0.3 < ink.x0 and ink.x1 < b.right + 0.6 for b in around)

    def test_formats(self, tmp_path):
        drawing = scene_drawing(sample(1))
        starts = {"svg": b"<?xml", "png": b"\x89PNG", "pdf": b"%PDF"}
        for ending, start in starts.items():
            path = tmp_path / f"scene.{ending}"
            canvas.save(drawing, str(path), dots_per_inch=75)
            assert path.read_bytes().startswith(start)
            # what a reader who cannot see it misses goes with it; the drawing's words are texts
            assert b"Vehicle A: speed 29.04 ft/s before" in path.read_bytes()
        assert sorted(p.suffix for p in tmp_path.iterdir()) == [".pdf", ".png", ".svg"]

    @pytest.mark.long
    def test_nobody_elses_settings_change_a_figure(self, tmp_path, monkeypatch):
        line = "figure force -o {}.pdf"
        monkeypatch.chdir(tmp_path)
        assert main(line.format("usual").split()) == 0
        (tmp_path / "matplotlibrc").write_bytes(b"font.size: 40\nbogus\n\xff\xfe")
        cli = "impact88.interface.commands.cli"
        code = f"import sys; from {cli} import main; sys.exit(main(sys.argv[1:]))"
        done = subprocess.run(
            [sys.executable, "-c", code, *line.format("set").split()],
            env={**os.environ, "MPLBACKEND": "nonsense"},
            capture_output=True,
            check=False,
        )
        assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")
        import matplotlib

        with matplotlib.rc_context({"font.size": 40, "savefig.bbox": "tight"}):
            assert main(line.format("own").split()) == 0
            assert matplotlib.rcParams["font.size"] == 40
        usual = (tmp_path / "usual.pdf").read_bytes()
        assert (tmp_path / "set.pdf").read_bytes() == usual == (tmp_path / "own.pdf").read_bytes()

    def test_other_endings_are_refused(self, tmp_path):
        with pytest.raises(UserError, match=r"expected \.svg, \.png, \.pdf"):
            canvas.save(scene_drawing(sample(1)), str(tmp_path / "x.bmp"))


class TestFreeBodies:
    @pytest.mark.parametrize(
        "drawing",
        [
            views.colinear(),
            views.planar(),
            views.planar(sample(3)),
            views.planar(staged_scene(11)),
            configurations(),
        ],
        ids=["colinear", "planar", "planar 3", "planar head-on", "configurations"],
    )
    def test_legible(self, drawing):
        assert overlaps(drawing) == []
        assert off_page(drawing) == []
        assert drawing.width == 85

    def test_impulses_are_opposite(self):
        for drawing in (views.colinear(), views.planar()):
            texts = {text.text for text in drawing.texts()}
            assert {"P_n", "P_t", "−P_n", "−P_t"} <= texts
            shafts = [i for i in drawing.items if isinstance(i, Path) and i.role == "impulse"]
            directions = [np.round(direction(path), 9) for path in shafts]
            assert len(directions) == 4
            assert all(-way in directions for way in directions)

    def test_planar_of_point_masses_has_no_arms_and_no_moment(self):
        texts = {text.text for text in views.planar(sample(2)).texts()}
        assert {"P_n", "P_t", "−P_n", "−P_t", "n", "t", "Γ", "x", "y"} <= texts
        assert not {"M", "−M", "d_a", "d_b", "φ_a", "φ_b", "θ_b"} & texts
        roles = {item.role for item in views.planar(sample(2)).items}
        assert not any(role.startswith("moment") for role in roles)

    def test_planar_names_every_quantity_of_figure_3(self):
        texts = {text.text for text in views.planar().texts()}
        assert {"M", "−M", "d_a", "d_b", "φ_a", "φ_b", "θ_b", "Γ", "n", "t"} <= texts

    def test_configurations_are_the_four_of_figure_4(self):
        titles = [t.text for t in configurations().texts() if t.role == "panel title"]
        assert [title[:2] for title in titles] == ["a.", "b.", "c.", "d."]
        assert "60° front to side" in titles[0]
        assert "front to rear" in titles[3]


def read_axes(drawing: Drawing) -> list[tuple]:
    """Of each panel two functions from paper to numbers, reckoned from its numbers and ticks."""
    panels: list[dict] = []
    for item in drawing.items:
        if isinstance(item, Path) and item.role == "axis":
            if not panels or "up" in panels[-1]:
                panels.append({"x tick": [], "y tick": [], "bottom": item.points[0].imag})
            else:
                panels[-1]["up"] = item.points[0].real
        elif isinstance(item, Text) and item.role in ("x tick", "y tick"):
            number = float(item.text.replace("−", "-"))
            height = item.size * POINT
            place_ = item.at.real if item.role == "x tick" else item.at.imag + 0.8
            assert height
            panels[-1][item.role].append((place_, number))
    result = []
    for panel in panels:
        lines = [np.polyfit(*zip(*panel[role], strict=True), 1) for role in ("x tick", "y tick")]
        result.append(tuple(np.poly1d(line) for line in lines))
    return result


def of_role(drawing: Drawing, role: str) -> list[Path]:
    return [path for path in drawing.paths() if path.role == role]


class TestCharts:
    def test_texts_do_not_overlap(self):
        for drawing in (charts.figure_5(), charts.force_and_impulse()):
            assert drawing.width == 85
            assert overlaps(drawing) == []
            assert off_page(drawing) == []
            assert len(drawing.description) > 40

    def test_figure_5_is_our_own_computation(self):
        drawing = charts.figure_5()
        ((across, up),) = read_axes(drawing)
        points = {
            name: [
                (across(middle.real), up(middle.imag))
                for path in of_role(drawing, name)
                for middle in [np.mean(path.points)]
            ]
            for name in ("impact equations", "Equation 19")
        }
        assert [len(series) for series in points.values()] == [22, 22]
        one_ = next(item for item in collisions() if item.number == 1)
        measured = experimental(one_)["DVA"]
        for name, computed in (("impact equations", forward), ("Equation 19", predict_delta_v)):
            expected = (measured, float(computed(one_)["DVA"]))
            assert any(point == pytest.approx(expected, rel=1e-3) for point in points[name])
        # collision 8's measured velocity of A is lost: Table 2's value stands in
        assert any(x == pytest.approx(22.9, rel=1e-3) for x, _ in points["Equation 19"])

    def test_impulses_of_figure_1_are_equal(self):
        areas, tops = [], []
        for path in of_role(charts.force_and_impulse(), "force"):
            x, y = np.real(path.points), np.imag(path.points)
            areas.append(abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1))) / 2)
            tops.append(y.max() - y.min())
        assert areas[0] == pytest.approx(areas[1], rel=1e-6)
        assert 2 <= tops[0] / tops[1] <= 3  # Section III


class TestCommand:
    def run(self, capsys, *arguments):
        status = main(["figure", *arguments])
        out, err = capsys.readouterr()
        return status, out, err

    @pytest.mark.parametrize("kind", ["scene", "planar"])
    def test_of_a_scene(self, capsys, tmp_path, kind):
        path = tmp_path / "x.svg"
        assert self.run(capsys, kind, "--sample", "1", "--set", "MU=.5", "-o", str(path)) == (
            0, "", "",
        )  # fmt: skip
        ElementTree.parse(path)

    @pytest.mark.parametrize("kind", command.OF_NOTHING)
    def test_of_the_chapter(self, capsys, tmp_path, kind):
        path = tmp_path / "x.svg"
        assert self.run(capsys, kind, "-o", str(path))[0] == 0
        ElementTree.parse(path)

    def test_title_is_the_scenes(self, capsys, tmp_path):
        path = tmp_path / "x.svg"
        self.run(capsys, "scene", "--sample", "2", "-o", str(path))
        title = ElementTree.parse(path).getroot()[0].text
        assert title == "Appendix, second sample run: point masses"

    @pytest.mark.parametrize(
        ("arguments", "says"),
        [
            (["scene", "-o", "x.svg"], "expected one scene"),
            (["scene", "--sample", "1", "-o", "x.bmp"], "unsupported picture format .bmp"),
            (["scene", "--sample", "1", "-o", "/nowhere/at/all/x.png"], "cannot be written"),
            (["staged", "--sample", "1", "-o", "x.svg"], "takes no scene"),
            (["poster", "-o", "x.svg"], "invalid choice"),
            (["scene", "--sample", "1"], "-o/--output"),
            (["scene", "--sample", "1", "--set", "XX=1", "-o", "x.svg"], "XX"),
        ],
    )
    def test_refusals(self, capsys, tmp_path, monkeypatch, arguments, says):
        monkeypatch.chdir(tmp_path)
        status, out, err = self.run(capsys, *arguments)
        assert (status, out) == (2, "")
        assert says in err
        assert err.count("\n") == 1
        assert list(tmp_path.iterdir()) == []

    def test_missing_matplotlib(self, capsys, tmp_path, monkeypatch):
        for name in list(sys.modules):
            if name.partition(".")[0] == "matplotlib":
                monkeypatch.delitem(sys.modules, name)
        monkeypatch.setitem(sys.modules, "matplotlib", None)
        for kind in ("planar", "scene"):
            assert self.run(capsys, kind, "--sample", "1", "-o", str(tmp_path / "x.svg"))[0] == 0
            (tmp_path / "x.svg").unlink()
            status, _, err = self.run(capsys, kind, "--sample", "1", "-o", str(tmp_path / "x.png"))
            assert status == 2
            assert err == (
                "impact88 figure: PNG and PDF need matplotlib, which is not installed; "
                "pip install 'impact88[plot]'\n"
            )
        assert list(tmp_path.iterdir()) == []


class TestToScale:
    def test_measured_outlines_are_drawn_and_said(self):
        text = sample(1).to_toml() + "LA = 16\nBA = 6\n"
        scene = Scene.from_toml_text(text, "s.toml")
        a, b = plan(scene, None, scene.case.outlines).vehicles
        assert (a.length, a.width) == (16, 6)
        assert b.length / b.width == pytest.approx(2.6)
        drawing = scene_drawing(scene, solve_scene(scene))
        notes = " ".join(text.text for text in drawing.texts() if text.role == "note")
        assert "A drawn as measured, 16 by 6 ft." in notes
        assert "B drawn as a car of its weight, 15.1 by 5.9 ft." in notes
        assert (
            f"Relative speed of the centers {math.hypot(29.04 + 14.52, 25.15):.4g} ft/s." in notes
        )

    @pytest.mark.parametrize(
        ("units", "mass", "inertia", "length", "width", "words"),
        [
            ("us", "80000", "1000000", 62.3, 8.5, "a truck with a trailer"),
            ("us", "3000", "1900", 15.1, 5.9, "a car"),
            ("metric", "1400", "2500", 4.6, 1.8, "a car"),
            ("metric", "220", "60", 2.2, 0.8, "a motorcycle"),
            ("metric", "3500", "9000", 5.7, 2.0, "a light truck"),
            ("si", "12000", "60000", 9.0, 2.5, "a heavy truck"),
        ],
    )
    def test_a_vehicle_has_the_size_of_its_class(self, units, mass, inertia, length, width, words):
        values = {**sample(1), "units": units, "DA": "0.3", "DB": "0.3"}
        scene = Scene({**values, "MA": mass, "IA": inertia, "MB": mass, "IB": inertia})
        drawing = scene_drawing(scene, solve_scene(scene))
        notes = " ".join(text.text for text in drawing.texts() if text.role == "note")
        unit = "ft" if units == "us" else "m"
        size = f"{length:.1f} by {width:.1f} {unit}".replace(".0 ", " ")
        assert f"A and B each drawn as {words} of its weight, {size}." in notes

    def test_point_masses_are_discs_that_touch(self):
        scene = sample(2)
        shapes = plan(scene, solve_scene(scene), units=scene.case.system)
        for vehicle in shapes.vehicles:
            distances = [abs(point - vehicle.center) for point in vehicle.outline]
            assert distances == pytest.approx([vehicle.length / 2] * len(distances))
            assert abs(vehicle.center) == pytest.approx(vehicle.length / 2)
        drawing = scene_drawing(scene, solve_scene(scene))
        notes = " ".join(text.text for text in drawing.texts() if text.role == "note")
        assert "Point masses: drawn as discs, moved apart along n." in notes
        assert one(drawing, "impulse")
        assert not [item for item in drawing.paths() if item.role in ("glass", "heading")]

    def test_force_and_change_of_velocity(self):
        scene = sample(1)
        drawing = scene_drawing(scene, solve_scene(scene))
        for vehicle, x, y in (("A", "UX", "UY"), ("B", "VX", "VY")):
            after = {"A": ("VAX", "VAY"), "B": ("VBX", "VBY")}[vehicle]
            result = solve_scene(scene)
            change = complex(result[after[0]], result[after[1]])
            change -= complex(float(scene[x]), float(scene[y]))
            found = direction(one(drawing, f"{vehicle} change"))
            assert found == pytest.approx(change / abs(change), abs=1e-6)
        texts = [text.text for text in drawing.texts()]
        assert "P, 12 o'clock" in texts  # PDOF −12°, as `reconstruct` has it
        assert "−P, 2 o'clock" in texts  # 48°
        assert {"−12°", "48°"} <= set(texts)

    def test_an_exhibit_is_the_same_drawing_larger(self, tmp_path):
        small, large = tmp_path / "s.svg", tmp_path / "l.svg"
        line = ["figure", "scene", "--sample", "1", "-o"]
        assert main([*line, str(small)]) == main([*line, str(large), "--width", "850"]) == 0
        first, second = (path.read_text("utf-8") for path in (small, large))
        assert 'width="850mm"' in second
        assert first.partition("viewBox")[2] == second.partition("viewBox")[2]


RENDERED = {
    "scene": "scene --sample 1",
    "point masses": "scene --sample 2",
    "planar": "planar",
    **{kind: kind for kind in command.OF_NOTHING},
}
RENDERED_DOTS = canvas.DOTS_PER_INCH


class TestRendered:
    """Every kind as SVG, PNG and PDF, each painted by another program: one picture."""

    @pytest.mark.parametrize("kind", RENDERED)
    @pytest.mark.long
    def test_one_picture_in_every_format(self, capsys, tmp_path, kind):
        resvg_py = pytest.importorskip("resvg_py")
        pypdfium2 = pytest.importorskip("pypdfium2")
        image = pytest.importorskip("PIL.Image")
        from io import BytesIO

        import matplotlib

        for ending in canvas.FORMATS:
            line = [*RENDERED[kind].split(), "-o", str(tmp_path / f"x.{ending}")]
            assert main(["figure", *line]) == 0, capsys.readouterr().err
        png = image.open(tmp_path / "x.png").convert("L")
        page = pypdfium2.PdfDocument(tmp_path / "x.pdf")[0]
        pdf = page.render(scale=RENDERED_DOTS / 72).to_pil().convert("L")
        drawn = (tmp_path / "x.svg").read_text("utf-8")
        fonts = matplotlib.get_data_path() + "/fonts/ttf"
        drawn = resvg_py.svg_to_bytes(
            svg_string=drawn,
            dpi=96,
            zoom=RENDERED_DOTS / 96,
            background="#ffffff",
            skip_system_fonts=True,
            font_dirs=[fonts],
        )
        svg = image.open(BytesIO(bytes(drawn))).convert("L")
        ink = {}
        width, height = np.min([png.size, pdf.size, svg.size], axis=0)
        for name, picture in (("png", png), ("pdf", pdf), ("svg", svg)):
            assert np.ptp([picture.size, png.size], axis=0).max() <= 2, name
            grey = np.asarray(picture)[:height, :width]
            ink[name] = grey < 120, grey < 245
            edge = np.concatenate([grey[0], grey[-1], grey[:, 0], grey[:, -1]])
            assert edge.min() > 245, f"{name}: something touches the page's edge"
        for one, other in permutations(ink, 2):
            near = ink[other][1].copy()
            for _ in range(RENDERED_DOTS // 40):  # dots
                wider = near.copy()
                wider[1:] |= near[:-1]
                wider[:-1] |= near[1:]
                wider[:, 1:] |= near[:, :-1]
                wider[:, :-1] |= near[:, 1:]
                near = wider
            alone = ink[one][0] & ~near
            assert not alone.any(), f"{alone.sum()} dots of {one} are not in {other}"

    def test_an_outline_is_closed_in_every_format(self, tmp_path):
        """An open outline that ends where it began keeps its last edge: matplotlib's Polygon
        drops it."""
        image = pytest.importorskip("PIL.Image")
        corners = (10 - 10j, 30 - 10j, 30 - 30j, 10 - 30j, 10 - 10j)
        for dash in ((), (3.0, 1.0)):
            drawing = Drawing(40, "a square", height=40, items=[Path(corners, "#000000", 1, dash)])
            canvas.save(drawing, str(tmp_path / "x.png"), dots_per_inch=50.8)
            dark = np.asarray(image.open(tmp_path / "x.png").convert("L")) < 128
            edges = dark[20, 22:58], dark[60, 22:58], dark[22:58, 20], dark[22:58, 60]
            for edge in edges:
                assert edge.mean() > (0.6 if dash else 0.99)

    def test_underscores_of_a_title_are_underscores(self):
        drawing = scene_drawing(sample(1), title=r"photo_12 \_ a_{b}")
        (line,) = [text for text in drawing.texts() if text.role == "title"]
        cut = pieces(line.text)
        assert not any(below for _, below in cut)
        assert "".join(piece for piece, _ in cut) == r"photo_12 \_ a_{b}"

    @pytest.mark.long
    def test_a_title_that_does_not_print_is_shown_with_escapes(self, tmp_path):
        title = "Main \x1b[31m and \u202e4th\x00 \ud800"
        drawing = scene_drawing(sample(1), title=title)
        canvas.save(drawing, str(tmp_path / "x.svg"))
        shown = ElementTree.parse(tmp_path / "x.svg").getroot()[0].text
        assert shown == r"Main \x1b[31m and \u202e4th\x00 \ud800"
        for ending in ("png", "pdf"):
            canvas.save(drawing, str(tmp_path / f"x.{ending}"))


EXTREME = {
    "tiny": {"MA": "4E-3", "IA": "4E-8", "DA": "5E-3", "DB": "0", "UX": "-1E-4", "VX": "6E-5"},
    "huge": {"MA": "3E12", "IA": "1E18", "MB": "5E13", "IB": "2E19", "DA": "650", "DB": "800"},
    "fast": {"UX": "-35000", "VX": "12500", "VY": "-1234.5"},
}


class TestExtremes:
    """Numbers with exponents: every text on the page and apart."""

    @pytest.mark.parametrize("name", EXTREME)
    def test_every_text_is_apart_and_on_the_page(self, name):
        scene = sample(1).replaced(EXTREME[name])
        drawing = scene_drawing(scene, solve_scene(scene))
        assert overlaps(drawing) == []
        assert off_page(drawing) == []
