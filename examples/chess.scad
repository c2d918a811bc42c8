// Chess pieces: a pawn and a rook, turned and cut.
size = 20; // diameter of the foot
$fn = 72;

pawn();
translate([size * 1.5, 0, 0]) rook();

// Turned from the outline on the right of the axis, in units of the size.
module turned(outline) rotate_extrude() {
  top = outline[len(outline) - 1][1];
  polygon(size * concat([[0, 0]], outline, [[0, top]]));
}

function arc(cx, cy, r, from, to, n = 12) = [
  for (i = [0:n]) let (a = from + (to - from) * i / n) [cx + r * cos(a), cy + r * sin(a)]
];

foot = concat([[0.48, 0]], arc(0.44, 0.08, 0.06, -60, 90), arc(0.44, 0.28, 0.14, 270, 200), arc(0.46, 0.55, 0.3, 215, 180));

module pawn() {
  turned(concat(foot, [[0.13, 0.8]], arc(0.2, 0.92, 0.05, -90, 90), [[0.12, 0.98]]));
  translate([0, 0, size * 1.12]) sphere(size * 0.23);
}

module rook() {
  battlements = 6;
  difference() {
    turned(concat(foot, [[0.19, 0.95]], arc(0.26, 1.06, 0.04, -90, 60), [[0.28, 1.18], [0.3, 1.42]]));
    translate([0, 0, size * 1.24]) cylinder(h = size, r = size * 0.2);
    for (i = [0:battlements / 2 - 1]) rotate(180 * 2 * i / battlements)
      translate([0, 0, size * 1.42]) cube([size, size * 0.1, size * 0.26], center = true);
  }
}
