// A vase with a twisted, fluted body: a profile turned into rings of points.
height = 120;
flutes = 12;
twist = 75;
depth = 2.4; // of the flutes
wall = 2.4;
layers = 60;
around = 144;

vase();

// Outer radius at height z.
function radius(z) = let (t = z / height) 24 + 13 * sin(190 * t + 12) - 6 * sin(360 * t) + 9 * pow(t, 5);

function ring(z, inset) = [
  for (i = [0:around - 1]) let (
    a = 360 * i / around,
    r = radius(z) - inset + depth * cos(flutes * a) * sin(180 * min(1, 0.12 + z / height))
  ) [r * cos(a + twist * z / height), r * sin(a + twist * z / height), z]
];

// A stack of rings as a solid, closed by its first and last ring.
module loft(rings) {
  n = len(rings[0]);
  m = len(rings);
  polyhedron(
    points = [for (r = rings) each r],
    faces = [
      [for (i = [0:n - 1]) i],
      for (k = [0:m - 2], i = [0:n - 1]) let (a = k * n + i, b = k * n + (i + 1) % n) each [[a, b + n, b], [a, a + n, b + n]],
      [for (i = [n - 1:-1:0]) (m - 1) * n + i]
    ],
    convexity = 6
  );
}

module vase() {
  difference() {
    loft([for (k = [0:layers]) ring(height * k / layers, 0)]);
    loft([for (k = [0:layers]) ring(wall + (height - wall + 1) * k / layers, wall)]);
  }
}
