$fn = 400;
rotate_extrude() polygon([for (i = [0:400]) [20 + 5 * sin(i * 3), i / 4], [0, 100], [0, 0]]);
