// A Menger sponge, cut from a cube by square bars.
size = 81;
level = 3;

difference() {
  cube(size, center = true);
  for (turn = [[0, 0, 0], [90, 0, 0], [0, 90, 0]]) rotate(turn) bars(level);
}

// The bars along z that level n cuts: a carpet's holes, extruded.
module bars(n) linear_extrude(height = size + 2, center = true) holes(size, n);

module holes(side, n) {
  square(side / 3, center = true);
  if (n > 1) for (x = [-1:1], y = [-1:1]) if (x != 0 || y != 0)
    translate([x * side / 3, y * side / 3]) holes(side / 3, n - 1);
}
