// A hinge printed in place: two leaves, five knuckles and a pin with cones that hold it together.
length = 60;
leaf = 26;
thickness = 4;
knuckle = 10;
knuckles = 5;
gap = 0.5;
angle = 35; // how far it is opened
screw = 4;

$fn = 40;

pitch = length / knuckles;

leaf_of(0);
translate([0, 0, knuckle / 2]) rotate([0, angle, 0]) translate([0, 0, -knuckle / 2]) mirror([1, 0, 0]) leaf_of(1);

// The leaf with the knuckles of the given parity, its plate on x < 0.
module leaf_of(parity) {
  difference() {
    union() {
      plate();
      for (i = [parity:2:knuckles - 1]) barrel(i);
    }
    for (i = [1 - parity:2:knuckles - 1]) clearance(i);
    for (i = [parity:2:knuckles - 1]) if (i > 0) socket(i * pitch + gap / 2);
  }
  for (i = [parity:2:knuckles - 1]) if (i < knuckles - 1) cone((i + 1) * pitch - gap / 2);
}

module plate() {
  difference() {
    hull() {
      translate([-1 - knuckle / 2, 0, 0]) cube([1, length, thickness]);
      for (y = [6, length - 6]) translate([-leaf + 6, y, 0]) cylinder(h = thickness, r = 6);
    }
    for (y = [0.2, 0.8]) translate([-leaf * 0.62, y * length, -1]) {
      cylinder(h = thickness + 2, d = screw);
      translate([0, 0, thickness - 1]) cylinder(h = 3, d1 = screw, d2 = screw + 6);
    }
  }
}

// Along the axis of the hinge, from y on.
module on_axis(y) translate([0, y, knuckle / 2]) rotate([-90, 0, 0]) children();

module barrel(i) {
  y = i * pitch + gap / 2;
  hull() {
    on_axis(y) cylinder(h = pitch - gap, d = knuckle);
    translate([-knuckle / 2 - 1, y, 0]) cube([1, pitch - gap, thickness]);
  }
}

module clearance(i) {
  on_axis(i * pitch - gap / 2) cylinder(h = pitch + gap, d = knuckle + 2 * gap);
}

module cone(y) on_axis(y - 0.01) cylinder(h = knuckle / 4, r1 = knuckle / 4, r2 = 0.6);
module socket(y) on_axis(y - 0.02) cylinder(h = knuckle / 4 + gap, r1 = knuckle / 4 + gap / 2, r2 = 0.6 + gap / 2);
