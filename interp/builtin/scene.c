// The table of the scene: cameras, lights, surroundings, and what is said about shapes.

#include "interp/builtin/scene.h"

#define LISTS CAG_TAKES_LISTS
#define SHAPES (CAG_TAKES_SHAPES | CAG_TAKES(LIST))
#define STAGE (CAG_TAKES(CAMERA) | CAG_TAKES(LIGHT) | CAG_TAKES(SETTING))

static const char stage[] = "Scene";
static const char said[] = "Appearance and names";

const CagBuiltin cag_builtins_scene[] = {
    {"camera(eye: point, target: point = origin, up: vector = Z, fov: angle = 40deg, "
     "kind: \"perspective\" or \"orthographic\" = \"perspective\", width: length = none, "
     "size: list [width, height] = [1280, 720], focus: length = none, aperture: length = 0)",
     cag_scenes_camera, "camera",
     "Returns a camera at `eye` that looks at `target`. `fov` is the horizontal angle of view. "
     "An \"orthographic\" camera sees `width` mm (none: what a perspective one sees at the "
     "target). `size` is in pixels. With an `aperture` (the diameter of the lens, mm), only "
     "objects at the distance `focus` (mm; none: the target) are sharp; a point at distance z is "
     "blurred to a disk of diameter aperture |z - focus| / z there. An orthographic camera shows "
     "everything sharp. A reflected camera gives the mirrored picture. If the view is along "
     "`up`, Y is up. It is an error if eye equals target.",
     "print camera([100, -200, 80]).fov // expect: 40deg", LISTS, stage},
    {"sun(direction: vector, color: color = \"white\", strength: number = 1)", cag_scenes_sun,
     "light",
     "Returns parallel light in this direction. With strength 1, a white matte face "
     "perpendicular to it looks white.",
     "print sun([1, 1, -2]).direction // expect: [1, 1, -2]", LISTS, stage},
    {"point_light(position: point, color: color = \"white\", strength: number = 1)",
     cag_scenes_point_light, "light", "Returns light from a point in all directions.",
     "print point_light([0, 0, 100], strength: 0.5).strength // expect: 0.5", LISTS, stage},
    {"spot_light(position: point, target: point, angle: angle = 30deg, "
     "color: color = \"white\", strength: number = 1)",
     cag_scenes_spot_light, "light",
     "Returns a cone of light with this full angle, from a point to another.",
     "print spot_light([0, 0, 100], origin).angle // expect: 30deg", LISTS, stage},
    {"area_light(position: point, target: point, size: length, color: color = \"white\", "
     "strength: number = 1)",
     cag_scenes_area_light, "light",
     "Returns a luminous square with this side (mm) that faces the target. Its shadows are soft.",
     "print area_light([0, 0, 100], origin, 50).size // expect: 50", LISTS, stage},
    {"sky(colors: color or list of colors or path of an .exr)", cag_scenes_sky, "setting",
     "Returns light from all around: a color, a list of colors from bottom to top, or an .exr "
     "panorama. A scene with a sky has no studio light.",
     "print type_of(sky([\"gray\", \"white\", \"skyblue\"])) // expect: setting",
     CAG_TAKES(TEXT) | LISTS, stage},
    {"background(color: color)", cag_scenes_background, "setting",
     "Returns the background color. It emits no light.",
     "print background([0, 0, 0]).color // expect: [0, 0, 0]", CAG_TAKES(TEXT) | LISTS, stage},
    {"ground(z: length = 0, size: length = inf)", cag_scenes_ground, "setting",
     "Returns a horizontal floor at height z, unbounded or a square with this side (mm). It can "
     "have a material or color. Cameras that frame everything ignore it.",
     "print ground(z: -5).z // expect: -5", CAG_TAKES(NUMBER), stage},

    {"material(G: shape or group, m: material record)", cag_scenes_material, "as G",
     "Gives G a material: a record of color, metallic, roughness, coat, and transmission (0..1), "
     "ior, emission, texture (\"wood\", \"marble\", \"concrete\", \"clay\"), color2, texture_scale (mm), "
     "pov, name, density, and reflectivity, all optional. std.materials has ready-made ones. "
     "density (kg/m^3) is used for bodies in URDF files. reflectivity is for scripts to read, "
     "for example for simulated sensors; pictures and exports do not use it. A material given "
     "closer to the shape takes precedence. An unknown field is an error that suggests the "
     "nearest one.",
     "show sphere(10) |> material({color: \"teal\", roughness: 0.2})", SHAPES | CAG_TAKES(SETTING),
     said},
    {"color(G: shape or group, color: color)", cag_scenes_color, "as G",
     "Gives G a color: a CSS name, \"#0a8\", \"#00aa88\", or [r, g, b] in linear light, 0..1. A "
     "color given closer to the shape takes precedence, also over a material given later.",
     "show sphere(10) |> color(\"teal\")", SHAPES | CAG_TAKES(SETTING), said},
    {"named(G: shape or group, name: text)", cag_scenes_named, "as G",
     "Gives G a name, for exports, messages, and `--camera`. A name given closer to the shape "
     "takes precedence.",
     "show sphere(10) |> named(\"ball\")", SHAPES | STAGE, said},
    {"tolerance(G: shape or group, t: length)", cag_scenes_tolerance, "as G",
     "Gives G its own largest distance (mm) between mesh and true surface. Volume, area, "
     "centroid, and inertia of set operations are those of the mesh.",
     "show sphere(10) |> tolerance(0.01)", SHAPES, said},
    {"hidden(G: shape or group)", cag_scenes_hidden, "as G", "Returns G, but does not show it.",
     "show sphere(10) |> hidden", SHAPES, said},
    {"group(G: shape or group, ...)", cag_scenes_group, "group",
     "Combines shapes, groups, and lists of these to one shape, which is moved, colored, and "
     "shown as a whole.",
     "g = group(sphere(1), translate(box(1), [3, 0, 0]))\n"
     "print bounds(g).max.x // expect: 4",
     SHAPES, said},
    {"line_style(C: curve or group, radius: length = none, dash: length = none)",
     cag_scenes_line_style, "as C",
     "Sets how curves are drawn: as tubes with this radius (mm; none: by the size of the scene), "
     "and in dashes of this length (mm; none: solid).",
     "show circle(10) |> line_style(radius: 0.2, dash: 2)", SHAPES, said},
    {0}};
