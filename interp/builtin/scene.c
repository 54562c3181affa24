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
     "A camera at `eye` that looks at `target`. `fov` is the horizontal angle of view; an "
     "\"orthographic\" one sees `width` mm (none: what it would see at the target). `size` is in "
     "pixels. With an `aperture` (mm, the diameter of the lens) only what is at the distance "
     "`focus` (mm; "
     "none: the target) is sharp; a point at the distance z is as wide as a disc of aperture "
     "|z - focus| / z there; an orthographic camera shows everything sharp. A camera that is "
     "reflected gives the mirrored picture. When the view "
     "is along `up`, Y is up. One point as eye and target is an error.",
     "print camera([100, -200, 80]).fov // expect: 40deg", LISTS, stage},
    {"sun(direction: vector, color: color = \"white\", strength: number = 1)", cag_scenes_sun,
     "light",
     "Parallel light that goes along `direction`. With strength 1 a white matte face perpendicular "
     "to it "
     "looks white.",
     "print sun([1, 1, -2]).direction // expect: [1, 1, -2]", LISTS, stage},
    {"point_light(position: point, color: color = \"white\", strength: number = 1)",
     cag_scenes_point_light, "light", "Light from a point to all sides.",
     "print point_light([0, 0, 100], strength: 0.5).strength // expect: 0.5", LISTS, stage},
    {"spot_light(position: point, target: point, angle: angle = 30deg, "
     "color: color = \"white\", strength: number = 1)",
     cag_scenes_spot_light, "light", "A cone of light of this full angle, from a point to another.",
     "print spot_light([0, 0, 100], origin).angle // expect: 30deg", LISTS, stage},
    {"area_light(position: point, target: point, size: length, color: color = \"white\", "
     "strength: number = 1)",
     cag_scenes_area_light, "light",
     "A shining square of this side (mm) that faces the target; its shadows are soft.",
     "print area_light([0, 0, 100], origin, 50).size // expect: 50", LISTS, stage},
    {"sky(colors: color or list of colors or path of an .exr)", cag_scenes_sky, "setting",
     "The light from all around: a color, a list of colors from below to above, or an .exr "
     "panorama. A scene with a sky gets no studio light.",
     "print type_of(sky([\"gray\", \"white\", \"skyblue\"])) // expect: setting",
     CAG_TAKES(TEXT) | LISTS, stage},
    {"background(color: color)", cag_scenes_background, "setting",
     "The color behind everything; it gives no light.",
     "print background([0, 0, 0]).color // expect: [0, 0, 0]", CAG_TAKES(TEXT) | LISTS, stage},
    {"ground(z: length = 0, size: length = inf)", cag_scenes_ground, "setting",
     "A level floor at the height z, endless or a square of this side (mm). It takes a material or "
     "color, and cameras that frame everything do not look at it.",
     "print ground(z: -5).z // expect: -5", CAG_TAKES(NUMBER), stage},

    {"material(G: shape or group, m: material record)", cag_scenes_material, "as G",
     "G with a material: a record of color, metallic, roughness, coat and transmission (0..1), "
     "ior, "
     "emission, texture (\"wood\", \"marble\", \"concrete\", \"clay\"), color2, texture_scale "
     "(mm), "
     "pov, name, density and reflectivity, all of which may be left out; `std.materials` has ready "
     "ones. density (kg/m^3) is that of bodies in URDF files. reflectivity is a share of light "
     "that "
     "scripts may read again, as for a sensor of their own; pictures and exports do not use it: "
     "what "
     "is seen of mirrors is metallic, roughness, ior and coat. A material said nearer to the shape "
     "holds. An unknown field is an error that offers the nearest.",
     "show sphere(10) |> material({color: \"teal\", roughness: 0.2})", SHAPES | CAG_TAKES(SETTING),
     said},
    {"color(G: shape or group, color: color)", cag_scenes_color, "as G",
     "G in a color: a CSS name, \"#0a8\", \"#00aa88\", or [r, g, b] in linear light, 0..1. A "
     "color "
     "said nearer to the shape holds; with a material said later it keeps this color.",
     "show sphere(10) |> color(\"teal\")", SHAPES | CAG_TAKES(SETTING), said},
    {"named(G: shape or group, name: text)", cag_scenes_named, "as G",
     "G with a name, for exports, messages and `--camera`. A name said nearer to the shape holds.",
     "show sphere(10) |> named(\"ball\")", SHAPES | STAGE, said},
    {"tolerance(G: shape or group, t: length)", cag_scenes_tolerance, "as G",
     "G with its own largest distance (mm) between mesh and true surface. Volume, area, centroid "
     "and "
     "inertia of set operations are those of that mesh.",
     "show sphere(10) |> tolerance(0.01)", SHAPES, said},
    {"hidden(G: shape or group)", cag_scenes_hidden, "as G", "G, not shown.",
     "show sphere(10) |> hidden", SHAPES, said},
    {"group(G: shape or group, ...)", cag_scenes_group, "group",
     "Shapes, groups and lists of these as one shape: it is moved, colored and shown as a whole.",
     "g = group(sphere(1), translate(box(1), [3, 0, 0]))\n"
     "print bounds(g).max.x // expect: 4",
     SHAPES, said},
    {"line_style(C: curve or group, radius: length = none, dash: length = none)",
     cag_scenes_line_style, "as C",
     "How curves are drawn: as tubes of this radius (mm; none: by the size of the scene), in "
     "dashes "
     "of this length (mm; none: whole).",
     "show circle(10) |> line_style(radius: 0.2, dash: 2)", SHAPES, said},
    {0}};
