// A kettle of smooth surfaces: a turned body, a spout and a handle along curves, a lid. For ogee: OpenSCAD has no such
// functions.
$fe = 0.05;
wall = 1.6;

// Radius and height, from the foot to the mouth.
belly = [[20, 0], [30, 6], [33, 20], [27, 36], [16, 44]];
spout = [[22, 0, 12], [36, 0, 20], [42, 0, 36], [52, 0, 44]];
handle = [[-14, 0, 41], [-26, 0, 62], [0, 0, 74], [26, 0, 62], [14, 0, 41]];

function shrunk(points, by) = [for (p = points) [p[0] - by, max(p[1], by)]];

difference() {
  union() {
    color([0.24, 0.42, 0.52]) revolve(belly, kind = "natural");
    color([0.24, 0.42, 0.52]) tube(spout, r = 5);
  }
  revolve(shrunk(belly, wall), kind = "natural");
  tube(concat(spout, [[54, 0, 45]]), r = 5 - wall);
  translate([0, 0, 42]) cylinder(h = 10, r = 14);
}

color([0.78, 0.58, 0.36])
  sweep(handle, [[-2.4, -1.2], [2.4, -1.2], [2.4, 1.2], [-2.4, 1.2]], profile_kind = "b-spline");

translate([60, 50, 0]) color([0.78, 0.58, 0.36])
  revolve([[0, 0], [15, 0], [15.5, 2], [8, 5], [3, 7], [4, 11], [0, 13]], kind = "line");
