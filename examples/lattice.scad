// A lattice of struts through the cells of a cube, with balls at the joints.
cells = 2;
cell = 20;
strut = 3;
joint = 5.6;

$fn = 12;

side = cells * cell;

translate([0, 0, joint / 2]) {
  for (x = [0:cells], y = [0:cells], z = [0:cells]) translate([x, y, z] * cell) sphere(d = joint, $fn = 20);
  for (x = [0:cells - 1], y = [0:cells - 1], z = [0:cells - 1]) translate([x, y, z] * cell) diagonals();
  for (i = [0:cells], j = [0:cells]) {
    translate([i * cell, j * cell, 0]) cylinder(h = side, d = strut);
    translate([i * cell, 0, j * cell]) rotate([-90, 0, 0]) cylinder(h = side, d = strut);
    translate([0, i * cell, j * cell]) rotate([0, 90, 0]) cylinder(h = side, d = strut);
  }
}

// The four space diagonals of a cell.
module diagonals() {
  c = cell;
  for (ends = [[[0, 0, 0], [c, c, c]], [[c, 0, 0], [0, c, c]], [[0, c, 0], [c, 0, c]], [[c, c, 0], [0, 0, c]]])
    rod(ends[0], ends[1], strut * 0.8);
}

module rod(from, to, d) {
  way = to - from;
  length = norm(way);
  translate(from) rotate([0, acos(way[2] / length), atan2(way[1], way[0])]) cylinder(h = length, d = d);
}
