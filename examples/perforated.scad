// A perforated panel: hexagonal holes in close packing inside a rounded frame.
size = [120, 80];
thickness = 3;
hole = 7;    // across flats
web = 1.6;   // between holes
frame = 7;
radius = 8;
screw = 4.2;

$fn = 48;

step = hole + web;
row = step * sqrt(3) / 2;

difference() {
  slab(size, radius, thickness);
  intersection() {
    translate([0, 0, -1]) slab([size[0] - 2 * frame, size[1] - 2 * frame], radius - 3, thickness + 2);
    holes();
  }
  for (x = [-1, 1], y = [-1, 1]) translate([x * (size[0] / 2 - frame), y * (size[1] / 2 - frame), -1])
    cylinder(h = thickness + 2, d = screw);
}

module slab(size, r, h) {
  hull() for (x = [-1, 1], y = [-1, 1])
    translate([x * (size[0] / 2 - r), y * (size[1] / 2 - r), 0]) cylinder(h = h, r = r);
}

// All hexagons that lie within the frame whole.
module holes() {
  columns = ceil(size[0] / step / 2);
  rows = ceil(size[1] / row / 2);
  for (j = [-rows:rows], i = [-columns:columns]) {
    x = (i + (j % 2 == 0 ? 0 : 0.5)) * step;
    if (abs(x) < size[0] / 2 - frame - hole / 2 - web && abs(j * row) < size[1] / 2 - frame - hole / 2 - web)
      translate([x, j * row, -2]) rotate(30) cylinder(h = thickness + 4, r = hole / sqrt(3), $fn = 6);
  }
}
