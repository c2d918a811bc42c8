// A jar with a threaded neck, and its knurled lid beside it.
diameter = 44;
height = 46;
wall = 2.2;
pitch = 4;
turns = 1.75;
depth = 1.3; // of the thread
gap = 0.35;
knurls = 36;
steps = 48; // a turn

$fn = 72;

neck = diameter / 2 - 3;
neck_height = 12;

jar();
translate([diameter + 12, 0, 0]) lid();

function section(r, out, angle, z) = let (p = [cos(angle), sin(angle)], half = pitch * 0.42, flat = pitch * 0.12) [
  [p[0] * (r - out * 0.4), p[1] * (r - out * 0.4), z - half],
  [p[0] * (r + out), p[1] * (r + out), z - flat],
  [p[0] * (r + out), p[1] * (r + out), z + flat],
  [p[0] * (r - out * 0.4), p[1] * (r - out * 0.4), z + half]
];

// A ridge that winds about radius r, growing out of the wall at both ends; out < 0 points inward.
module thread(r, out) {
  n = floor(steps * turns);
  grow = function (i) min(1, 0.05 + 6 * min(i, n - i) / steps);
  points = [for (i = [0:n]) each section(r, out * grow(i), 360 * i / steps, pitch * i / steps)];
  sides = [
    for (i = [0:n - 1], k = [0:3]) let (a = 4 * i + k, b = 4 * i + (k + 1) % 4)
      each [[a, b, b + 4], [a, b + 4, a + 4]]
  ];
  e = 4 * n;
  ends = [[2, 1, 0], [3, 2, 0], [e, e + 1, e + 2], [e, e + 2, e + 3]];
  faces = [for (f = concat(sides, ends)) out > 0 ? f : [f[2], f[1], f[0]]];
  polyhedron(points, faces, convexity = 8);
}

module jar() {
  rotate_extrude() difference() {
    polygon([
      [0, 0], [diameter / 2 - 2, 0], [diameter / 2, 2], [diameter / 2, height - 8],
      [neck, height - 4], [neck, height + neck_height], [0, height + neck_height]
    ]);
    polygon([
      [-1, wall], [diameter / 2 - wall - 2, wall], [diameter / 2 - wall, wall + 2], [diameter / 2 - wall, height - 9],
      [neck - wall, height - 5], [neck - wall, height + neck_height + 1], [-1, height + neck_height + 1]
    ]);
  }
  translate([0, 0, height - 1]) thread(neck, depth);
}

module lid() {
  inside = neck + depth + gap;
  outside = inside + 2 * wall;
  difference() {
    union() {
      cylinder(h = neck_height, r = outside);
      for (i = [0:knurls - 1]) rotate(360 * i / knurls)
        translate([outside, 0, 1.5]) cylinder(h = neck_height - 3, r = 1.1, $fn = 12);
    }
    translate([0, 0, wall]) cylinder(h = neck_height, r = inside);
  }
  translate([0, 0, wall + 2.5]) thread(inside, -depth);
}
