// A sea shell: a tube that grows on a spiral, given by a formula of two parameters.
turns = 2.6;
wall = 0.16;      // over the radius of the tube
tolerance = 0.05; // no triangle is farther from the formula than this

// How large the animal is at an angle.
function size(u) = exp(u / 480);

// The point at angle u along the spiral and v around the tube, whose radius is a share of the size.
function whorl(radius) = function(u, v) size(u) * [
  (1 + radius * cos(v)) * cos(u),
  (1 + radius * cos(v)) * sin(u),
  radius * (1 + 0.05 * cos(9 * v)) * sin(v) - 1.4,
];

module tube(radius, from, to)
  parametric(whorl(radius), u = [from, to], v = [0, 360], tolerance = tolerance);

rotate([180, 0, 0]) difference() {
  tube(0.66, 0, 360 * turns);
  tube(0.66 * (1 - wall), 60, 360 * turns + 5); // out of the mouth
}
