// The table of robots: links, chains, where they are and how they move.

#include "interp/builtin/robots.h"

#define ROBOTS CAG_TAKES(ROBOT)

static const char links[] = "Robots: links";
static const char motion[] = "Robots: forward kinematics";
static const char rates[] = "Robots: velocities and forces";
static const char ranges[] = "Robots: limits and motors";
static const char inverse[] = "Robots: inverse kinematics";
static const char paths[] = "Robots: paths";
static const char drawing[] = "Robots: drawing";

// Two links of 300 and 200 mm in the plane, for the examples.
#define PLANAR                                                                                     \
  "arm = robot([revolute(a: 300), revolute(a: 200, limits: -150deg..150deg)], name: \"arm\")\n"

const CagBuiltin cag_builtins_robots[] = {
    {"revolute(d: length = 0, a: length = 0, alpha: angle = 0deg, offset: angle = 0deg, "
     "limits: range of angles = -180deg..180deg, home: angle or length = 0deg, "
     "shape: shape = none, speed: angle or length each second = none, "
     "effort: torque (N m) or force (N) = none, lead: length = 0)",
     cag_robots_revolute, "link",
     "A link that turns: a row of a Denavit-Hartenberg table whose theta is the joint's value plus "
     "the offset. The shape is drawn in the frame after the link. speed is the fastest rate (an "
     "angle, each second), effort the greatest torque (N m), lead how far a screw slides in a turn "
     "(mm). Limits are finite, home lies within them.",
     "print revolute(a: 300, alpha: 90deg).limits // expect: -180deg..180deg", 0, links},
    {"prismatic(theta: angle = 0deg, a: length = 0, alpha: angle = 0deg, "
     "offset: length = 0, limits: range of lengths = none, "
     "home: angle or length = limits.start, shape: shape = none, "
     "speed: angle or length each second = none, effort: torque (N m) or force (N) = none)",
     cag_robots_prismatic, "link",
     "A link that slides along its axis: d is the joint's value (mm) plus the offset. The limits, "
     "its travel, are always written. speed is in mm each second, effort in N.",
     "print prismatic(limits: 50..300).home // expect: 50", 0, links},
    {"fixed_link(T: transform, shape: shape = none)", cag_robots_fixed_link, "link",
     "A link without a joint: a motion from the frame before it to the one after. It is counted "
     "among the links, and has no value in q.",
     "arm = robot([fixed_link(translate(100 * Z)), revolute(a: 300)])\n"
     "print position(fk(arm, [0deg])) // expect: [300, 0, 100]",
     CAG_TAKES(TRANSFORM), links},
    {"robot(links: list of links, name: text = \"\", convention: \"dh\" or \"mdh\" = \"dh\", "
     "base: transform = identity, tool: transform = identity, "
     "coupling: list of rows of numbers or record {matrix, offset} = none)",
     cag_robots_robot, "robot",
     "A chain of links from its base to its tool; \"mdh\" reads the rows as modified "
     "Denavit-Hartenberg ones. coupling is the matrix from joints to motors, or a record of "
     "`matrix` and `offset` (in degrees and mm). Members: joints (how many), limits, home, name, "
     "links, base, tool, convention.",
     PLANAR "print arm // expect: robot arm, 2 joints (RR)\n"
            "print arm.home // expect: [0deg, 0deg]",
     CAG_TAKES(LIST), links},

    {"fk(robot: robot, q: list of joint values, link: integer = none, from: integer = none, "
     "limits: bool = true)",
     cag_robots_fk, "transform",
     "The pose of the tool for the joint values q: angles where a joint turns, mm where it slides. "
     "`link: i` asks for the frame after link i (0 is the base), `from: j` sees it from that of "
     "link j. Values outside of the limits are an error that names the joint, unless `limits: "
     "false`.",
     PLANAR "print position(fk(arm, [90deg, -90deg])) // expect: [200, 300, 0]\n"
            "print position(fk(arm, [90deg, -90deg], link: 1)) // expect: [0, 300, 0]",
     ROBOTS, motion},
    {"link_frames(robot: robot, q: list of joint values, limits: bool = true)",
     cag_robots_link_frames, "list",
     "The frames of the chain in the world: the base, then the one after each link.",
     PLANAR "print [for t in link_frames(arm, [0deg, 90deg]): position(t)] "
            "// expect: [[0, 0, 0], [300, 0, 0], [300, 200, 0]]",
     ROBOTS, motion},
    {"skeleton(robot: robot, q: list of joint values = home, limits: bool = true)",
     cag_robots_skeleton, "list",
     "The points of the chain's stick figure: the origin of the base, for each link the foot of "
     "its common normal and its origin, and the tool's where there is a tool.",
     PLANAR "print skeleton(arm) // expect: [[0, 0, 0], [0, 0, 0], [300, 0, 0], [300, 0, 0], "
            "[500, 0, 0]]",
     ROBOTS, motion},
    {"joint_axes(robot: robot, q: list of joint values = home, limits: bool = true)",
     cag_robots_joint_axes, "list",
     "The axis of each joint in the world: records of kind, point and direction.",
     PLANAR "print joint_axes(arm)[1].point // expect: [300, 0, 0]", ROBOTS, motion},
    {"dh_table(robot: robot)", cag_robots_dh_table, "list",
     "The links as records: kind, theta, d, a, alpha (of a turning joint theta, of a sliding one d "
     "is the offset), limits, and the transform of a fixed link.",
     PLANAR "print dh_table(arm)[0].a // expect: 300", ROBOTS, motion},

    {"jacobian(robot: robot, q: list of joint values, frame: \"base\" or \"tool\" = \"base\", "
     "limits: bool = true)",
     cag_robots_jacobian, "list",
     "6 rows of a number for each joint: velocity of the tool's origin (mm) and angular velocity "
     "(radians) for each unit (radian, mm) of the joint's rate, in the axes of the world or of the "
     "tool (frame \"tool\").",
     PLANAR "print jacobian(arm, [0deg, 0deg])[1] // expect: [500, 200]", ROBOTS, rates},
    {"manipulability(robot: robot, q: list of joint values, limits: bool = true)",
     cag_robots_manipulability, "number",
     "Yoshikawa's measure, the root of det(J J'), of fewer than 6 joints of det(J' J): 0 at "
     "singular places.",
     PLANAR "print manipulability(arm, [0deg, 90deg]) > 0 // expect: true", ROBOTS, rates},
    {"is_singular(robot: robot, q: list of joint values, limits: bool = true)",
     cag_robots_is_singular, "bool",
     "Whether the tool cannot move in a direction in which it usually can: the Jacobian's rank, "
     "with lengths measured by the robot's reach, is less than the number of joints or than 6.",
     "arm = robot([revolute(alpha: 90deg), revolute(alpha: -90deg), revolute(d: 100)])\n"
     "print is_singular(arm, [0deg, 0deg, 0deg]), is_singular(arm, [0deg, 90deg, 0deg]) "
     "// expect: true false",
     ROBOTS, rates},
    {"jacobian_rank(robot: robot, q: list of joint values, limits: bool = true)",
     cag_robots_jacobian_rank, "number",
     "In how many independent ways the tool can move: the singular values above 1e-9 of the "
     "largest. The number of joints less the rank is the freedom to spare.",
     PLANAR "print jacobian_rank(arm, [0deg, 90deg]) // expect: 2", ROBOTS, rates},
    {"velocity(robot: robot, q: list of joint values, dq: list of joint values, "
     "frame: \"base\" or \"tool\" = \"base\", limits: bool = true)",
     cag_robots_velocity, "list",
     "J dq, [vx, vy, vz, wx, wy, wz]: mm and radians each second when dq has angles and mm each "
     "second.",
     PLANAR "print velocity(arm, [0deg, 0deg], [1rad, 0rad]) // expect: [0, 500, 0, 0, 0, 1]",
     ROBOTS, rates},
    {"torques(robot: robot, q: list of joint values, wrench: list of 6 numbers, "
     "frame: \"base\" or \"tool\" = \"base\", limits: bool = true)",
     cag_robots_torques, "list",
     "J' w: what the joints give for the wrench [fx, fy, fz, mx, my, mz] that the tool exerts: N "
     "and N mm from N and N mm.",
     PLANAR "print torques(arm, [0deg, 0deg], [0, 10, 0, 0, 0, 0]) // expect: [5000, 2000]", ROBOTS,
     rates},
    {"null_motion(robot: robot, q: list of joint values, dq: list of joint values, "
     "limits: bool = true)",
     cag_robots_null_motion, "list",
     "The part of the joint rates dq that leaves the tool where it is: zeros unless the chain has "
     "freedom to spare.",
     "arm = robot([prismatic(limits: 0..10), prismatic(limits: 0..10)])\n"
     "print null_motion(arm, [5, 5], [2, 0]) // expect: [1, -1]",
     ROBOTS, rates},

    {"violations(robot: robot, q: list of joint values)", cag_robots_violations, "list",
     "The joints that are outside of their limits: records of joint (from 1), value, limit (the "
     "one passed) and by. Empty within the limits.",
     PLANAR "print violations(arm, [0deg, 170deg]) // expect: [{joint: 2, value: 170deg, limit: "
            "150deg, by: 20deg}]",
     ROBOTS, ranges},
    {"motor_values(robot: robot, q: list of joint values, change: bool = false)",
     cag_robots_motor_values, "list",
     "Where the motors stand for joint values: the coupling's matrix times q, and its offset; "
     "`change: true` leaves the offset away, for differences. Without a coupling q itself.",
     "arm = robot([revolute(a: 3), revolute(a: 2)], coupling: {matrix: [[1, 0], [1, 1]], offset: "
     "[0deg, 90deg]})\n"
     "print motor_values(arm, [10deg, 20deg]) // expect: [10deg, 120deg]",
     ROBOTS, ranges},
    {"joint_values(robot: robot, motors: list of joint values, change: bool = false)",
     cag_robots_joint_values, "list",
     "The joint values for the motors' ones: the inverse of motor_values.",
     "arm = robot([revolute(a: 3), revolute(a: 2)], coupling: [[1, 0], [1, 1]])\n"
     "print joint_values(arm, [10deg, 30deg]) // expect: [10deg, 20deg]",
     ROBOTS, ranges},

    {"ik(robot: robot, T: transform or point, near: list of joint values = home, "
     "config: record = none, tolerance: finite number = 1e-6)",
     cag_robots_ik, "list",
     "Joint values within the limits that bring the tool to the pose T, to the tolerance (mm and "
     "radians): of several the nearest to `near`, or those of a branch by `config` (a record of "
     "shoulder, elbow, wrist: 1 or -1). By closed form where the arm has one, else by damped least "
     "squares; freedom to spare goes into being near. A point as T leaves the tool's rotation "
     "free. Unreachable: an error that tells how far the closest pose is.",
     PLANAR "q = ik(arm, [300, 200, 0], near: [0deg, 80deg])\n"
            "print distance(position(fk(arm, q)), [300, 200, 0]) < 1e-9 // expect: true",
     ROBOTS, inverse},
    {"reachable(robot: robot, T: transform or point, tolerance: finite number = 1e-6)",
     cag_robots_reachable, "bool",
     "Whether joint values within the limits bring the tool to a pose, or a point.",
     PLANAR "print reachable(arm, [300, 200, 0]), reachable(arm, [300, 500, 0]) // expect: true "
            "false",
     ROBOTS, inverse},
    {"closest_pose(robot: robot, T: transform or point, near: list of joint values = home)",
     cag_robots_closest_pose, "record",
     "What comes closest to a pose or point, reachable or not: q, pose, distance (mm) and angle "
     "(none for a point).",
     PLANAR "print near(closest_pose(arm, [600, 0, 0]).distance, 100) // expect: true", ROBOTS,
     inverse},

    {"workspace(robot: robot, n: integer = 2000)", cag_robots_workspace, "record",
     "What the robot reaches: points (the tool at n places that fill the joint limits), hull "
     "(their "
     "convex hull, a mesh or region) and cloud (the points as a mesh of dots) to show, bounds. Of "
     "classical arms (kind \"cartesian\" \"cylindrical\" \"spherical\" \"spherical-offset\" "
     "\"planar\" \"scara\" \"articulated\") by formula center, r_min, r_max, hole (no point is "
     "nearer to the first axis; r is then the root of |p - center|^2 - hole^2), and volume "
     "(planar: "
     "the area; none where the limits cut the region): of the tool, or of the wrist's center.",
     "w = workspace(robot([revolute(a: 300), revolute(a: 200)]), 100)\n"
     "print w.kind, near(w.r_min, 100), near(w.volume, 4 * pi * 300 * 200) // expect: planar true "
     "true",
     ROBOTS, inverse},
    {"dh_assign(axes: list of records {kind, point, direction}, end: record {point, "
     "direction}, base: transform = none)",
     cag_robots_dh_assign, "record",
     "Denavit-Hartenberg frames for joint axes, records of kind, point and direction at the zero "
     "positions: `table` (records of kind, theta, d, a, alpha) and `frames`. `end` is the point "
     "and direction of the last frame; the base's z axis is the first joint's (none: a frame at "
     "its point). x(i) runs along the common normal, of axes that meet along the product of their "
     "directions.",
     "axes = [{point: [0, 0, 0], direction: Z}, {point: [300, 0, 0], direction: Z}]\n"
     "r = dh_assign(axes, {point: [500, 0, 0], direction: Z})\n"
     "print [for row in r.table: row.a] // expect: [300, 200]",
     CAG_TAKES_LISTS, links},

    {"joint_path(robot: robot, q: list of joint values, to: list of joint values, "
     "n: integer)",
     cag_robots_joint_path, "list",
     "n places from q to another, both in, the joints moving evenly.",
     PLANAR "print joint_path(arm, [0deg, 0deg], [90deg, 30deg], 4)[1] // expect: [30deg, 10deg]",
     ROBOTS, paths},
    {"line_path(robot: robot, T: transform or point, to: transform or point, n: integer, "
     "near: list of joint values = home, cross: bool = false)",
     cag_robots_line_path, "list",
     "n places whose poses lie evenly on the straight way between two poses, both in; the joints "
     "never change the branch. The step where the way leaves the workspace (path-leaves), where "
     "the joints would jump (path-jumps) or where it meets or crosses a singular place "
     "(path-singular; `cross: true` lets it) is named by the error. Two points leave the tool's "
     "rotation free.",
     "arm = robot([revolute(a: 300), revolute(a: 200), revolute()])\n"
     "qs = line_path(arm, translate([300, 100, 0]), translate([100, 300, 0]), 3, near: [0deg, "
     "90deg, 0deg])\n"
     "print near(distance(position(fk(arm, qs[1])), [200, 200, 0]), 0) // expect: true",
     ROBOTS, paths},
    {"follow(robot: robot, poses: list of transforms or points, "
     "near: list of joint values = home, jumps: bool = false)",
     cag_robots_follow, "list",
     "The place of the joints for each pose, always reached from the one before without a change "
     "of branch; `jumps: true` lets the joints go to another branch where there is no other way. "
     "A pose out of reach is an error that names it. Points leave the tool's rotation free.",
     "arm = robot([revolute(a: 300), revolute(a: 200), revolute()])\n"
     "print len(follow(arm, [for x in [350, 300, 250]: translate([x, 100, 0])])) // expect: 3",
     ROBOTS, paths},

    {"posed(robot: robot, q: list of joint values = home, holding: shape = none, "
     "limits: bool = true)",
     cag_robots_posed, "group",
     "The robot to look at: the shape of each link in the frame after it, and what it is holding, "
     "given in the tool's frame. A robot without any shapes is drawn of plain rods and drums.",
     "arm = robot([revolute(a: 100, shape: translate(box([100, 10, 10]), [-100, 0, 0]))])\n"
     "print near(bounds(posed(arm, [90deg])).size, [10, 100, 10]) // expect: true",
     ROBOTS, drawing},
    {0}};
