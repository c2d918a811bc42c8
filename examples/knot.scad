// A trefoil knot: a tube swept along a curve with a frame that does not twist.
radius = 20;
tube = 6;
steps = 180;
around = 28;

knot();

function curve(t) = radius * [sin(t) + 2 * sin(2 * t), cos(t) - 2 * cos(2 * t), -sin(3 * t)] / 2;

function unit(v) = v / norm(v);

function tangent(i) = unit(curve(360 * (i + 0.5) / steps) - curve(360 * (i - 0.5) / steps));

// The normal of the frame at step i: the one before, turned least.
function frames(i = 0, normal = [0, 0, 1], done = []) = i == steps ? done :
  let (t = tangent(i), n = unit(normal - t * (normal * t))) frames(i + 1, n, concat(done, [n]));

module knot() {
  normals = frames();
  // What the frame has turned by after a round trip is taken back step by step.
  t0 = tangent(0);
  last = unit(normals[steps - 1] - t0 * (normals[steps - 1] * t0));
  turn = atan2(cross(normals[0], last) * t0, normals[0] * last);
  points = [
    for (i = [0:steps - 1]) let (c = curve(360 * i / steps), n = normals[i], b = cross(tangent(i), n))
      for (k = [0:around - 1]) let (a = 360 * k / around - turn * i / steps) c + tube * (cos(a) * n + sin(a) * b)
  ];
  index = function (i, k) (i % steps) * around + k % around;
  faces = [
    for (i = [0:steps - 1], k = [0:around - 1])
      each [[index(i, k), index(i + 1, k + 1), index(i, k + 1)], [index(i, k), index(i + 1, k), index(i + 1, k + 1)]]
  ];
  polyhedron(points, faces, convexity = 8);
}
