// A bottle, its profile and its stopper drawn with splines. For ogee: OpenSCAD has no such functions.
height = 88;
wall = 2;
lobes = 7;

$fa = 4;
$fs = 0.6;

// Radius and height, from the foot to the lip.
outer = [[24, 0], [28, 7], [27, 32], [19, 54], [8.5, 66], [8, 80], [10.5, height]];
inner = [for (p = outer) [p[0] - wall, max(p[1], wall)]];

body = concat([[0, 0]], spline(outer, tolerance = 0.02), [[0, height]]);
hollow = concat([[0, wall]], spline(inner, tolerance = 0.02), [[inner[len(inner) - 1][0], height + 1], [0, height + 1]]);

difference() {
  color([0.36, 0.58, 0.62]) rotate_extrude() polygon(body);
  rotate_extrude() polygon(hollow);
}

// The stopper: a closed curve through points on two circles.
star = [for (i = [0:2 * lobes - 1]) let (r = i % 2 == 0 ? 12.6 : 10.4, a = 180 * i / lobes) [r * cos(a), r * sin(a)]];

translate([48, 0, 0]) color([0.86, 0.62, 0.36]) {
  linear_extrude(height = 9, twist = 12, slices = 12) polygon(spline(star, closed = true, tolerance = 0.02));
  cylinder(h = 18, r = 6.2);
}
