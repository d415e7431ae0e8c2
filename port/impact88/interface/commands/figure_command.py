"""kinds:
  scene            from above: vehicles, contact plane, velocities, impulse
  barrier          one vehicle against a barrier; FILE.toml as chapter barrier's
  staged           Figure 5: staged collisions, calculated and measured delta-V
  force            Figure 1: force between vehicles and its impulse
  colinear         Figure 2: free bodies, direct colinear impact
  planar           Figure 3: free bodies, planar impact, of any scene
  configurations   Figure 4: the staged collisions' configurations

The ending of FILE says how it is written: .svg, .png or .pdf; one column (85 mm) wide, or --width.
.png and .pdf take pip install 'impact88[plot]'. Vehicles are drawn as measured where the file gives
LA BA, LB BB.

examples:
  impact88 figure scene --sample 1 -o scene.svg
  impact88 figure scene crash.toml --set MU=-10 -o pivot.pdf
  impact88 figure barrier car.toml -o barrier.svg
  impact88 figure staged -o figure5.pdf
"""

from typing import Any

from ...casework.figures.canvas import check_ending, save
from ...casework.figures.drawing import Drawing
from ...casework.figures.sceneview import scene_drawing
from ...collision.casescene import Scene
from ...collision.doubles import double
from ...collision.needs import needs_sentences
from ...errors import UserError, note
from ...mechanics.closedform.columns import OPTIONAL_OF_POINTS
from ...mechanics.closedform.solve import solve
from ...names import FINAL_VELOCITIES, missing
from . import options

OF_NOTHING = ("staged", "force", "colinear", "configurations")
KINDS = ("scene", "barrier", "planar", *OF_NOTHING)

ARGUMENTS = (
    options.value("kind", "KIND", "see kinds below", choices=KINDS),
    options.writes("-o --output", "FILE", "where to write: .svg, .png or .pdf", required=True),
    *options.ONE_SCENE,
    options.setting("change a value of the scene"),
    options.MOVE,
    options.count(
        "--width",
        40,
        3000,
        "how wide it is written, such as 900 for an exhibit board (default: 85)",
        metavar="MM",
    ),
)


def main(args: options.Args) -> None:
    check_ending(args.output)
    picture = _draw(args)
    if args.width:
        picture.enlarged = args.width / picture.width
    save(picture, args.output)


def _draw(args: options.Args) -> Drawing:
    kind, scene_source = args.kind, args.scene or args.sample or args.set
    if kind in OF_NOTHING:
        if scene_source:
            raise UserError(f"{kind} is drawn from the chapter alone and takes no scene")
        return _of_nothing(kind)
    if kind == "barrier":
        return _barrier(args)
    if kind == "planar":
        from ...casework.figures.views import planar

        return planar(options.one_scene(args) if scene_source else None)
    may_omit = OPTIONAL_OF_POINTS if options.case_given(args).of_points else ()
    scene = options.one_scene(args, may_omit)
    return scene_drawing(scene, solve_scene(scene), title=scene.title or "Scene from above")


def _of_nothing(kind: str) -> Drawing:
    """A figure of the chapter, which takes no scene."""
    from ...casework.figures import charts, views

    return {
        "staged": charts.figure_5,
        "force": charts.force_and_impulse,
        "colinear": views.colinear,
        "configurations": views.configurations,
    }[kind]()


def _barrier(args: options.Args) -> Drawing:
    """A vehicle against a barrier, its approach and its rebound."""
    from ...casework.chapter.barrier import BARRIER, VEHICLE, barrier

    names = (*VEHICLE, "M")
    case = options.known_case(args, names, single=True)
    values = {name: item.nominal for name, item in options.read_known(case, names).items()}
    if absent := [name for name in VEHICLE if name not in values]:
        raise UserError(missing(absent), args.scene)
    outcome = barrier(values, ("VAX", "VAY", "WAF", "STATUS"))
    result = {name: value.item() for name, value in outcome.items()}
    # as heavy as a drawing needs it: an infinite mass has no outline
    wall = {"MB": 1e9 * values["MA"], "IB": 1e9 * values["IA"]}
    return scene_drawing(
        {**BARRIER, **values, **wall},
        {**result, "VBX": 0.0, "VBY": 0.0, "WBF": 0.0},
        title="Barrier",
        units=case.system,
        outlines=case.outlines,
    )


def solve_scene(scene: Scene) -> dict[str, Any]:
    """The results of one scene as numbers, for a drawing."""
    numbers = {name: double(text) for name, text in scene.given.items()}
    results = solve(numbers, (*FINAL_VELOCITIES, "STATUS"))
    for sentence in needs_sentences(getattr(results, "absent", {})):
        note("figure", sentence)
    return {name: value.item() for name, value in results.items()}
