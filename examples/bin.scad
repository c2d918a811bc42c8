// A storage bin on a 42 mm grid, with stepped feet, compartments and a label shelf.
grid = [2, 1];
height = 35;
compartments = 3;
pitch = 42;
gap = 0.5;
wall = 1.6;
radius = 3.75;

$fn = 32;

outer = [for (n = grid) n * pitch - gap];
foot = 4.75;
floor_height = 6.2;

difference() {
  union() {
    for (i = [0:grid[0] - 1], j = [0:grid[1] - 1])
      translate([(i - (grid[0] - 1) / 2) * pitch, (j - (grid[1] - 1) / 2) * pitch, 0]) feet();
    translate([0, 0, foot]) block(outer, radius, height - foot);
  }
  difference() {
    translate([0, 0, floor_height]) block([outer[0] - 2 * wall, outer[1] - 2 * wall], radius - wall, height);
    dividers();
    shelf();
    scoop();
  }
}

module block(size, r, h) {
  hull() for (x = [-1, 1], y = [-1, 1])
    translate([x * (size[0] / 2 - r), y * (size[1] / 2 - r), 0]) cylinder(h = h, r = r);
}

// One foot: two tapers with a straight part between them.
module feet() {
  side = pitch - gap;
  taper(side - 5.9, 0.8, 0, side - 4.3, 1.6, 0.8);
  taper(side - 4.3, 1.6, 0.8, side - 4.3, 1.6, 2.6);
  taper(side - 4.3, 1.6, 2.6, side, radius, foot);
}

module taper(side1, r1, z1, side2, r2, z2) {
  hull() {
    translate([0, 0, z1]) block([side1, side1], r1, 0.01);
    translate([0, 0, z2 - 0.01]) block([side2, side2], r2, 0.02);
  }
}

module dividers() {
  for (i = [1:1:compartments - 1])
    translate([(i / compartments - 0.5) * (outer[0] - wall), 0, height / 2])
      cube([1.2, outer[1], height + 2], center = true);
}

module along_x() rotate([90, 0, 90]) linear_extrude(height = outer[0] + 2, center = true) children();

module shelf() along_x() polygon([
  [outer[1] / 2 + 1, height + 1], [outer[1] / 2 - wall - 11, height + 1],
  [outer[1] / 2 - wall - 11, height - 1.2], [outer[1] / 2 + 1, height - 14]
]);

module scoop() {
  r = 14;
  y = -outer[1] / 2 + wall;
  along_x() difference() {
    translate([y - 1, floor_height - 1]) square(r + 1);
    translate([y + r, floor_height + r]) circle(r, $fn = 64);
  }
}
