// A shelf bracket: two rounded plates, two gussets, countersunk screw holes.
width = 36;
depth = 44;
height = 52;
thickness = 5;
radius = 7;
screw = 4.5;
head = 9;

$fn = 48;

rotate(180) bracket();

module bracket() {
  difference() {
    union() {
      plate(depth);
      upright() plate(height);
      for (side = [-1, 1]) gusset(side);
      fillet();
    }
    screws(depth);
    upright() screws(height);
  }
}

// The plate that lies on the ground, from the corner of the bracket to y = length.
module plate(length) {
  hull() {
    translate([-width / 2, 0, 0]) cube([width, 1, thickness]);
    for (side = [-1, 1])
      translate([side * (width / 2 - radius), length - radius, 0]) cylinder(h = thickness, r = radius);
  }
}

// Turns what lies on the ground up against the wall y = 0.
module upright() multmatrix([[1, 0, 0, 0], [0, 0, 1, 0], [0, 1, 0, 0]]) children();

module gusset(side) {
  hull() translate([side * (width / 2 - 2) - 2, thickness - 1, thickness - 1]) {
    cube([4, 1, height * 0.55]);
    cube([4, depth * 0.55, 1]);
  }
}

// The inner corner, rounded by what a hull of two thin strips leaves outside a cylinder.
module fillet() {
  difference() {
    translate([-width / 2, thickness - 1, thickness - 1]) cube([width, radius + 1, radius + 1]);
    translate([0, thickness + radius, thickness + radius])
      rotate([0, 90, 0]) cylinder(h = width + 2, r = radius, center = true);
  }
}

module screws(length) {
  for (y = [0.52, 0.8]) translate([0, y * length, 0]) {
    translate([0, 0, -1]) cylinder(h = thickness + 2, d = screw);
    translate([0, 0, thickness - (head - screw) / 2]) cylinder(h = head, d1 = screw, d2 = screw + 2 * head);
  }
}
