// A box for electronics with screw posts, vents and its lid beside it.
inner = [70, 45, 22];
wall = 2.4;
radius = 5;
post = 7;
screw = 2.6;
lid_lip = 1.6;
gap = 0.25;

$fn = 40;

box();
translate([0, inner[1] + 4 * wall + 8, 0]) lid();

function corners(inset) = [
  for (x = [-1, 1], y = [-1, 1]) [x * (inner[0] / 2 - inset), y * (inner[1] / 2 - inset)]
];

module rounded(size, r, h) {
  linear_extrude(height = h) hull()
    for (x = [-1, 1], y = [-1, 1]) translate([x * (size[0] / 2 - r), y * (size[1] / 2 - r)]) circle(r);
}

module box() {
  difference() {
    rounded([inner[0] + 2 * wall, inner[1] + 2 * wall], radius + wall, inner[2] + wall);
    translate([0, 0, wall]) rounded(inner, radius, inner[2] + 1);
    vents();
    translate([-inner[0] / 2 - wall - 1, 0, wall + 9]) rotate([0, 90, 0]) cylinder(h = wall + 2, d = 8);
  }
  for (p = corners(post / 2 - 0.5)) translate([p[0], p[1], wall / 2]) difference() {
    cylinder(h = inner[2] - lid_lip, d = post);
    translate([0, 0, 4]) cylinder(h = inner[2], d = screw);
  }
}

module vents() {
  for (i = [-3:3]) translate([i * 6, -inner[1] / 2 - wall - 1, wall + 5])
    hull() for (z = [0, 10]) translate([0, 0, z]) rotate([-90, 0, 0]) cylinder(h = wall + 2, d = 2.4);
}

module lid() {
  difference() {
    union() {
      rounded([inner[0] + 2 * wall, inner[1] + 2 * wall], radius + wall, wall);
      difference() {
        rounded([inner[0] - 2 * gap, inner[1] - 2 * gap], radius - gap, wall + lid_lip);
        translate([0, 0, wall]) rounded([inner[0] - 4, inner[1] - 4], radius - 2, lid_lip + 1);
        for (p = corners(post / 2 - 0.5)) translate([p[0], p[1], wall]) cylinder(h = lid_lip + 1, d = post + 2 * gap);
      }
    }
    for (p = corners(post / 2 - 0.5)) translate([p[0], p[1], -1]) {
      cylinder(h = wall + lid_lip + 2, d = screw + 0.6);
      cylinder(h = 1 + wall / 2, d = 2 * screw);
    }
  }
}
