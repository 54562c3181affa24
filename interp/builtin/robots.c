// The table of robots: links, chains, where they are and how they move.

#include "interp/builtin/robots.h"

#define ROBOTS CAG_TAKES(ROBOT)

static const char links[] = "Robots: links";
static const char motion[] = "Robots: forward kinematics";

// Two links of 300 and 200 mm in the plane, for the examples.
#define PLANAR                                                                                     \
  "arm = robot([revolute(a: 300), revolute(a: 200, limits: -150deg..150deg)], name: \"arm\")\n"

const CagBuiltin cag_builtins_robots[] = {
    {"revolute(d = 0, a = 0, alpha = 0deg, offset = 0deg, limits = -180deg..180deg, home = 0deg, "
     "shape = none, speed = none, effort = none, lead = 0)",
     cag_robots_revolute, "link",
     "A link that turns: a row of a Denavit-Hartenberg table whose theta is the joint's value plus "
     "the offset. The shape is drawn in the frame after the link. speed is the fastest rate (an "
     "angle, each second), effort the greatest torque (N m), lead how far a screw slides in a turn "
     "(mm). Limits are finite, home lies within them.",
     "print revolute(a: 300, alpha: 90deg).limits // expect: -180deg..180deg", 0, links},
    {"prismatic(theta = 0deg, a = 0, alpha = 0deg, offset = 0, limits = none, home = limits.start, "
     "shape = none, speed = none, effort = none)",
     cag_robots_prismatic, "link",
     "A link that slides along its axis: d is the joint's value (mm) plus the offset. The limits, "
     "its travel, are always written. speed is in mm each second, effort in N.",
     "print prismatic(limits: 50..300).home // expect: 50", 0, links},
    {"fixed_link(T, shape = none)", cag_robots_fixed_link, "link",
     "A link without a joint: a motion from the frame before it to the one after. It is counted "
     "among the links, and has no value in q.",
     "arm = robot([fixed_link(translate(100 * Z)), revolute(a: 300)])\n"
     "print position(fk(arm, [0deg])) // expect: [300, 0, 100]",
     CAG_TAKES(TRANSFORM), links},
    {"robot(links, name = \"\", convention = \"dh\", base = identity, tool = identity, "
     "coupling = none)",
     cag_robots_robot, "robot",
     "A chain of links from its base to its tool; \"mdh\" reads the rows as modified "
     "Denavit-Hartenberg ones. coupling is the matrix from joints to motors, or a record of "
     "`matrix` and `offset` (in degrees and mm). Members: joints (how many), limits, home, name, "
     "links, base, tool, convention.",
     PLANAR "print arm // expect: robot arm, 2 joints (RR)\n"
            "print arm.home // expect: [0deg, 0deg]",
     CAG_TAKES(LIST), links},

    {"fk(robot, q, link = none, from = none, limits = true)", cag_robots_fk, "transform",
     "The pose of the tool for the joint values q: angles where a joint turns, mm where it slides. "
     "`link: i` asks for the frame after link i (0 is the base), `from: j` sees it from that of "
     "link j. Values outside of the limits are an error that names the joint, unless `limits: "
     "false`.",
     PLANAR "print position(fk(arm, [90deg, -90deg])) // expect: [200, 300, 0]\n"
            "print position(fk(arm, [90deg, -90deg], link: 1)) // expect: [0, 300, 0]",
     ROBOTS, motion},
    {"link_frames(robot, q, limits = true)", cag_robots_link_frames, "list",
     "The frames of the chain in the world: the base, then the one after each link.",
     PLANAR "print [for t in link_frames(arm, [0deg, 90deg]): position(t)] "
            "// expect: [[0, 0, 0], [300, 0, 0], [300, 200, 0]]",
     ROBOTS, motion},
    {0}};
