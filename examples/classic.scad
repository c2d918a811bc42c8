// The classic of constructive solid geometry: a rounded cube, drilled along its three axes.
size = 30;
ball = 1.32; // diameter of the sphere, in sizes
drill = 0.62; // diameter of the drill, in sizes

$fn = 96;

difference() {
  intersection() {
    color([0.80, 0.36, 0.27]) cube(size, center = true);
    color([0.29, 0.49, 0.66]) sphere(d = size * ball);
  }
  color([0.93, 0.78, 0.42]) for (turn = [[0, 0, 0], [90, 0, 0], [0, 90, 0]])
    rotate(turn) cylinder(h = 2 * size, d = size * drill, center = true);
}
