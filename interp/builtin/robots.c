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
     "Returns a revolute joint with its link: a row of a Denavit-Hartenberg table in which theta "
     "is the joint's value plus the offset. The shape is drawn in the frame after the link. "
     "speed is the maximum rate (an angle per second), effort is the maximum torque (N m), and "
     "lead is the slide of a screw per turn (mm). The limits must be finite and contain home.",
     "print revolute(a: 300, alpha: 90deg).limits // expect: -180deg..180deg", 0, links},
    {"prismatic(theta: angle = 0deg, a: length = 0, alpha: angle = 0deg, "
     "offset: length = 0, limits: range of lengths = none, "
     "home: angle or length = limits.start, shape: shape = none, "
     "speed: angle or length each second = none, effort: torque (N m) or force (N) = none)",
     cag_robots_prismatic, "link",
     "Returns a prismatic joint with its link: d is the joint's value (mm) plus the offset. Its "
     "limits, the range of travel, are required. speed is in mm per second, and effort is in N.",
     "print prismatic(limits: 50..300).home // expect: 50", 0, links},
    {"fixed_link(T: transform, shape: shape = none)", cag_robots_fixed_link, "link",
     "Returns a link without a joint: a transform from the previous frame to the next. It counts "
     "as a link, but has no value in q.",
     "arm = robot([fixed_link(translate(100 * Z)), revolute(a: 300)])\n"
     "print position(fk(arm, [0deg])) // expect: [300, 0, 100]",
     CAG_TAKES(TRANSFORM), links},
    {"robot(links: list of links, name: text = \"\", convention: \"dh\" or \"mdh\" = \"dh\", "
     "base: transform = identity, tool: transform = identity, "
     "coupling: list of rows of numbers or record {matrix, offset} = none)",
     cag_robots_robot, "robot",
     "Returns a chain of links from its base to its tool. \"mdh\" interprets the rows as modified "
     "Denavit-Hartenberg parameters. coupling is the matrix from joints to motors, or a record "
     "of `matrix` and `offset` (in degrees and mm). Fields: joints (their number), limits, home, "
     "name, links, base, tool, convention.",
     PLANAR "print arm // expect: robot arm, 2 joints (RR)\n"
            "print arm.home // expect: [0deg, 0deg]",
     CAG_TAKES(LIST), links},

    {"fk(robot: robot, q: list of joint values, link: integer = none, from: integer = none, "
     "limits: bool = true)",
     cag_robots_fk, "transform",
     "Returns the pose of the tool for the joint values q: angles for revolute joints, and mm "
     "for prismatic ones. `link: i` returns the frame after link i (0 is the base), and `from: "
     "j` expresses it in the frame of link j. Values outside of the limits are an error that "
     "names the joint, unless `limits: false`.",
     PLANAR "print position(fk(arm, [90deg, -90deg])) // expect: [200, 300, 0]\n"
            "print position(fk(arm, [90deg, -90deg], link: 1)) // expect: [0, 300, 0]",
     ROBOTS, motion},
    {"link_frames(robot: robot, q: list of joint values, limits: bool = true)",
     cag_robots_link_frames, "list",
     "Returns the frames of the chain in the world: the base, then the frame after each link.",
     PLANAR "print [for t in link_frames(arm, [0deg, 90deg]): position(t)] "
            "// expect: [[0, 0, 0], [300, 0, 0], [300, 200, 0]]",
     ROBOTS, motion},
    {"skeleton(robot: robot, q: list of joint values = home, limits: bool = true)",
     cag_robots_skeleton, "list",
     "Returns the points of the stick figure of the chain: the origin of the base; for each "
     "link, the foot of its common normal and its origin; and the origin of the tool, if there "
     "is one.",
     PLANAR "print skeleton(arm) // expect: [[0, 0, 0], [0, 0, 0], [300, 0, 0], [300, 0, 0], "
            "[500, 0, 0]]",
     ROBOTS, motion},
    {"joint_axes(robot: robot, q: list of joint values = home, limits: bool = true)",
     cag_robots_joint_axes, "list",
     "Returns the axis of each joint in the world: records of kind, point, and direction.",
     PLANAR "print joint_axes(arm)[1].point // expect: [300, 0, 0]", ROBOTS, motion},
    {"dh_table(robot: robot)", cag_robots_dh_table, "list",
     "Returns the links as records: kind, theta, d, a, alpha (for a revolute joint, theta is the "
     "offset; for a prismatic joint, d), limits, and the transform of a fixed link.",
     PLANAR "print dh_table(arm)[0].a // expect: 300", ROBOTS, motion},

    {"jacobian(robot: robot, q: list of joint values, frame: \"base\" or \"tool\" = \"base\", "
     "limits: bool = true)",
     cag_robots_jacobian, "list",
     "Returns the 6 rows of the Jacobian, with one number for each joint: the velocity of the "
     "tool's origin (mm) and the angular velocity (radians) per unit (radian or mm) of the "
     "joint's rate, in the axes of the world, or of the tool (frame \"tool\").",
     PLANAR "print jacobian(arm, [0deg, 0deg])[1] // expect: [500, 200]", ROBOTS, rates},
    {"manipulability(robot: robot, q: list of joint values, limits: bool = true)",
     cag_robots_manipulability, "number",
     "Returns Yoshikawa's manipulability measure, the square root of det(J J'), or of det(J' J) "
     "for fewer than 6 joints. It is 0 in singular configurations.",
     PLANAR "print manipulability(arm, [0deg, 90deg]) > 0 // expect: true", ROBOTS, rates},
    {"is_singular(robot: robot, q: list of joint values, limits: bool = true)",
     cag_robots_is_singular, "bool",
     "Tests whether the configuration is singular: whether the rank of the Jacobian, with "
     "lengths relative to the robot's reach, is less than the number of joints or less than 6.",
     "arm = robot([revolute(alpha: 90deg), revolute(alpha: -90deg), revolute(d: 100)])\n"
     "print is_singular(arm, [0deg, 0deg, 0deg]), is_singular(arm, [0deg, 90deg, 0deg]) "
     "// expect: true false",
     ROBOTS, rates},
    {"jacobian_rank(robot: robot, q: list of joint values, limits: bool = true)",
     cag_robots_jacobian_rank, "number",
     "Returns the rank of the Jacobian, the number of singular values above 1e-9 of the largest. "
     "The number of joints minus the rank is the degree of redundancy.",
     PLANAR "print jacobian_rank(arm, [0deg, 90deg]) // expect: 2", ROBOTS, rates},
    {"velocity(robot: robot, q: list of joint values, dq: list of joint values, "
     "frame: \"base\" or \"tool\" = \"base\", limits: bool = true)",
     cag_robots_velocity, "list",
     "Returns the twist J dq, [vx, vy, vz, wx, wy, wz]: mm and radians per second if dq has "
     "angles and mm per second.",
     PLANAR "print velocity(arm, [0deg, 0deg], [1rad, 0rad]) // expect: [0, 500, 0, 0, 0, 1]",
     ROBOTS, rates},
    {"torques(robot: robot, q: list of joint values, wrench: list of 6 numbers, "
     "frame: \"base\" or \"tool\" = \"base\", limits: bool = true)",
     cag_robots_torques, "list",
     "Returns J' w, the joint torques and forces for the wrench [fx, fy, fz, mx, my, mz] that "
     "the tool exerts, in N and N mm.",
     PLANAR "print torques(arm, [0deg, 0deg], [0, 10, 0, 0, 0, 0]) // expect: [5000, 2000]", ROBOTS,
     rates},
    {"null_motion(robot: robot, q: list of joint values, dq: list of joint values, "
     "limits: bool = true)",
     cag_robots_null_motion, "list",
     "Returns the part of the joint rates dq that does not move the tool. It is zero unless the "
     "robot is redundant.",
     "arm = robot([prismatic(limits: 0..10), prismatic(limits: 0..10)])\n"
     "print null_motion(arm, [5, 5], [2, 0]) // expect: [1, -1]",
     ROBOTS, rates},

    {"violations(robot: robot, q: list of joint values)", cag_robots_violations, "list",
     "Returns the joints that are outside of their limits: records of joint (from 1), value, "
     "limit (the one exceeded), and by. The list is empty if all are within the limits.",
     PLANAR "print violations(arm, [0deg, 170deg]) // expect: [{joint: 2, value: 170deg, limit: "
            "150deg, by: 20deg}]",
     ROBOTS, ranges},
    {"motor_values(robot: robot, q: list of joint values, change: bool = false)",
     cag_robots_motor_values, "list",
     "Returns the motor values for joint values: the coupling matrix times q, plus its offset. "
     "`change: true` omits the offset, for differences. Without a coupling, returns q.",
     "arm = robot([revolute(a: 3), revolute(a: 2)], coupling: {matrix: [[1, 0], [1, 1]], offset: "
     "[0deg, 90deg]})\n"
     "print motor_values(arm, [10deg, 20deg]) // expect: [10deg, 120deg]",
     ROBOTS, ranges},
    {"joint_values(robot: robot, motors: list of joint values, change: bool = false)",
     cag_robots_joint_values, "list",
     "Returns the joint values for motor values, the inverse of motor_values.",
     "arm = robot([revolute(a: 3), revolute(a: 2)], coupling: [[1, 0], [1, 1]])\n"
     "print joint_values(arm, [10deg, 30deg]) // expect: [10deg, 20deg]",
     ROBOTS, ranges},

    {"ik(robot: robot, T: transform or point, near: list of joint values = home, "
     "config: record = none, tolerance: finite number = 1e-6)",
     cag_robots_ik, "list",
     "Returns joint values within the limits that bring the tool to the pose T, to within the "
     "tolerance (mm and radians). If there are several solutions, returns the one nearest to "
     "`near`, or the one of a branch by `config` (a record of shoulder, elbow, and wrist, each 1 "
     "or -1). Uses a closed form if the arm has one, otherwise damped least squares; redundancy "
     "is used to stay near. If T is a point, the orientation of the tool is free. It is an error "
     "if T is unreachable, which states how far the closest pose is.",
     PLANAR "q = ik(arm, [300, 200, 0], near: [0deg, 80deg])\n"
            "print distance(position(fk(arm, q)), [300, 200, 0]) < 1e-9 // expect: true",
     ROBOTS, inverse},
    {"reachable(robot: robot, T: transform or point, tolerance: finite number = 1e-6)",
     cag_robots_reachable, "bool",
     "Tests whether joint values within the limits bring the tool to a pose or point.",
     PLANAR "print reachable(arm, [300, 200, 0]), reachable(arm, [300, 500, 0]) // expect: true "
            "false",
     ROBOTS, inverse},
    {"closest_pose(robot: robot, T: transform or point, near: list of joint values = home)",
     cag_robots_closest_pose, "record",
     "Returns the configuration that comes closest to a pose or point, reachable or not: q, "
     "pose, distance (mm), and angle (none for a point).",
     PLANAR "print near(closest_pose(arm, [600, 0, 0]).distance, 100) // expect: true", ROBOTS,
     inverse},

    {"workspace(robot: robot, n: integer in 1..1000000 = 2000)", cag_robots_workspace, "record",
     "Returns the workspace of the robot: points (the tool at n configurations that fill the "
     "joint limits), hull (their convex hull, a mesh or region), cloud (the points as a mesh of "
     "dots), and bounds. For classical arms (kind \"cartesian\" \"cylindrical\" \"spherical\" "
     "\"spherical-offset\" \"planar\" \"scara\" \"articulated\"), also, by formula, center, r_min, "
     "r_max, hole (no point is nearer to the first axis; r is then the square root of |p - "
     "center|^2 - hole^2), and volume (for planar arms, the area; none if the limits cut the "
     "region): of the tool, or of the center of the wrist.",
     "w = workspace(robot([revolute(a: 300), revolute(a: 200)]), 100)\n"
     "print w.kind, near(w.r_min, 100), near(w.volume, 4 * pi * 300 * 200) // expect: planar true "
     "true",
     ROBOTS, inverse},
    {"dh_assign(axes: list of records {kind, point, direction}, end: record {point, "
     "direction}, base: transform = none)",
     cag_robots_dh_assign, "record",
     "Returns Denavit-Hartenberg frames for joint axes, which are records of kind, point, and "
     "direction at the zero configuration: `table` (records of kind, theta, d, a, alpha) and "
     "`frames`. `end` is the point and direction of the last frame. The z axis of the base is "
     "the first joint's axis (none: a frame at its point). x(i) runs along the common normal, or "
     "along the cross product of the directions of axes that meet.",
     "axes = [{point: [0, 0, 0], direction: Z}, {point: [300, 0, 0], direction: Z}]\n"
     "r = dh_assign(axes, {point: [500, 0, 0], direction: Z})\n"
     "print [for row in r.table: row.a] // expect: [300, 200]",
     CAG_TAKES_LISTS, links},

    {"joint_path(robot: robot, q: list of joint values, to: list of joint values, "
     "n: integer)",
     cag_robots_joint_path, "list",
     "Returns n configurations from one q to another, including both, with evenly moving joints.",
     PLANAR "print joint_path(arm, [0deg, 0deg], [90deg, 30deg], 4)[1] // expect: [30deg, 10deg]",
     ROBOTS, paths},
    {"line_path(robot: robot, T: transform or point, to: transform or point, n: integer, "
     "near: list of joint values = home, cross: bool = false)",
     cag_robots_line_path, "list",
     "Returns n configurations whose poses are evenly spaced on the straight path between two "
     "poses, including both. The branch does not change. The error names the step at which the "
     "path leaves the workspace (path-leaves), the joints would jump (path-jumps), or the path "
     "meets or crosses a singular configuration (path-singular; `cross: true` allows it). For "
     "two points, the orientation of the tool is free.",
     "arm = robot([revolute(a: 300), revolute(a: 200), revolute()])\n"
     "qs = line_path(arm, translate([300, 100, 0]), translate([100, 300, 0]), 3, near: [0deg, "
     "90deg, 0deg])\n"
     "print near(distance(position(fk(arm, qs[1])), [200, 200, 0]), 0) // expect: true",
     ROBOTS, paths},
    {"follow(robot: robot, poses: list of transforms or points, "
     "near: list of joint values = home, jumps: bool = false)",
     cag_robots_follow, "list",
     "Returns the configuration for each pose, reached from the previous one without a change of "
     "branch. `jumps: true` allows a change of branch if there is no other way. A pose that is "
     "out of reach is an error that names it. For points, the orientation of the tool is free.",
     "arm = robot([revolute(a: 300), revolute(a: 200), revolute()])\n"
     "print len(follow(arm, [for x in [350, 300, 250]: translate([x, 100, 0])])) // expect: 3",
     ROBOTS, paths},

    {"posed(robot: robot, q: list of joint values = home, holding: shape = none, "
     "limits: bool = true)",
     cag_robots_posed, "group",
     "Returns the robot to show: the shape of each link in the frame after it, and what it is "
     "holding, given in the frame of the tool. A robot without shapes is drawn with plain rods "
     "and drums.",
     "arm = robot([revolute(a: 100, shape: translate(box([100, 10, 10]), [-100, 0, 0]))])\n"
     "print near(bounds(posed(arm, [90deg])).size, [10, 100, 10]) // expect: true",
     ROBOTS, drawing},
    {0}};
